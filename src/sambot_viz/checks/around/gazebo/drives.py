"""The sides and the elements of a differential drive in Gazebo."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from typing import TYPE_CHECKING, NamedTuple

from sambot_viz.checks.around.files.gazebo import Fact, plugins
from sambot_viz.checks.around.gazebo.wheel_joints import meant_wheel, side_in
from sambot_viz.checks.around.place import where
from sambot_viz.checks.rule import axis_text, listed, number
from sambot_viz.edits import exchange, rename_element, write
from sambot_viz.errors import Problem, nearest
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint

if TYPE_CHECKING:
    from sambot_viz.checks.around.surroundings import Surroundings

_LIMITS = {
    f"{end}_{kind}{what}"
    for end in ("min", "max")
    for kind in ("", "linear_", "angular_")
    for what in ("velocity", "acceleration", "jerk")
}
_GZ = frozenset(
    """
    left_joint right_joint wheel_separation wheel_radius odom_publish_frequency topic
    odom_topic tf_topic frame_id child_frame_id
    """.split()
)
_CLASSIC = frozenset(
    """
    ros update_rate left_joint right_joint wheel_separation wheel_diameter
    max_wheel_torque max_wheel_acceleration publish_odom publish_odom_tf
    publish_wheel_tf odometry_frame robot_base_frame num_wheel_pairs command_topic
    odometry_topic odometry_source covariance_x covariance_y covariance_yaw
    """.split()
)
_MEANT = {
    "cmd_vel_topic": "topic",
    "cmd_topic": "topic",
    "cmdvel_topic": "topic",
    "odom_frame": "frame_id",
    "odom_frame_id": "frame_id",
    "base_frame": "child_frame_id",
    "robot_base_frame_id": "child_frame_id",
    "wheel_base": "wheel_separation",
    "wheel_distance": "wheel_separation",
}
"""Names in other programs for elements of Gazebo's differential drive."""
_ALIKE = 0.9
_ALONG = 0.99
"""Least cosine between two equal directions."""
_AHEAD = 0.1
"""Tolerance for one wheel in front of the other [distance of both]."""


def misspelt_elements(robot: Robot) -> Iterator[Problem]:
    """Report misspelt elements of a differential drive."""
    for plugin in plugins(robot.gazebo):
        own = _CLASSIC if plugin.generation == "classic" else _GZ | _LIMITS
        for child in plugin.element.children if plugin.is_drive else ():
            if child.tag in _GZ | _CLASSIC | _LIMITS:
                continue
            meant = _MEANT.get(child.tag) if own is not _CLASSIC else None
            near = meant or nearest(child.tag, sorted(own), _ALIKE)
            if near in {one.tag for one in plugin.element.children}:
                continue
            if near is not None:
                yield Problem.at(
                    child.place,
                    "warning",
                    "gazebo-element-unknown",
                    f"{plugin.filename} ({where(plugin.element.place, child.place)}) "
                    f"does not read <{child.tag}>: it uses its own default",
                    rename_element(child.place, child.tag, near, f"write <{near}>"),
                )


def wrong_sides(robot: Robot) -> Iterator[Problem]:
    """Report a plugin whose wheels do not drive the robot as it claims."""
    for plugin in plugins(robot.gazebo):
        if plugin.is_drive:
            base = plugin.one("child_frame_id", "robot_base_frame")
            yield from _sides(
                robot,
                base.value if base else "",
                plugin.all("left_joint", "leftJoint"),
                plugin.all("right_joint", "rightJoint"),
            )


def wrong_sides_of_controllers(around: Surroundings) -> Iterator[Problem]:
    """Report wheels that do not match the parameters of a diff_drive_controller."""
    for file in around.yaml_files if around.robot.gazebo else ():
        for node in file.nodes:
            given = file.of(node)
            left, right = given.get("left_wheel_names"), given.get("right_wheel_names")
            if left is not None and right is not None:
                base = given.get("base_frame_id")
                yield from _sides(
                    around.robot,
                    base.fact.value if base else "",
                    [Fact(name, left.place) for name in left.values],
                    [Fact(name, right.place) for name in right.values],
                )


class _DriveWheel(NamedTuple):
    """A wheel of a drive, in the base frame, in which x is forwards.

    Attributes:
        fact: where the drive names its joint.
        joint: the joint.
        axis: the y part of its axis.
        x: its place [m].
        y: its place [m].
    """

    fact: Fact
    joint: Joint
    axis: float
    x: float
    y: float


