"""A joint whose parent and child are exchanged, so that a part became the root."""

from __future__ import annotations

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.place import where
from sambot_viz.errors import Problem
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint


def exchanged_ends(robot: Robot, joint: Joint, base: Fact, user: str) -> Problem | None:
    """Report a joint that has a part as the parent of what all others hang from.

    Args:
        robot: the robot.
        joint: the joint whose child is the base frame.
        base: where the base frame is named.
        user: who moves it.
    """
    part = robot.links[joint.parent]
    others = [other for other in robot.joints.values() if other is not joint]
    if (
        joint.parent != robot.root
        # A link without a shape, such as base_footprint, may be the root.
        or not (part.visuals or part.collisions)
        or any(other.parent == joint.parent for other in others)
        or not any(other.parent == joint.child for other in others)
    ):
        return None
    place = joint.place or base.place
    tag = "<{0}>{1}</{0}>" if robot.language == "sdf" else '<{0} link="{1}"/>'
    parent, child = tag.format("parent", joint.child), tag.format("child", joint.parent)
    return Problem.at(
        place,
        "warning",
        "frame-two-parents",
        f"joint {joint.name} has {joint.parent} as its parent and {joint.child} as its "
        f"child, but {user} moves {joint.child} ({where(base.place, place)}), and the "
        "other parts hang from it: parent and child are exchanged",
        f"write {parent} and {child}",
    )
