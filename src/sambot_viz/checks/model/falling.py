"""Report a robot on wheels whose centre of mass is outside its support."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from sambot_viz.checks.clues import guess
from sambot_viz.checks.model.axles import wheels_in_one_place
from sambot_viz.checks.model.slips import sizes_not_positive
from sambot_viz.checks.rule import Subject, listed, number
from sambot_viz.checks.wheel_clues import is_rotor
from sambot_viz.errors import Problem
from sambot_viz.geometry import Vector2, Vector3
from sambot_viz.robot.balance.balance import SAME_POINT, Balance, Tipping, balance
from sambot_viz.robot.balance.ground import Contacts, axle_of, contacts
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import MeshFile
from sambot_viz.robot.slips.wheel_names import CASTER

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh

_SMALLEST_SHARE = 0.02
"""Tolerance for a centre of mass beyond the edge [size of the robot]."""
_CAUGHT = 0.05
"""Height below which a part keeps the robot nearly level [size of the robot]."""
_FEWEST_WHEELS = 2
_FEWEST_CONTACTS = 3


def falls_over(subject: Subject) -> Iterator[Problem]:
    """Report a robot on wheels that falls over with all joints at the start.

    Only certain cases count. All shapes are known, and all links with collision shapes
    have a mass. Three links touch the ground, two of them wheels; or only two wheels
    do, and a caster is above the ground. Two wheels in one place, or a size that is
    not positive, explain the fall, and other rules report them.
    """
    robot, unknown = subject.robot, False
    if any(wheels_in_one_place(subject)) or any(sizes_not_positive(subject)):
        return

    def mesh_of(shape: MeshFile) -> Mesh | None:
        nonlocal unknown
        found = None if shape.path is None else subject.mesh(shape.path)
        if found is None or isinstance(found, Problem):
            unknown = True
            return None
        return found

    found = balance(robot, robot.at_start, mesh_of)
    if found is None or found.support is None or found.fixed or unknown:
        return
    on_ground, size = found.support.links, found.support.size
    wheels = [link for link in on_ground if _is_wheel(robot, link)]
    if len(wheels) < _FEWEST_WHEELS:
        return
    if any(robot.links[link].collisions for link in found.massless):
        return
    if len(on_ground) < _FEWEST_CONTACTS:
        feet = contacts(robot, robot.at_start, mesh_of, math.inf)
        if feet is not None and _beside_axle(found, feet, wheels):
            yield from _caster_in_the_air(robot, feet, wheels)
        return
    caught = balance(robot, robot.at_start, mesh_of, _CAUGHT * size)
    later = None if caught is None else caught.tipping
    if found.tipping and later and -later.margin >= _SMALLEST_SHARE * size:
        yield _problem(robot, found, found.tipping)


def _beside_axle(found: Balance, feet: Contacts, wheels: Sequence[str]) -> bool:
    """Return whether the weight is off the line between the contacts of two wheels."""
    (x, y), (other_x, other_y) = (_middle(feet.points[link]) for link in wheels)
    ahead, aside = other_x - x, other_y - y
    length = math.hypot(ahead, aside)
    if length < SAME_POINT or found.support is None:
        return False

    def beside(at_x: float, at_y: float) -> float:
        return abs((at_y - y) * ahead - (at_x - x) * aside) / length

    reach = max(beside(*corner) for corner in found.support.polygon)
    enough = reach + _SMALLEST_SHARE * feet.size
    return beside(found.center[0], found.center[1]) > enough


def _middle(points: Sequence[Vector3]) -> Vector2:
    x, y, _ = (sum(values) / len(points) for values in zip(*points, strict=True))
    return x, y


def _caster_in_the_air(
    robot: Robot, feet: Contacts, wheels: Sequence[str]
) -> Iterator[Problem]:
    """Report the lowest caster of a robot that only two wheels support."""
    gaps = {
        link: min(z for _, _, z in points) - feet.height
        for link, points in feet.points.items()
        if link not in wheels
    }
    if not gaps or min(gaps.values()) < _CAUGHT * feet.size:
        return
    above = {joint.child: joint for joint in robot.joints.values()}
    casters = [link for link in gaps if link in above and CASTER.search(link)]
    if not casters:
        return
    caster = min(casters, key=lambda link: gaps[link])
    joint = above[caster]
    yield guess(
        joint.place,
        "wheel-not-on-ground",
        f"the robot falls over: {caster} ends {gaps[caster]:.3g} m above the ground, "
        f"which {listed(wheels)} touch, and its centre of mass is not above them",
        f"lower the origin of joint {joint.name} by {gaps[caster]:.3g} m, or correct "
        "the radius",
        {"weight", "name"},
    )


def _is_wheel(robot: Robot, link: str) -> bool:
    joint = next((j for j in robot.joints.values() if j.child == link), None)
    turns = axle_of(joint, robot.at_start[link]) is not None
    return joint is not None and turns and not is_rotor(joint)


def _problem(robot: Robot, found: Balance, tipping: Tipping) -> Problem:
    masses = {
        link.name: link.inertial.mass
        for link in robot.links.values()
        if link.inertial is not None
    }
    heaviest = robot.links[max(masses, key=lambda name: masses[name])]
    place = heaviest.place if heaviest.inertial is None else heaviest.inertial.place
    on_ground = () if found.support is None else found.support.links
    return guess(
        place or heaviest.place,
        "falls-over",
        f"the robot falls over: its centre of mass is {number(-tipping.margin)} m "
        f"beyond what it stands on, which is {listed(on_ground)}",
        f"move weight, such as that of {heaviest.name}, between the wheels, or add a "
        "caster; RobotModel > Mass Properties > Balance shows where it is",
        {"weight", "ground"},
    )
