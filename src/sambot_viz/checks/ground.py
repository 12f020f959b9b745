"""Wheels that do not touch the ground plane of base_footprint."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sambot_viz.checks.rule import Subject, listed
from sambot_viz.errors import Problem
from sambot_viz.geometry import Matrix
from sambot_viz.robot.parts import Cylinder, Joint, Link, Sphere

_SMALLEST_GAP = 0.01
_SHARE_OF_RADIUS = 0.1


def wheels_off_the_ground(subject: Subject) -> Iterator[Problem]:
    """Report wheels above or below height 0 of base_footprint, in one finding.

    Navigation puts base_footprint on the floor, so a wheel above it floats. Gaps up to
    10 mm or a tenth of the wheel's radius are tolerated: tyres are often modelled so.
    """
    robot = subject.robot
    footprint = next((n for n in robot.links if n.endswith("base_footprint")), None)
    if footprint is None:
        return
    poses = robot.forward_kinematics()
    T_footprint_root = np.linalg.inv(poses[footprint])
    gaps: dict[str, float] = {}
    first: Joint | None = None
    for joint in robot.joints.values():
        link = robot.links[joint.child]
        gap = _gap(joint, link, T_footprint_root @ poses[link.name])
        if gap is not None:
            gaps[link.name] = gap
            first = first or joint
    if first is None:
        return
    worst = max(gaps.values(), key=abs)
    ends, touch = ("ends", "it touches") if len(gaps) == 1 else ("end", "they touch")
    yield Problem.at(
        first.place,
        "warning",
        "wheel-not-on-ground",
        f"the wheel{'s' if len(gaps) > 1 else ''} {listed(gaps)} {ends} "
        f"{abs(worst):.3g} m {'above' if worst > 0 else 'below'} the ground: "
        f"{footprint} should lie where {touch} the floor",
        f"move {footprint} by {abs(worst):.3g} m {'up' if worst > 0 else 'down'}, or "
        "correct the height or radius",
    )


def _gap(joint: Joint, link: Link, T_footprint_link: Matrix) -> float | None:
    """Height of a wheel's lowest point [m]; None for a wheel that is all right.

    A wheel turns without end about a level axis, and is a sphere or a cylinder
    about that axis. Other links, and wheels that are meshes, are not judged.
    """
    if joint.type != "continuous":
        return None
    axis = T_footprint_link[:3, :3] @ np.array(joint.axis)
    if abs(axis[2]) > 0.1:
        return None
    for shape in (*link.collisions, *link.visuals):
        T = T_footprint_link @ shape.origin.matrix
        geometry = shape.geometry
        along_axis = (
            isinstance(geometry, Cylinder) and abs(float(T[:3, 2] @ axis)) > 0.99
        )
        if isinstance(geometry, Sphere) or (
            isinstance(geometry, Cylinder) and along_axis
        ):
            lowest = float(T[2, 3]) - geometry.radius
            tolerance = max(_SMALLEST_GAP, _SHARE_OF_RADIUS * geometry.radius)
            return lowest if abs(lowest) > tolerance else None
    return None
