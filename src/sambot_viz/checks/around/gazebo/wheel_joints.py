"""Find the joints of a model that may be the left or right wheel of a drive."""

from __future__ import annotations

from collections.abc import Set
from typing import Literal

from sambot_viz.checks.wheel_clues import is_rotor
from sambot_viz.errors import nearest
from sambot_viz.robot.model import Robot
from sambot_viz.robot.slips.vocabulary import is_one_slip

Side = Literal["left", "right", ""]


def side_in(name: str) -> Side:
    """Return the side in the name of an element or a parameter."""
    lower = name.lower()
    return "left" if "left" in lower else "right" if "right" in lower else ""


def side_of(robot: Robot, joint: str) -> Side:
    """Return the side of a joint's wheel; "" in the middle and for an uncertain one.

    With an axis other than y, front and back may change places, and left and right.
    """
    T = robot.at_start[robot.joints[joint].child]
    y = round(T.position[1], 4)
    if T.turned(robot.joints[joint].axis)[1] < 0.9 or not y:
        return ""
    return "left" if y > 0 else "right"


def meant_wheel(
    robot: Robot, name: str, side: Side, taken: Set[str]
) -> tuple[str | None, list[str]]:
    """Return the joint that a drive means by a name it does not have.

    Args:
        robot: the robot.
        name: the name in the drive; "" for none.
        side: the side of its wheel.
        taken: the joints of its other wheels.

    Returns:
        The joint, or None for an uncertain one; and all possible joints.
    """
    turning = [
        joint.name
        for joint in robot.joints.values()
        if joint.type != "fixed" and joint.name not in taken and not is_rotor(joint)
    ]
    for joint in turning:
        if name and is_one_slip(name, joint):
            return joint, [joint]
    sides = {joint: side_of(robot, joint) for joint in turning}
    known = bool(side) and any(sides.values())
    there = [j for j in turning if sides[j] == side] if known else turning
    rolling = [j for j in there if robot.joints[j].type == "continuous"] or there
    if len(rolling) == 1:
        return rolling[0], rolling
    near = nearest(name, rolling) if known or not side else None
    return near, rolling
