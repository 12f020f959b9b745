"""Report a joint with exchanged parent and child, which makes a part the root."""

from __future__ import annotations

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.place import where
from sambot_viz.checks.exchanged_joint import ends_exchanged, joint_of_root
from sambot_viz.errors import Problem
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint


def exchanged_ends(robot: Robot, joint: Joint, base: Fact, user: str) -> Problem | None:
    """Report a joint whose parent is a part and whose child is the base.

    Args:
        robot: the robot.
        joint: the joint whose child is the base frame.
        base: the place that names the base frame.
        user: the program that moves it.
    """
    if joint_of_root(robot) is not joint:
        return None
    place = joint.place or base.place
    return Problem.at(
        place,
        "warning",
        "frame-two-parents",
        f"joint {joint.name} has {joint.parent} as its parent and {joint.child} as its "
        f"child, but {user} moves {joint.child} ({where(base.place, place)}), and the "
        "other parts hang from it: parent and child are exchanged",
        ends_exchanged(joint, robot.language),
    )
