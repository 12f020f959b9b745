"""The frames of a robot as robot_state_publisher publishes them."""

from __future__ import annotations

from collections.abc import Mapping

from sambot_viz.frames.transform import Transform
from sambot_viz.frames.tree import FrameTree
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import Robot


def robot_frames(
    robot: Robot, positions: Mapping[str, float] | None = None, *, prefix: str = ""
) -> FrameTree:
    """A new tree with the frames of a robot (spec/ros-nodes.md §3.2).

    Fixed and planar joints are static, the moving ones change. A floating joint gives
    no transform, so that what hangs below it is a tree of its own.

    Args:
        robot: the robot.
        positions: joint → position [rad or m]; the others stand at their start values,
            mimic joints follow.
        prefix: is put before every frame name as it is (RSP's frame_prefix).

    Raises:
        JointError: an unknown joint, or a position that is no finite number.
    """
    kinematics = Kinematics(robot)
    values = kinematics.positions(positions or {})
    tree = FrameTree()
    tree.declare(prefix + robot.root)
    for name, joint in robot.joints.items():
        if joint.type == "floating":
            continue
        matrix = kinematics.joint_transform(name, values[name])
        matrix.flags.writeable = False
        set_transform = tree.set if joint.movable else tree.set_static
        transform = Transform.trusted(matrix)
        set_transform(prefix + joint.parent, prefix + joint.child, transform)
    return tree
