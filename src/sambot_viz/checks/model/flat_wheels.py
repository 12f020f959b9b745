"""Report wheels that lie flat: both their joint and their shape are turned."""

from __future__ import annotations

from sambot_viz.checks.model.axles import axle_of, only_rolls
from sambot_viz.checks.rule import Subject, listed
from sambot_viz.edits import overwrite_attribute
from sambot_viz.errors import Fix, Problem
from sambot_viz.geometry import UP, dot
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Cylinder, Joint, Language, Shape

_UPRIGHT = 0.99
"""Smallest cosine between an upright direction and the vertical (8°)."""
_LEVEL = 0.1


def flat_wheels(subject: Subject) -> list[Problem]:
    """Report driven wheels whose axle is upright, though their shape lies along it.

    There are two clues. The first is a disc that turns about its middle line, in a link
    that is named a wheel and does not swivel. The second is a joint that would hold the
    wheel upright without its rotation.
    """
    robot = subject.robot
    flat = [joint for joint in robot.joints.values() if _lies_flat(joint, robot)]
    if len(flat) < 2:
        return []
    joint = flat[0]
    rpy = " ".join(f"{round(angle, 4) + 0.0:g}" for angle in joint.origin.rpy)
    return [
        Problem.at(
            joint.origin.place or joint.place,
            "warning",
            "wheel-lies-flat",
            f"the wheels {listed(joint.child for joint in flat)} lie flat: joint "
            f"{joint.name} is turned by {rpy}, so that its axle is upright, and the "
            "wheel turns as a plate does",
            Fix(
                _upright(joint, robot.language),
                tuple(
                    edit
                    for each in flat
                    for edit in overwrite_attribute(each.origin.place, "rpy", "0 0 0")
                ),
            ),
        )
    ]


def _upright(joint: Joint, language: Language) -> str:
    if language == "sdf":
        return f"write 0 0 0 for the last three numbers of the <pose> of {joint.child}"
    return f'write rpy="0 0 0" in the <origin> of joint {joint.name}'


def _lies_flat(joint: Joint, robot: Robot) -> bool:
    axle = axle_of(joint)
    if axle is None or joint.origin.rpy == (0.0, 0.0, 0.0):
        return False
    parent = robot.at_start[joint.parent]
    upright = abs(robot.at_start[joint.child].turned(axle)[2]) > _UPRIGHT
    unturned = abs(parent.turned(axle)[2]) < _LEVEL
    link = robot.links[joint.child]
    shapes = link.collisions or link.visuals
    return (
        upright
        and unturned
        and bool(shapes)
        and all(_is_along(shape, axle) for shape in shapes)
        and only_rolls(joint, robot)
    )


def _is_along(shape: Shape, axle: tuple[float, float, float]) -> bool:
    """Return whether a shape is a disc whose middle line is the axle."""
    disc = shape.geometry
    if not isinstance(disc, Cylinder) or disc.length > 2 * disc.radius:
        return False
    return abs(dot(shape.origin.pose.turned(UP), axle)) > _UPRIGHT