def _sides(
    robot: Robot, base: str, lefts: Sequence[Fact], rights: Sequence[Fact]
) -> Iterator[Problem]:
    """Report the first pair of wheels that is wrong."""
    poses = robot.at_start
    T_base_root = poses.get(base, poses[robot.root]).inverse()

    def wheel(fact: Fact) -> _DriveWheel | None:
        joint = robot.joints.get(fact.value)
        if joint is None or not joint.movable:
            return None
        T = T_base_root @ poses[joint.child]
        axis = T.turned(joint.axis)[1]
        x, y, _ = T.position
        return _DriveWheel(fact, joint, axis, x, round(y, 4))

    for names in zip(lefts, rights, strict=False):
        left, right = map(wheel, names)
        if left is None or right is None:
            continue
        if left.joint is right.joint:
            taken = {fact.value for fact in (*lefts, *rights)}
            yield _driven_twice(robot, left, right, taken)
            return
        found = _exchanged(left, right) or _turning(robot, left, right)
        if found is None and len(lefts) == 1 and not _leads(robot, left, right):
            found = _off_the_axle(left, right)
        if found is not None:
            yield found
            return


def _leads(robot: Robot, *wheels: _DriveWheel) -> bool:
    """Return whether other wheels mimic a driven one: a side has several axles."""
    names = {wheel.joint.name for wheel in wheels}
    mimics = [j.mimic for j in robot.joints.values() if j.mimic is not None]
    return any(mimic.joint in names for mimic in mimics)


def _driven_twice(
    robot: Robot, left: _DriveWheel, right: _DriveWheel, taken: Set[str]
) -> Problem:
    """Report a joint that is the left and the right one."""
    wrong, other, side = (left, right, "left") if left.y < 0 else (right, left, "right")
    near, _ = meant_wheel(robot, "", side_in(side), taken)
    return Problem.at(
        wrong.fact.place,
        "warning",
        "drive-sides",
        f"{wrong.joint.name} is the left joint and the right joint "
        f"({where(other.fact.place, wrong.fact.place)}): the robot cannot turn, and "
        f"the {side} wheel is not driven",
        write(wrong.fact.place, wrong.fact.value, near)
        if near
        else f"write the joint of the {side} wheel",
    )


def _exchanged(left: _DriveWheel, right: _DriveWheel) -> Problem | None:
    # With another axis front and back change places, and so do left and right.
    if min(left.axis, right.axis) <= _ALONG or not left.y < 0 < right.y:
        return None
    of, name = left.fact, left.joint.name
    return Problem.at(
        of.place,
        "warning",
        "drive-sides",
        f"{name} is the left joint here, but its wheel is on the right, at y = "
        f"{number(left.y)} m ({where(left.joint.place, of.place)}), and that of "
        f"{right.joint.name} ({where(right.fact.place, of.place)}) on the left: the "
        "robot turns the wrong way",
        exchange(
            f"exchange {name} and {right.joint.name}",
            (of.place, name),
            (right.fact.place, right.joint.name),
        ),
    )


def _turning(robot: Robot, left: _DriveWheel, right: _DriveWheel) -> Problem | None:
    """Report wheels that turn backwards, both or one of them."""
    back = [wheel for wheel in (left, right) if wheel.axis < -_ALONG]
    if not back or min(abs(left.axis), abs(right.axis)) <= _ALONG:
        return None
    if len(back) == 2 and not right.y < 0 < left.y:
        return None
    joints = [wheel.joint for wheel in back]
    names = listed(joint.name for joint in joints)
    axis = " ".join(number(0.0 - value) for value in joints[0].axis)
    return Problem.at(
        joints[0].place,
        "warning",
        "drive-sides",
        f"{names} {'turn' if len(back) == 2 else 'turns'} about -y, so that the drive "
        f"({where(left.fact.place, joints[0].place)}) "
        + (
            "moves the robot backwards where forwards is meant"
            if len(back) == 2
            else "turns the robot where straight on is meant"
        ),
        f"write {axis_text(axis, robot.language)}"
        + (f" for {names}" if len(back) == 2 else ""),
    )


def _off_the_axle(left: _DriveWheel, right: _DriveWheel) -> Problem | None:
    """Report a pair of wheels with one in front of the other."""
    ahead, apart = abs(left.x - right.x), abs(left.y - right.y)
    if min(abs(left.axis), abs(right.axis)) <= _ALONG or ahead <= _AHEAD * apart:
        return None
    if left.y * right.y >= 0:
        return None
    joint, x = right.joint, left.x
    return Problem.at(
        joint.place,
        "warning",
        "drive-sides",
        f"the wheels of {left.joint.name} and {joint.name} are not on one axle: they "
        f"are at x = {number(left.x)} m and {number(right.x)} m, and the drive "
        f"({where(right.fact.place, joint.place)}) turns the robot about the middle "
        "of both",
        f"give {joint.name} the x of the other wheel, {number(x)}",
    )
