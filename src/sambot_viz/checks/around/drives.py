"""The sides and the elements of a differential drive in Gazebo."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from sambot_viz.checks.around.files.gazebo import Fact, plugins
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import number
from sambot_viz.errors import Problem, nearest
from sambot_viz.robot.model import Robot

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
_ALIKE = 0.9


def misspelt_elements(robot: Robot) -> Iterator[Problem]:
    """Report elements of a differential drive with a wrong letter."""
    for plugin in plugins(robot.gazebo):
        own = _CLASSIC if plugin.generation == "classic" else _GZ | _LIMITS
        for child in plugin.element.children if plugin.is_drive else ():
            if child.tag in _GZ | _CLASSIC | _LIMITS:
                continue
            near = nearest(child.tag, sorted(own), _ALIKE)
            if near is not None:
                yield Problem.at(
                    child.place,
                    "warning",
                    "gazebo-element-unknown",
                    f"{plugin.filename} ({where(plugin.element.place, child.place)}) "
                    f"does not read <{child.tag}>: it uses its own default",
                    f"write <{near}>",
                )


def exchanged_sides(robot: Robot) -> Iterator[Problem]:
    """Report a plugin whose left wheel is on the right."""
    for plugin in plugins(robot.gazebo):
        if plugin.is_drive:
            base = plugin.one("child_frame_id", "robot_base_frame")
            yield from _exchanged(
                robot,
                base.value if base else "",
                plugin.all("left_joint", "leftJoint"),
                plugin.all("right_joint", "rightJoint"),
            )


def exchanged_sides_of_controllers(around: Surroundings) -> Iterator[Problem]:
    """Report the same for the parameters of a diff_drive_controller."""
    for file in around.yaml_files if around.robot.gazebo else ():
        for node in file.nodes:
            given = file.of(node)
            left, right = given.get("left_wheel_names"), given.get("right_wheel_names")
            if left is not None and right is not None:
                base = given.get("base_frame_id")
                yield from _exchanged(
                    around.robot,
                    base.fact.value if base else "",
                    [Fact(name, left.place) for name in left.values],
                    [Fact(name, right.place) for name in right.values],
                )


def _exchanged(
    robot: Robot, base: str, lefts: Sequence[Fact], rights: Sequence[Fact]
) -> Iterator[Problem]:
    poses = robot.forward_kinematics()
    T_base_root = np.linalg.inv(poses.get(base, poses[robot.root]))
    for left, right in zip(lefts, rights, strict=False):
        joints = [robot.joints.get(fact.value) for fact in (left, right)]
        known = [joint for joint in joints if joint is not None]
        frames = [T_base_root @ poses[joint.child] for joint in known]
        axes = [
            float((T[:3, :3] @ np.array(joint.axis))[1])
            for T, joint in zip(frames, known, strict=True)
        ]
        ys = [round(float(T[1, 3]), 4) for T in frames]
        # With another axis the front is the back, and left is right.
        if len(known) == 2 and min(axes) > 0.99 and ys[0] < 0 < ys[1]:
            yield Problem.at(
                left.place,
                "warning",
                "drive-sides",
                f"{left.value} is the left joint here, but its wheel is on the right, "
                f"at y = {number(ys[0])} m ({where(known[0].place, left.place)}), and "
                f"that of {right.value} ({where(right.place, left.place)}) on the "
                "left: the robot turns the wrong way",
                f"exchange {left.value} and {right.value}",
            )
            return
