"""Report wheels that do not touch the floor below base_footprint."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from sambot_viz.checks.clues import Clues, guess
from sambot_viz.checks.exchanged_joint import ends_exchanged
from sambot_viz.checks.rule import Subject, listed, number
from sambot_viz.checks.wheel_clues import is_rotor, wheel_clues
from sambot_viz.edits import negate_part
from sambot_viz.errors import Fix, Problem
from sambot_viz.geometry import UP, PlainPose, dot
from sambot_viz.robot.parts import Cylinder, Joint, Link, Sphere

_SMALLEST_GAP = 0.01
_SHARE_OF_RADIUS = 0.1
_ROUNDED = 1e-6
_MOVED = ("robot_base_frame", "child_frame_id")
_MOVED_IN_YAML = re.compile(r"^\s*base_link_frame\s*:\s*[\"']?([\w/]+)", re.M)
"""Parameters with the frame that odometry moves."""


def wheels_off_the_ground(subject: Subject) -> Iterator[Problem]:
    """Report wheels above or below height 0 of base_footprint, in one finding.

    Navigation puts base_footprint on the floor, so a wheel above it floats. The rule
    tolerates gaps up to 10 mm or a tenth of the wheel's radius, which are common in
    models of tyres.
    """
    robot = subject.robot
    footprint = next((n for n in robot.links if n.endswith("base_footprint")), None)
    if footprint is None:
        return
    T_footprint_root = robot.at_start[footprint].inverse()
    gaps: dict[str, float] = {}
    standing: list[str] = []
    first: Joint | None = None
    at_axles = True
    for joint in robot.joints.values():
        link = robot.links[joint.child]
        T = T_footprint_root @ robot.at_start[link.name]
        gap = _gap(joint, link, T)
        if gap == 0.0:
            standing.append(link.name)
        elif gap is not None:
            gaps[link.name] = gap
            at_axles &= abs(T.position[2]) < _SMALLEST_GAP
            first = first or joint
    if first is None:
        return
    if len(gaps) == 1 and standing:
        clues = {"height"} | wheel_clues(robot, first)
        yield _one_wheel(first, gaps[first.child], standing, clues)
        return
    worst = max(gaps.values(), key=abs)
    ends, touch = ("ends", "it touches") if len(gaps) == 1 else ("end", "they touch")
    # Some put base_footprint between the wheels on purpose.
    clues = set[str]() if at_axles else wheel_clues(robot, first)
    way = "up" if worst > 0 else "down"
    turned = _turned(subject, footprint, worst)
    yield guess(
        first.place if turned is None else turned[0].place,
        "wheel-not-on-ground",
        f"the wheel{'s' if len(gaps) > 1 else ''} {listed(gaps)} {ends} "
        f"{abs(worst):.3g} m {'above' if worst > 0 else 'below'} the ground: "
        f"{footprint} should lie where {touch} the floor",
        f"move {footprint} by {abs(worst):.3g} m {way}, or correct the height or radius"
        if turned is None
        else turned[1],
        {"height"} | clues,
    )


def _turned(
    subject: Subject, footprint: str, gap: float
) -> tuple[Joint, Fix | str] | None:
    """Return the joint of a base_footprint on the wrong side of the base, and its fix.

    Either the sign of its joint is wrong, or parent and child are exchanged. The frame
    that navigation moves decides, because it must be the root.
    """
    robot = subject.robot
    joint = next(
        (j for j in robot.joints.values() if footprint in (j.parent, j.child)), None
    )
    ends = () if joint is None else (joint.parent, joint.child)
    height = 0.0 if joint is None else joint.origin.xyz[2]
    if joint is None or robot.root not in ends or joint.type != "fixed":
        return None
    if height == 0 or abs(abs(gap) - 2 * abs(height)) > _SMALLEST_GAP:
        return None
    moved = _moved_frames(subject)
    if robot.root not in moved and not moved.isdisjoint(ends):
        return joint, ends_exchanged(joint, robot.language)
    hint = f"write {number(-height)} as the z of joint {joint.name}"
    return joint, Fix(hint, negate_part(joint.origin.place, "xyz", 2))


def _moved_frames(subject: Subject) -> set[str]:
    """Return the frames that drives and filters of the packages move."""
    elements = (e for part in subject.robot.gazebo for e in part.iter())
    found = {e.text.strip() for e in elements if e.tag in _MOVED}
    for package in subject.packages:
        for path in package.ending(".yaml", ".yml"):
            found.update(_MOVED_IN_YAML.findall(package.text(path) or ""))
    return found


def _one_wheel(
    joint: Joint, gap: float, standing: Sequence[str], clues: Clues
) -> Problem:
    """Report the only wheel that does not touch the floor."""
    above, move = ("above", "lower") if gap > 0 else ("below", "raise")
    touch = "touches" if len(standing) == 1 else "touch"
    return guess(
        joint.place,
        "wheel-not-on-ground",
        f"the wheel {joint.child} ends {abs(gap):.3g} m {above} the ground, which "
        f"{listed(standing)} {touch}",
        f"{move} the origin of joint {joint.name} by {abs(gap):.3g} m, or correct the "
        "radius",
        clues,
    )


def _gap(joint: Joint, link: Link, T_footprint_link: PlainPose) -> float | None:
    """Return the height of a wheel's lowest point [m]; 0 when it touches the floor.

    A wheel turns without limit about a level axis, and is a sphere or a cylinder about
    that axis. Return None for other links, and for wheels that are meshes.
    """
    if not joint.endless or is_rotor(joint):
        return None
    axis = T_footprint_link.turned(joint.axis)
    if abs(axis[2]) > 0.1:
        return None
    for shape in (*link.collisions, *link.visuals):
        T = T_footprint_link @ shape.origin.pose
        geometry = shape.geometry
        along_axis = abs(dot(T.turned(UP), axis)) > 0.99
        if isinstance(geometry, Sphere) or (
            isinstance(geometry, Cylinder) and along_axis
        ):
            lowest = T.position[2] - geometry.radius
            tolerance = max(_SMALLEST_GAP, _SHARE_OF_RADIUS * geometry.radius)
            return lowest if abs(lowest) > tolerance + _ROUNDED else 0.0
    return None
