"""Joints and wheel sizes of Gazebo plugins and ros2_control against the model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from sambot_viz.checks.around.gazebo import Fact, Plugin, plugins
from sambot_viz.checks.around.place import where
from sambot_viz.checks.rule import number
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.geometry import Matrix
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Cylinder, Joint, Link, Sphere

_LEFT = ("left_joint", "leftJoint")
_RIGHT = ("right_joint", "rightJoint")
_JOINTS = (
    *_LEFT,
    *_RIGHT,
    "joint_name",
    "jointName",
    "front_left_joint",
    "front_right_joint",
    "back_left_joint",
    "back_right_joint",
    "left_steering_joint",
    "right_steering_joint",
    "steering_joint",
)
_SCOPED = ("::", "/", ",", " ")
_SEPARATION_OFF = 0.15
_SEPARATION_OFF_MESH = 0.25
_RADIUS_OFF = 0.1
_SKIDDING = 4


def unknown_joints(robot: Robot) -> Iterator[Problem]:
    """Report joints of plugins and ros2_control that the model does not have."""
    for fact, user in _named_joints(robot):
        if any(mark in fact.value for mark in _SCOPED):
            continue
        joint = robot.joints.get(fact.value)
        if joint is not None and (joint.type != "fixed" or not user.drives):
            continue
        if joint is not None:
            message = (
                f"{user.name} drives the joint {fact.value}, which is fixed "
                f"({where(joint.place, fact.place)}): it cannot turn"
            )
            hint = 'write type="continuous" for that joint'
        else:
            message, hint = _unknown(robot, fact, user)
        yield Problem.at(fact.place, "warning", "gazebo-joint", message, hint)


class _User(NamedTuple):
    """What names a joint; `drives` when it has to turn it."""

    name: str
    drives: bool


def _named_joints(robot: Robot) -> Iterator[tuple[Fact, _User]]:
    for plugin in plugins(robot.gazebo):
        if plugin.generation is not None:
            for fact in plugin.all(*_JOINTS):
                yield fact, _User(f"the plugin {plugin.filename}", plugin.is_drive)
    for part in robot.gazebo:
        if part.tag == "ros2_control":
            for joint in part.find_all("joint"):
                fact = Fact(joint.get("name") or "", joint.place)
                yield fact, _User("<ros2_control>", drives=False)


def _unknown(robot: Robot, fact: Fact, user: _User) -> tuple[str, str]:
    near = nearest(fact.value, robot.joints)
    if near is None:
        movable = [j.name for j in robot.joints.values() if j.type != "fixed"]
        near = next(iter(movable or robot.joints), "")
    known = robot.joints.get(near)
    place = known.place if known else robot.links[robot.root].place
    what = f"the model has {near}" if near else "the model has no joints"
    return (
        f"{user.name} names the joint {fact.value}, which does not exist: {what} "
        f"({where(place, fact.place)})",
        f"write {near}" if near else "delete it",
    )


def unknown_references(robot: Robot) -> Iterator[Problem]:
    """Report <gazebo reference="…"> that is almost the name of a link or joint."""
    known: Mapping[str, Link | Joint] = {**robot.joints, **robot.links}
    for part in robot.gazebo:
        name = part.get("reference") or ""
        near = nearest(name, known, likeness=0.8) if name and name not in known else ""
        if not near:
            continue
        place = Place(part.place.file, part.line_of("reference"))
        lost = ", ".join(dict.fromkeys(f"<{child.tag}>" for child in part.children))
        yield Problem.at(
            place,
            "warning",
            "gazebo-reference",
            f"<gazebo> refers to {name}, which does not exist: the model has {near} "
            f"({where(known[near].place, place)}); Gazebo ignores its {lost}",
            f"write {near}",
        )


def wheel_sizes(robot: Robot) -> Iterator[Problem]:
    """Report a wheel separation or radius of a drive that is not that of the model."""
    for plugin in plugins(robot.gazebo):
        if not plugin.is_drive:
            continue
        pairs = list(_pairs(robot, plugin))
        if pairs:
            poses = robot.forward_kinematics()
            yield from _separation(robot, plugin, pairs, poses)
            yield from _radius(robot, plugin, pairs[0][0], poses)


def _pairs(robot: Robot, plugin: Plugin) -> Iterator[tuple[Joint, Joint]]:
    lefts, rights = plugin.all(*_LEFT), plugin.all(*_RIGHT)
    for left, right in zip(lefts, rights, strict=False):
        one, other = robot.joints.get(left.value), robot.joints.get(right.value)
        if one is not None and other is not None and one.movable and other.movable:
            yield one, other


def _separation(
    robot: Robot,
    plugin: Plugin,
    pairs: list[tuple[Joint, Joint]],
    poses: Mapping[str, Matrix],
) -> Iterator[Problem]:
    said = plugin.all("wheel_separation", "wheelSeparation")
    for fact, (left, right) in zip(said, pairs, strict=False):
        apart = _apart(left, right, poses)
        wheel = _wheel(robot, left, poses)
        if apart is None or fact.number is None:
            continue
        width = wheel.length if isinstance(wheel, Cylinder) else 0.0
        share = _SEPARATION_OFF if wheel else _SEPARATION_OFF_MESH
        if abs(fact.number - apart) <= max(1.01 * width, share * apart):
            continue
        wheels = sum(joint.type == "continuous" for joint in robot.joints.values())
        if fact.number > apart and (len(pairs) > 1 or wheels >= _SKIDDING):
            # Wheels that skid turn as if they were farther apart.
            continue
        yield Problem.at(
            fact.place,
            "warning",
            "drive-wheel-separation",
            f"the wheel separation is {number(fact.number)} m here, but the wheels of "
            f"{left.name} and {right.name} ({where(left.place, fact.place)}) are "
            f"{number(apart)} m apart: odometry turns by wrong angles",
            f"write {number(apart)}",
        )


def _apart(left: Joint, right: Joint, poses: Mapping[str, Matrix]) -> float | None:
    """Distance of two wheels along their common axis [m]; None without one."""
    T_left, T_right = poses[left.child], poses[right.child]
    axis = T_left[:3, :3] @ np.array(left.axis)
    other = T_right[:3, :3] @ np.array(right.axis)
    if abs(float(axis @ other)) < 0.99:
        return None
    apart = abs(float((T_left[:3, 3] - T_right[:3, 3]) @ axis))
    return apart if apart > 0 else None


def _radius(
    robot: Robot, plugin: Plugin, pair: Joint, poses: Mapping[str, Matrix]
) -> Iterator[Problem]:
    wheel = _wheel(robot, pair, poses)
    radius, diameter = (
        plugin.one("wheel_radius"),
        plugin.one("wheel_diameter", "wheelDiameter"),
    )
    fact, times, what = (radius, 1, "radius") if radius else (diameter, 2, "diameter")
    if wheel is None or fact is None or fact.number is None:
        return
    if abs(fact.number - times * wheel.radius) <= _RADIUS_OFF * times * wheel.radius:
        return
    yield Problem.at(
        fact.place,
        "warning",
        "drive-wheel-radius",
        f"the wheel {what} is {number(fact.number)} m here, but the wheel of "
        f"{pair.name} has the {what} {number(times * wheel.radius)} m "
        f"({where(robot.links[pair.child].place, fact.place)}): speed and odometry "
        "are wrong",
        f"write {number(times * wheel.radius)}",
    )


def _wheel(
    robot: Robot, joint: Joint, poses: Mapping[str, Matrix]
) -> Cylinder | Sphere | None:
    """The shape of a wheel that turns about its own axis; None for other shapes."""
    link = robot.links[joint.child]
    axis = np.array(joint.axis)
    shapes = link.collisions or link.visuals
    if len(shapes) != 1:
        return None
    geometry = shapes[0].geometry
    along = abs(float(shapes[0].origin.matrix[:3, 2] @ axis)) > 0.99
    if isinstance(geometry, Sphere) or (isinstance(geometry, Cylinder) and along):
        return geometry
    return None
