"""The frames of a robot that a display reads from a file of its own.

In ROS a robot_state_publisher with a frame_prefix would say where its links are. Here
the display does, with all joints at their start values; frames that exist already,
those of the opened robot for example, stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable

from sambot_viz.errors import FrameError
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import Robot


def publish_frames(
    tree: FrameTree, robot: Robot, frame_of: Callable[[str], str]
) -> tuple[str, ...]:
    """Set the transforms of a robot that are not set yet.

    Args:
        tree: the frames; the transforms are static.
        robot: whose links they are.
        frame_of: link → frame, with the TF prefix.

    Returns:
        The child frames that are new.
    """
    new: list[str] = []
    root = frame_of(robot.root)
    if not robot.joints and root not in tree:
        tree.declare(root)
        return (root,)
    missing = [j for j in robot.joints.values() if not _known(tree, frame_of(j.child))]
    if not missing:
        return ()
    kinematics = Kinematics(robot)
    positions = kinematics.positions({})
    for joint in missing:
        position = positions.get(joint.name, joint.start)
        T_parent_child = kinematics.joint_transform(joint.name, position)
        child = frame_of(joint.child)
        try:
            tree.set_static(
                frame_of(joint.parent), child, Transform.trusted(T_parent_child)
            )
        except FrameError:
            # The other robot hangs these two links the other way round; it was first.
            continue
        new.append(child)
    return tuple(new)


def _known(tree: FrameTree, frame: str) -> bool:
    return frame in tree and tree.parent(frame) is not None
