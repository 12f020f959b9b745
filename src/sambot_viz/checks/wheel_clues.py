"""Collect clues that a joint without limits is the joint of a wheel."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.clues import Clues
from sambot_viz.geometry import UP, Vector3
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Box, Cylinder, Joint, Shape, Sphere
from sambot_viz.robot.slips.wheel_names import WHEEL

_ROTOR = re.compile(
    r"prop|rotor|thruster|impeller|turbine|blade|(?<![a-z])fan(?![a-z])", re.IGNORECASE
)
_SIDES = re.compile("left|right|wheel", re.IGNORECASE)
_SAME = 0.01
"""Difference below which places and sizes are equal [m]."""


def is_rotor(joint: Joint) -> bool:
    """Return whether a joint turns a propeller or a fan, by its name."""
    return any(_ROTOR.search(name) for name in (joint.name, joint.child))


def wheel_clues(robot: Robot, joint: Joint) -> Clues:
    """Return the clues for a wheel; nothing for a propeller."""
    if is_rotor(joint):
        return frozenset()
    clues: set[str] = set()
    if WHEEL.search(f"{joint.name} {joint.child}".lower()):
        clues.add("name")
    if any(
        element.text.strip() == joint.name and _SIDES.search(element.tag)
        for part in robot.gazebo
        for element in part.iter()
    ):
        clues.add("drive")
    if _has_twin(robot, joint):
        clues.add("twin")
    if _is_lowest(robot, joint.child):
        clues.add("ground")
    return clues


def _has_twin(robot: Robot, joint: Joint) -> bool:
    """Return whether an equal link, also without limits, is on the other side."""
    x, y, z = robot.at_start[joint.child].position
    own = _geometries(robot, joint.child)
    return any(
        other is not joint
        and other.endless
        and own == _geometries(robot, other.child)
        and abs(y) > _SAME
        and _near((x, -y, z), robot.at_start[other.child].position)
        for other in robot.joints.values()
    )


def _near(one: Vector3, other: Vector3) -> bool:
    return all(abs(a - b) < _SAME for a, b in zip(one, other, strict=True))


def _geometries(robot: Robot, link: str) -> list[object]:
    return [shape.geometry for shape in shapes_of(robot, link)]


def shapes_of(robot: Robot, link: str) -> tuple[Shape, ...]:
    """Return the collision shapes of a link, else its visuals."""
    return robot.links[link].collisions or robot.links[link].visuals


def _is_lowest(robot: Robot, link: str) -> bool:
    """Return whether no other link reaches below a link, for known shapes only."""
    own = min(lows(robot, link), default=None)
    others = [low for name in robot.links if name != link for low in lows(robot, name)]
    return own is not None and len(others) > 0 and own < min(others) + _SAME


def lows(robot: Robot, link: str) -> Iterator[float]:
    """Yield the lowest height of each shape of a link except meshes [m]."""
    T_root_link = robot.at_start[link]
    for shape in shapes_of(robot, link):
        T = T_root_link @ shape.origin.pose
        match shape.geometry:
            case Sphere(radius):
                yield T.position[2] - radius
            case Cylinder(radius, length):
                upright = abs(T.turned(UP)[2])
                flat = max(0.0, 1.0 - upright * upright) ** 0.5
                yield T.position[2] - radius * flat - length / 2 * upright
            case Box(size):
                axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), UP)
                reach = (
                    abs(T.turned(axis)[2]) * side / 2
                    for axis, side in zip(axes, size, strict=True)
                )
                yield T.position[2] - sum(reach)
            case _:
                pass
