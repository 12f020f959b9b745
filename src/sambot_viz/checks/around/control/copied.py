"""Report joints that plugins and <ros2_control> name twice, and others never.

Who copies a block for the next joint, and changes only some of its names, makes these.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from sambot_viz.checks.around.files.gazebo import Fact, plugins
from sambot_viz.checks.around.place import where
from sambot_viz.edits import write, write_attribute
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.model import Robot
from sambot_viz.robot.xml.element import Element

_CODE = "control-interface"
JOINTS = (
    "left_joint",
    "leftJoint",
    "right_joint",
    "rightJoint",
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
"""Elements in which plugins of Gazebo name a joint."""
_NUMBER = re.compile(r"\d+")


class _NamedJoints(NamedTuple):
    """Names of joints that should all differ.

    Attributes:
        what: who has them, for messages.
        code: of its problems.
        named: the names, each with its attribute, or "" for one that is a text.
        said: all joints that it names.
    """

    what: str
    code: str
    named: Sequence[tuple[Fact, str]]
    said: frozenset[str]


def joints_twice(robot: Robot) -> Iterator[Problem]:
    """Report a joint that is named twice, where the only one like it is left out."""
    for group in _groups(robot):
        first: dict[str, Place] = {}
        for fact, attribute in group.named:
            joint, before = robot.joints.get(fact.value), first.get(fact.value)
            first.setdefault(fact.value, fact.place)
            if joint is None or before is None or before == fact.place:
                continue
            free = [
                each.name
                for each in robot.joints.values()
                if each.type == joint.type and each.mimic is None
                if each.name not in group.said
            ]
            like = [name for name in free if _is_next(name, joint.name)]
            right = free[0] if len(free) == 1 else like[0] if len(like) == 1 else None
            if right is not None:
                fix = write(fact.place, fact.value, right)
                if attribute:
                    fix = write_attribute(fact.place, attribute, fact.value, right)
                yield Problem.at(
                    fact.place,
                    "warning",
                    group.code,
                    f"{fact.value} is named twice in {group.what} (see "
                    f"{where(before, fact.place)}), and {right} never",
                    fix,
                )


def _is_next(one: str, other: str) -> bool:
    """Return whether two names differ in their number only."""
    return _NUMBER.sub("0", one) == _NUMBER.sub("0", other)


def _groups(robot: Robot) -> Iterator[_NamedJoints]:
    for plugin in plugins(robot.gazebo):
        said = frozenset(fact.value for fact in plugin.all(*JOINTS))
        for tag in JOINTS if plugin.generation is not None else ():
            named = [(fact, "") for fact in plugin.all(tag)]
            yield _NamedJoints(
                f"the plugin {plugin.filename}", "gazebo-joint", named, said
            )
    for part in robot.gazebo:
        if part.tag != "ros2_control":
            continue
        transmissions = [
            (Fact(joint.get("name") or "", joint.place), "name")
            for transmission in part.find_all("transmission")
            for joint in transmission.find_all("joint")
        ]
        values = [
            (Fact(param.text.strip(), param.place), "")
            for hardware in part.find_all("hardware")
            for param in hardware.find_all("param")
        ]
        for what, named in (
            ("the transmissions", transmissions),
            ("<hardware>", values),
        ):
            said = frozenset(fact.value for fact, _ in named)
            yield _NamedJoints(f"{what} of <ros2_control>", _CODE, named, said)


def control_twice(robot: Robot) -> Iterator[Problem]:
    """Report two <ros2_control> with one name, and joints twice in one of them."""
    first: dict[str, Element] = {}
    for part in robot.gazebo:
        if part.tag != "ros2_control":
            continue
        yield from _in_part(part, robot)
        name = part.get("name") or ""
        other = first.setdefault(name, part)
        # A macro that is called for two robots is for hardware that takes both.
        if name and other.place != part.place:
            taken = {each.get("name") for each in robot.gazebo}
            free = (f"{name}{count}" for count in range(2, len(robot.gazebo) + 3))
            right = next(each for each in free if each not in taken)
            yield Problem.at(
                part.place,
                "warning",
                _CODE,
                f"the model has two <ros2_control> with the name {name} (see "
                f"{where(other.place, part.place)}): the controller manager takes only "
                "one of them",
                write_attribute(part.place, "name", name, right),
            )


def _in_part(part: Element, robot: Robot) -> Iterator[Problem]:
    """Report joints that one <ros2_control> has twice."""
    first: dict[str, Element] = {}
    for joint in part.find_all("joint"):
        name = joint.get("name") or ""
        other = first.setdefault(name, joint)
        if other is joint or other.place == joint.place:
            continue
        taken = {each.get("name") for each in part.find_all("joint")}
        free = [
            each.name
            for each in robot.joints.values()
            if each.type != "fixed" and each.name not in taken
        ]
        right = free[0] if len(free) == 1 else nearest(name, free)
        order = list(robot.joints)
        later = (
            right is not None
            and name in order
            and order.index(right) > order.index(name)
        )
        wrong = joint if later else other
        here = f" for the one on line {wrong.place.line}" * (wrong is other)
        fix = Fix("write the joint that is meant")
        if right is not None:
            edits = write_attribute(wrong.place, "name", name, right).edits
            fix = Fix(f'write name="{right}"{here}', edits)
        yield Problem.at(
            joint.place,
            "warning",
            _CODE,
            f"<ros2_control> has the joint {name} twice (see "
            f"{where(other.place, joint.place)}): the hardware does not start",
            fix,
        )
