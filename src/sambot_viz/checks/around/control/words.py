"""Check words of <ros2_control>: elements, interfaces and hardware."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.edits import (
    move_before,
    put_into,
    write,
    write_as_text,
    write_attribute,
)
from sambot_viz.errors import Fix, Problem
from sambot_viz.robot.model import Robot
from sambot_viz.robot.slips.misspelt import find_slips
from sambot_viz.robot.slips.slip_words import slip_in_words
from sambot_viz.robot.slips.vocabulary import Vocabulary, Word, is_one_slip
from sambot_viz.robot.xml.element import Element

_CODE = "control-interface"
_PARTS = "command_interface state_interface param"
_WORDS = Vocabulary(
    "ros2_control",
    {
        "ros2_control": Word(
            "name type rw_rate is_async thread_priority",
            "hardware",
            "joint sensor gpio",
            "transmission async",
        ),
        "hardware": Word("", "plugin", "param", "group properties"),
        "joint": Word("name mimic", many=_PARTS, also="limits properties"),
        "sensor": Word("name", many=_PARTS, also="limits properties"),
        "gpio": Word("name", many=_PARTS, also="limits properties"),
        "command_interface": Word("name data_type size", many="param", also="limits"),
        "state_interface": Word("name data_type size", many="param", also="limits"),
        "param": Word("name"),
    },
)
_INTERFACES = ("position", "velocity", "effort", "acceleration")
_TYPES = ("system", "actuator", "sensor")
_HARDWARE = (
    "gazebo_ros2_control/GazeboSystem",
    "gz_ros2_control/GazeboSimSystem",
    "ign_ros2_control/IgnitionSystem",
    "mock_components/GenericSystem",
    "fake_components/GenericSystem",
    "topic_based_ros2_control/TopicBasedSystem",
)
"""Hardware that needs no code from the user."""
_AS_TEXT = {
    "plugin": (("name", "type", "class", "value"), "no controller gets the joints"),
    "param": (("value",), "the hardware does not get the parameter"),
}
"""Element → attributes that people write for its text, and what follows."""


def words_of_control(robot: Robot) -> Iterator[Problem]:
    """Report misspelt words that ros2_control does not know."""
    for part in robot.gazebo:
        if part.tag != "ros2_control":
            yield from _inside(part)
            continue
        for slip in find_slips(part, _WORDS):
            said = slip_in_words(slip, False)
            message = said.message.replace("ROS ignores", "ros2_control does not read")
            yield Problem.at(
                slip.element.place, "warning", said.code, message, said.hint
            )
        yield from _attribute(part, "type", _TYPES, "ros2_control knows no type")
        for joint in part.find_all("joint"):
            for interface in joint.children:
                if interface.tag in ("command_interface", "state_interface"):
                    what = f"joints have no {interface.tag.replace('_', ' ')}"
                    yield from _attribute(interface, "name", _INTERFACES, what)
        yield from _in_attributes(part)
        yield from _hardware(part)
        yield from _unlike_others(part, robot)
        yield from _without_state(part)


def _attribute(
    element: Element, name: str, known: tuple[str, ...], what: str
) -> Iterator[Problem]:
    said = element.get(name) or ""
    near = [word for word in known if is_one_slip(said.strip().lower(), word)]
    if said and said not in known and len(near) == 1:
        yield Problem.at(
            element.place,
            "warning",
            _CODE,
            f"{what} {said}: the controllers of the joint do not start",
            write_attribute(element.place, name, said, near[0]),
        )


def _in_attributes(part: Element) -> Iterator[Problem]:
    """Report what ros2_control reads as text, and the model has as an attribute."""
    for element in part.iter():
        names, follows = _AS_TEXT.get(element.tag, ((), ""))
        said = next((n for n in names if element.get(n)), None)
        if element.text.strip() or not (said or element.tag == "plugin"):
            continue
        word = element.get(said) if said else "the class of the hardware"
        edits = write_as_text(element.place, said) if said else ()
        yield Problem.at(
            element.place,
            "warning",
            _CODE,
            f"<{element.tag}> has no text, and ros2_control reads only that: {follows}",
            Fix(f"write {word} between <{element.tag}> and </{element.tag}>", edits),
        )


def _inside(part: Element) -> Iterator[Problem]:
    """Report a <ros2_control> in a <gazebo>."""
    for control in part.find_all("ros2_control"):
        yield Problem.at(
            control.place,
            "warning",
            "element-misplaced",
            "<ros2_control> means nothing in <gazebo>, where nobody reads it: no "
            "controller gets the joints; it belongs in <robot>",
            Fix(
                "move <ros2_control> out of <gazebo>, directly into <robot>",
                move_before(control.place, part.place),
            ),
        )


def _hardware(part: Element) -> Iterator[Problem]:
    for hardware in part.find_all("hardware"):
        for plugin in hardware.find_all("plugin"):
            said = plugin.text.strip()
            near = [known for known in _HARDWARE if is_one_slip(said, known)]
            if near and said not in _HARDWARE:
                yield Problem.at(
                    plugin.place,
                    "warning",
                    _CODE,
                    f"there is no hardware {said}, but {near[0]}: no controller gets "
                    "the joints",
                    write(plugin.place, said, near[0]),
                )


def _unlike_others(part: Element, robot: Robot) -> Iterator[Problem]:
    """Report interfaces that a joint has twice, or lacks while all others have them.

    A joint that mimics another one must not have a command.
    """
    joints = part.find_all("joint")
    mimics = {name for name, joint in robot.joints.items() if joint.mimic is not None}
    free = [joint for joint in joints if joint.get("name") not in mimics]
    usual = [_interfaces(joint) for joint in free if joint.find("param") is None]
    for joint in joints:
        own = _interfaces(joint)
        for at, each in enumerate(own):
            if each in own[:at]:
                yield _again(joint, each, usual)
        others = [found for found in usual if set(found) != set(own)]
        is_one = joint in free and len(usual) - len(others) == 1
        same = is_one and len(others) > 1
        lacks = [each for each in others[0] if each not in own] if same else []
        if len(set(map(frozenset, others))) == 1 and len(lacks) == 1:
            ((tag, name),) = lacks
            if len(set(own)) < len(others[0]) and joint.find("param") is None:
                added = f'<{tag} name="{name}"/>'
                yield Problem.at(
                    joint.place,
                    "info",
                    _CODE,
                    f"the joint {joint.get('name')} has no {tag.replace('_', ' ')} "
                    f"{name}, which all other joints of this <ros2_control> have",
                    Fix(f"add {added} to the joint", put_into(joint.place, added)),
                )


def _without_state(part: Element) -> Iterator[Problem]:
    """Report a joint without any state, where all others have one."""
    states = {joint: _of_kind(joint, "state") for joint in part.find_all("joint")}
    for joint, own in states.items():
        commands = _of_kind(joint, "command")
        others = [other for other in states if other is not joint]
        alike = [states[o] for o in others if _of_kind(o, "command") == commands]
        # Where all others have one more, that is reported already.
        several = len(alike) > 1 and len(alike[0]) == 1
        is_odd = bool(alike) and all(states[other] for other in others)
        if own or not commands or not is_odd or several:
            continue
        added = "".join(f'<state_interface name="{name}"/>' for name in alike[0])
        yield Problem.at(
            joint.place,
            "warning",
            _CODE,
            f"the joint {joint.get('name')} has no state interface, and all others "
            "have one: no joint state of it is published",
            Fix(f"add {added} to the joint", put_into(joint.place, added)),
        )


def _of_kind(joint: Element, kind: str) -> list[str]:
    return [n for tag, n in _interfaces(joint) if tag == f"{kind}_interface"]


def _interfaces(joint: Element) -> list[tuple[str, str]]:
    tags = ("command_interface", "state_interface")
    return [(e.tag, e.get("name") or "") for e in joint.children if e.tag in tags]


def _again(
    joint: Element, said: tuple[str, str], usual: Sequence[Sequence[tuple[str, str]]]
) -> Problem:
    """Report an interface that a joint has twice."""
    tag, name = said
    wrong = [e for e in joint.find_all(tag) if e.get("name") == name][-1]
    have = {n for found in usual for t, n in found if t == tag}
    missing = [n for n in (*_INTERFACES, *have) if (tag, n) not in _interfaces(joint)]
    right = next((n for n in missing if n in have), missing[0])
    return Problem.at(
        wrong.place,
        "warning",
        _CODE,
        f"the joint {joint.get('name')} has the {tag.replace('_', ' ')} {name} twice",
        write_attribute(wrong.place, "name", name, right)
        if right in have or len({n for _, n in _interfaces(joint)}) == 1
        else f"delete one, or write another one, such as {right}",
    )
