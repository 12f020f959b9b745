"""Compare joints of plugins and controllers, and references, with the model."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from sambot_viz.checks.around.control.copied import JOINTS
from sambot_viz.checks.around.files.gazebo import Fact, facts, plugins
from sambot_viz.checks.around.gazebo.wheel_joints import Side, meant_wheel, side_in
from sambot_viz.checks.around.place import where
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write, write_attribute
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Link
from sambot_viz.robot.slips.vocabulary import is_one_slip
from sambot_viz.robot.xml.element import Element

if TYPE_CHECKING:
    from sambot_viz.checks.around.surroundings import Surroundings

_WITH_JOINTS = ("ros2_control", "transmission")
"""Elements of a model, besides plugins, that name its joints."""
_OF_ROS1 = "libgazebo_ros_control.so"
"""The plugin that reads <transmission>."""
_OTHER_SIDE = {
    "left_wheel_names": "right_wheel_names",
    "right_wheel_names": "left_wheel_names",
}
_LINK = "_link"
_SCOPED = ("::", "/", ",", " ")
_LIKE_NAME, _LIKE_LETTERS = 0.7, 0.9
"""Similarity of two names: for a similar name, and for one with a wrong letter."""


def unknown_joints(robot: Robot) -> Iterator[Problem]:
    """Report joints of plugins and ros2_control that the model does not have."""
    return _unknown_joints(robot, _named_joints(robot))


def joints_of_controllers(around: Surroundings) -> Iterator[Problem]:
    """Report joints in the parameters of controllers that the model does not have."""
    for parameter in around.parameters if around.robot.gazebo else ():
        if parameter.name in _OTHER_SIDE:
            other = _OTHER_SIDE[parameter.name]
            taken = {
                joint
                for p in around.parameters
                if (p.node, p.name) == (parameter.node, other)
                for joint in p.values
            }
            side = side_in(parameter.name)
            user = _User(parameter.node, True, side, frozenset(taken))
            is_own = parameter.place.file in around.ownership.own
            named = [
                (Fact(joint, parameter.place), user)
                for joint in parameter.values
                if is_own or not around.said_elsewhere(joint)
            ]
            yield from _unknown_joints(around.robot, named)


def _unknown_joints(
    robot: Robot, named: Iterable[tuple[Fact, _User]]
) -> Iterator[Problem]:
    said: set[tuple[str, Place | None]] = set()
    for fact, user in named:
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
            wheel = meant_wheel(robot, "", user.side, user.taken)[0]
            hint = (
                write(fact.place, fact.value, wheel)
                if wheel is not None and user.side
                else Fix('write type="continuous" for that joint')
            )
        else:
            message, hint = _unknown(robot, fact, user)
        if joint is not None and (hint.hint, joint.place) in said:
            # A macro has made both joints.
            continue
        said.add((hint.hint, joint.place if joint is not None else None))
        severity = "info" if user.is_unread else "warning"
        yield Problem.at(fact.place, severity, "gazebo-joint", message, hint)


class _User(NamedTuple):
    """A plugin or controller that names a joint.

    Attributes:
        name: for messages.
        drives: it must turn the joint.
        side: where the wheel of the joint is.
        taken: the joints of its other wheels.
        is_unread: nothing in ROS 2 reads it.
    """

    name: str
    drives: bool
    side: Side = ""
    taken: frozenset[str] = frozenset()
    is_unread: bool = False


def _named_joints(robot: Robot) -> Iterator[tuple[Fact, _User]]:
    every = list(plugins(robot.gazebo))
    for plugin in every:
        if plugin.generation is not None:
            named = [(tag, fact) for tag in JOINTS for fact in plugin.all(tag)]
            for tag, fact in named:
                taken = {other.value for _, other in named if other is not fact}
                yield (
                    fact,
                    _User(
                        f"the plugin {plugin.filename}",
                        plugin.is_drive,
                        side_in(tag),
                        frozenset(taken),
                    ),
                )
    is_ros1 = any(plugin.filename == _OF_ROS1 for plugin in every)
    for part in robot.gazebo:
        if part.tag in _WITH_JOINTS:
            unread = part.tag == "transmission" and not is_ros1
            joints = part.find_all("joint")
            for joint in joints:
                fact = Fact(joint.get("name") or "", joint.place)
                taken = {other.get("name") or "" for other in joints} - {fact.value}
                yield (
                    fact,
                    _User(
                        f"<{part.tag}>",
                        False,
                        taken=frozenset(taken),
                        is_unread=unread,
                    ),
                )


def _unknown(robot: Robot, fact: Fact, user: _User) -> tuple[str, Fix]:
    wheels: list[str] = []
    if user.drives:
        near, wheels = meant_wheel(robot, fact.value, user.side, user.taken)
        if near is None and wheels:
            side = f"{user.side} " if user.side else ""
            return (
                f"{user.name} names the joint {fact.value}, which does not exist: the "
                f"model has {listed(wheels)}",
                Fix(f"write the joint of the {side}wheel"),
            )
    else:
        free = [name for name in robot.joints if name not in user.taken]
        turning = [name for name in free if robot.joints[name].type != "fixed"]
        near = nearest(fact.value, turning) or nearest(fact.value, free)
    if near is None:
        movable = [j.name for j in robot.joints.values() if j.type != "fixed"]
        free = [name for name in movable if name not in user.taken]
        if len(free) > 1:
            return (
                f"{user.name} names the joint {fact.value}, which does not exist: the "
                f"model has {listed(free)}",
                Fix("write the joint that is meant"),
            )
        near = next(iter(free or movable or robot.joints), "")
    known = robot.joints.get(near)
    place = known.place if known else robot.links[robot.root].place
    what = f"the model has {near}" if near else "the model has no joints"
    return (
        f"{user.name} names the joint {fact.value}, which does not exist: {what} "
        f"({where(place, fact.place)})",
        write(fact.place, fact.value, near) if near else Fix("delete it"),
    )


def unknown_references(robot: Robot) -> Iterator[Problem]:
    """Report <gazebo reference="…"> that is neither a link nor a joint.

    Without a sensor or plugin inside, only a misspelt name counts.
    """
    known: Mapping[str, Link | Joint] = {**robot.joints, **robot.links}
    used = {part.get("reference") for part in robot.gazebo}
    # A link with its own <gazebo> is not the intended one of another <gazebo>.
    free = [name for name in known if name not in used]
    for part in robot.gazebo:
        name = part.get("reference") or ""
        if not name or name in known or any(mark in name for mark in _SCOPED):
            continue
        matters = any(child.tag in ("sensor", "plugin") for child in part.children)
        near = _link_of_sensors(part, free) if matters else None
        near = near or nearest(name, free, _LIKE_NAME if matters else _LIKE_LETTERS)
        ends = (f"{name}{_LINK}", name.removesuffix(_LINK))
        near = near or next((each for each in ends if each in free), None)
        if matters and near is None:
            near = _with_its_words(name, [link for link in robot.links if link in free])
        # One link may have several <gazebo>, each with different elements.
        near = near or next((each for each in known if is_one_slip(name, each)), None)
        if near is None and not matters:
            continue
        place = Place(part.place.file, part.line_of("reference"))
        lost = ", ".join(dict.fromkeys(f"<{child.tag}>" for child in part.children))
        has = (
            f": the model has {near} ({where(known[near].place, place)})"
            if near
            else ""
        )
        yield Problem.at(
            place,
            "warning",
            "gazebo-reference",
            f"<gazebo> refers to {name}, which does not exist{has}; Gazebo ignores its "
            f"{lost}",
            write_attribute(part.place, "reference", name, near, hint=f"write {near}")
            if near
            else f"write the link that it belongs to, such as {robot.root}",
        )


def _link_of_sensors(part: Element, free: list[str]) -> str | None:
    """Return the link whose frame the sensors of a <gazebo> have."""
    frames = {
        fact.value
        for sensor in part.find_all("sensor")
        for fact in facts(sensor, "gz_frame_id", "ignition_frame_id")
    }
    only = frames.pop() if len(frames) == 1 else None
    return only if only in free else None


def _with_its_words(name: str, links: list[str]) -> str | None:
    """Return the only link with all words of another name, such as lidar_link."""
    words = set(name.lower().split("_"))
    found = [link for link in links if words < set(link.lower().split("_"))]
    return found[0] if len(found) == 1 else None
