"""The frames of a robot in the pose that the options ask for."""

from __future__ import annotations

from sambot_viz.commands.command_line import warn
from sambot_viz.frames import FrameTree
from sambot_viz.frames.robot_frames import robot_frames
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot


def posed_frames(robot: Robot, options: Options) -> FrameTree:
    """The frames as ROS would have them, with the static transforms of the options.

    Raises:
        JointError: a joint that does not exist or cannot be set.
        FrameError: a static transform that would form a ring.
    """
    state = options.start_pose.state(robot)
    for name in options.start_pose.passed_over(state):
        warn(f"--joint-state: the robot has no joint '{name}'; ignored")
    for problem in state.problems:
        if problem.code == "mimic-joint-disagrees":
            warn(f"{problem.message}; {problem.hint}")
    tree = robot_frames(robot, state.all_positions())
    for added in options.transforms:
        tree.set_static(added.parent, added.child, added.transform)
    return tree
