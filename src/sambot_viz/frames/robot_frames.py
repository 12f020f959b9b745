"""The frames of a robot: set as robot_state_publisher does, and explained in words.

An explanation gives the pose of a frame step by step, or the reason why there is none.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sambot_viz.errors import Problem
from sambot_viz.frames.frame_errors import LookupRefused
from sambot_viz.frames.frame_tree import FrameTree, Hop
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.transform import Transform
from sambot_viz.geometry import Vector3
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint


def robot_frames(
    robot: Robot, positions: Mapping[str, float] | None = None, *, prefix: str = ""
) -> FrameTree:
    """Return a new tree with the frames of a robot.

    Fixed and planar joints are static, the moving ones change. A floating joint gives
    no transform, so that its descendants are their own tree.

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
    hang_robot(tree, robot, robot.kinematics, positions or {}, joints, prefix)
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


@dataclass(frozen=True, slots=True)
class ExplainedHop:
    """One row of an explanation.

    Attributes:
        start: the frame that the step leaves.
        end: the frame that the step reaches.
        up: whether it goes from a child to its parent.
        step: the pose of `start` in `end`; the product of all steps is the answer.
        static: whether the transform is static.
        joint: name of the robot's joint between the two, or "".
        joint_type: its type, or "".
    """

    start: str
    end: str
    up: bool
    step: Transform
    static: bool
    joint: str = ""
    joint_type: str = ""

    @property
    def words(self) -> str:
        """The step in words: "wheel is a child of base_link (continuous joint j)"."""
        if self.joint_type == "floating":
            by = (
                f"floating joint {self.joint}: shown at its origin, ROS publishes no "
                "transform"
            )
        elif self.joint:
            by = f"{self.joint_type} joint {self.joint}"
        else:
            by = "static transform" if self.static else "transform"
        relation = "is a child of" if self.up else "is the parent of"
        return f"{self.start} {relation} {self.end} ({by})"


@dataclass(frozen=True, slots=True)
class Explanation:
    """The way from a source frame to a target frame.

    Attributes:
        target: the frame in which the pose is wanted.
        source: the frame whose pose is wanted.
        hops: the steps from the source to the target.
        transform: the product, T_target_source, or None when there is none.
        reason: why there is none, in words; "" when there is one.
        refused: the error of the look-up with tf2's and RViz's texts, or None.
    """

    target: str
    source: str
    hops: tuple[ExplainedHop, ...] = ()
    transform: Transform | None = None
    reason: str = ""
    refused: LookupRefused | None = None


def explain(
    tree: FrameTree, target: str, source: str, robot: Robot | None = None
) -> Explanation:
    """Explain the pose of a source frame in a target frame; never raises.

    Args:
        tree: the frames.
        target: the frame in which the pose is wanted.
        source: the frame whose pose is wanted.
        robot: gives the names and types of the joints between its links.
    """
    target, source = plain_name(target), plain_name(source)
    try:
        transform = tree.lookup(target, source)
    except LookupRefused as refused:
        reason = _reason(tree, refused, robot)
        return Explanation(target, source, reason=reason, refused=refused)
    hops = tuple(_explained(hop, robot) for hop in tree.chain(target, source))
    return Explanation(target, source, hops, transform)


def joint_between(robot: Robot | None, parent: str, child: str) -> Joint | None:
    """Return the robot's joint between two frames, if the robot joins them."""
    for joint in robot.joints.values() if robot else ():
        if (joint.parent, joint.child) == (parent, child):
            return joint
    return None


def _explained(hop: Hop, robot: Robot | None) -> ExplainedHop:
    joint = joint_between(robot, hop.parent, hop.child)
    return ExplainedHop(
        hop.start,
        hop.end,
        hop.up,
        hop.step,
        hop.static,
        joint.name if joint else "",
        joint.type if joint else "",
    )


def _reason(tree: FrameTree, refused: LookupRefused, robot: Robot | None) -> str:
    if refused.reason == "not-connected":
        return _not_connected(tree, refused, robot)
    if refused.reason == "unknown-frame" and not len(tree):
        return f"there are no frames at all, so '{refused.unknown}' is not known"
    floating = _floating_above(refused.unknown, robot)
    if floating is not None:
        return _cut_off(refused.unknown, floating)
    return str(refused)


def _not_connected(tree: FrameTree, refused: LookupRefused, robot: Robot | None) -> str:
    target, source = refused.target, refused.source
    roots = tree.root_of(target), tree.root_of(source)
    for frame, root in ((source, roots[1]), (target, roots[0])):
        joint = _floating_above(root, robot)
        if joint is not None and joint.child == root:
            return _cut_off(frame, joint)
    return (
        f"'{source}' belongs to the tree below '{roots[1]}', '{target}' to the tree "
        f"below '{roots[0]}', and no transform joins the two; add one from a frame of "
        f"the one tree to the root of the other"
    )


def _floating_above(frame: str, robot: Robot | None) -> Joint | None:
    for joint in robot.joints.values() if robot else ():
        if joint.type == "floating" and joint.child == frame:
            return joint
    return None


def _cut_off(frame: str, joint: Joint) -> str:
    below = "is" if frame == joint.child else f"is below '{joint.child}', which is"
    return (
        f"'{frame}' {below} held by the floating joint '{joint.name}', and ROS "
        f"publishes no transform for it; something else has to say where "
        f"'{joint.child}' is in '{joint.parent}'"
    )


@dataclass(frozen=True, slots=True)
class FrameDistance:
    """The origin of a frame, seen from another.

    Attributes:
        length: between the two origins [m].
        offset: of the second origin, along the axes of the first frame [m].
    """

    length: float
    offset: Vector3


def distance_between(tree: FrameTree, first: str, second: str) -> FrameDistance:
    """Return the distance of the origins of two frames.

    Raises:
        LookupRefused: a frame does not exist, or the two are not connected.
    """
    x, y, z = tree.lookup(first, second).translation.tolist()
    return FrameDistance(math.sqrt(x * x + y * y + z * z), (x, y, z))
