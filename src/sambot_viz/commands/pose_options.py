"""The options that say how the robot stands and which frames are added to it."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import UsageError

# Nothing heavy is imported before a model is: the page has to be there quickly.
if TYPE_CHECKING:
    from sambot_viz.frames import FrameTree
    from sambot_viz.frames.static_transform import StaticTransform
    from sambot_viz.joints.start import StartPose
    from sambot_viz.robot.model import Robot


def add_pose_options(parser: argparse.ArgumentParser) -> None:
    """``--joint``, ``--zeros``, ``--joint-state`` and ``--static-transform``."""
    add = parser.add_argument
    several = "; may be given several times"
    add(
        "--joint",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help=f"position of a joint [rad or m]{several}",
    )
    add(
        "--zeros",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help=f"start value of a joint, as joint_state_publisher's zeros.NAME{several}",
    )
    add(
        "--joint-state",
        metavar="FILE",
        help="a yaml file with joint positions, such as ros2 topic echo prints them",
    )
    add(
        "--static-transform",
        action="append",
        default=[],
        metavar='"X Y Z YAW PITCH ROLL PARENT CHILD"',
        help="another frame, with the arguments of static_transform_publisher, old or "
        f"new, in quotes{several}",
    )


@dataclass(frozen=True, slots=True)
class Setup:
    """How the robot stands, and the frames that are added to it."""

    start: StartPose
    static_transforms: Sequence[StaticTransform]

    def tree(self, robot: Robot) -> FrameTree:
        """The frames as ROS would have them.

        Raises:
            JointError: a joint that is not there or cannot be set.
            FrameError: a static transform that would form a ring.
        """
        from sambot_viz.frames.robot_frames import robot_frames

        state = self.start.state(robot)
        for name in self.start.passed_over(state):
            _warn(f"--joint-state: the robot has no joint '{name}'; passed over")
        tree = robot_frames(robot, state.all_positions())
        for added in self.static_transforms:
            tree.set_static(added.parent, added.child, added.transform)
        return tree


def read_setup(options: argparse.Namespace) -> Setup:
    """What the options of `add_pose_options` say; doubtful things are warned of.

    Raises:
        UsageError: an option that makes no sense.
        JointError: a file that cannot be read.
    """
    from sambot_viz.joints.start import StartPose
    from sambot_viz.joints.values import load_joint_state, parse_assignments

    recorded = options.joint_state
    return Setup(
        StartPose(
            zeros=parse_assignments(options.zeros, "--zeros"),
            recorded=load_joint_state(Path(recorded)) if recorded else {},
            positions=parse_assignments(options.joint, "--joint"),
        ),
        [_static_transform(text) for text in options.static_transform],
    )


def _static_transform(text: str) -> StaticTransform:
    from sambot_viz.frames.static_transform import (
        StaticTransformError,
        parse_static_transform,
    )

    try:
        added = parse_static_transform(text)
    except StaticTransformError as error:
        quotes = "" if len(text.split()) > 1 else "; all values belong in one quote"
        raise UsageError(f"--static-transform '{text}': {error}{quotes}") from error
    for warning in added.warnings:
        _warn(f"--static-transform: {warning}")
    return added


def _warn(text: str) -> None:
    sys.stderr.write(f"sambot-viz: warning: {text}\n")


def any_given(options: argparse.Namespace) -> bool:
    """Whether one of the options of `add_pose_options` is on the command line."""
    names = ("joint", "zeros", "joint_state", "static_transform")
    return any(getattr(options, name) for name in names)
