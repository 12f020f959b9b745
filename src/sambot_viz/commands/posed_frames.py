"""The start pose that the options ask for, its warnings, and the frames in it."""

from __future__ import annotations

from sambot_viz.commands.command_line import warn
from sambot_viz.frames import FrameTree
from sambot_viz.frames.robot_frames import robot_frames
from sambot_viz.joints import JointState
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot


def start_state(robot: Robot, options: Options) -> JointState:
    """Return the joint positions at the start; doubts are written as warnings.

    Raises:
        JointError: a joint that does not exist or cannot be set.
    """
    state = options.start_pose.state(robot)
    for name in options.start_pose.passed_over(state):
        warn(f"--joint-state: the robot has no joint '{name}'; ignored")
    for problem in state.problems:
        if problem.code == "mimic-joint-disagrees":
            warn(f"{problem.message}; {problem.hint}")
    return state


def posed_frames(robot: Robot, options: Options) -> FrameTree:
    """Return the frames as ROS has them, with the static transforms of the options.

    Raises:
        JointError: a joint that does not exist or cannot be set.
        FrameError: a static transform that would form a ring.
    """
    tree = robot_frames(robot, start_state(robot, options).all_positions())
    for added in options.transforms:
        tree.set_static(added.parent, added.child, added.transform)
    return tree
