"""The frames of a robot as robot_state_publisher publishes them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sambot_viz.errors import Problem
from sambot_viz.frames.frame_tree import FrameTree
from sambot_viz.frames.transform import Transform
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import Robot


def robot_frames(
    robot: Robot, positions: Mapping[str, float] | None = None, *, prefix: str = ""
) -> FrameTree:
    """Return a new tree with the frames of a robot.

    Fixed and planar joints are static, the moving ones change. A floating joint gives
    no transform, so that its descendants are a tree of their own.

    Args:
        robot: the robot.
        positions: joint → position [rad or m]; the others have their start values,
            mimic joints follow.
        prefix: is put before every frame name as it is (RSP's frame_prefix).

    Raises:
        JointError: an unknown joint, or a position that is not a finite number.
    """
    tree = FrameTree()
    joints = [j.name for j in robot.joints.values() if j.type != "floating"]
    hang_robot(tree, robot, Kinematics(robot), positions or {}, joints, prefix)
    return tree


def hang_robot(
    tree: FrameTree,
    robot: Robot,
    kinematics: Kinematics,
    positions: Mapping[str, float],
    joints: Iterable[str] | None = None,
    prefix: str = "",
) -> None:
    """Set the frames of a robot in a tree.

    Args:
        tree: where they are set.
        robot: the robot.
        kinematics: of that robot.
        positions: joint → position [rad or m]; the others have their start values.
        joints: the joints that hold a frame at another one; None means all.
        prefix: is put before every frame name as it is.

    Raises:
        JointError: an unknown joint, or a position that is not a finite number.
    """
    tree.declare(prefix + robot.root)
    values = kinematics.positions(positions)
    names = robot.joints if joints is None else joints
    for name, matrix in kinematics.joint_transforms(names, values).items():
        joint = robot.joints[name]
        matrix.flags.writeable = False
        set_transform = tree.set if joint.movable else tree.set_static
        transform = Transform.trusted(matrix)
        set_transform(prefix + joint.parent, prefix + joint.child, transform)


def floating_problems(robot: Robot) -> tuple[Problem, ...]:
    """Warnings about floating joints, whose children are shown here but not in RViz.

    ROS publishes no transform for them, and RViz then draws the links below in white
    at the origin of the fixed frame.
    """
    return tuple(
        Problem.at(
            joint.place,
            "warning",
            "floating-joint",
            f"joint '{joint.name}' is floating: ROS publishes no transform for it, so "
            f"'{joint.child}' and all below it have no place there; shown here at the "
            "joint's origin",
            f"let something publish '{joint.parent}' → '{joint.child}', or make the "
            "joint fixed",
        )
        for joint in robot.joints.values()
        if joint.type == "floating"
    )
