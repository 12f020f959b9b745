"""Compare joints and interfaces of <ros2_control> with the needs of controllers."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from sambot_viz.checks.around.control.controllers import declared_controllers
from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.parameters import Parameter, place_of
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import put_into, write, write_attribute
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.xml.element import Element

_CODE = "control-interface"
_COMMAND, _STATE = "command_interface", "state_interface"
_USUAL = "position"
"""The right interface where a controller and a joint differ."""
_COVERED = frozenset({"left_wheel_names", "right_wheel_names"})
"""Parameters for wheels, whose missing joints another rule reports."""


class _NeededInterface(NamedTuple):
    """An interface of a joint that a controller needs.

    Attributes:
        controller: its name.
        joint: the joint, where the parameters name it.
        kind: command_interface or state_interface.
        name: of the interface.
        said: the line of the parameters with the interface; None for one of the class.
        parameter: the parameter with the joint.
    """

    controller: str
    joint: Fact
    kind: str
    name: str
    said: Place | None
    parameter: str


def unfit_interfaces(around: Surroundings) -> Iterator[Problem]:
    """Report joints that <ros2_control> lacks, or that lack an interface."""
    joints: dict[str, list[Element]] = {}
    for part in around.robot.gazebo:
        for joint in part.find_all("joint") if part.tag == "ros2_control" else ():
            joints.setdefault(joint.get("name") or "", []).append(joint)
    done: set[tuple[Place | str, str]] = set()
    needs = list(_needs(around)) if joints else []
    single = _of_a_single_robot(needs, joints)
    # The joints of a controller with its class in its own section may be those of
    # another robot, or of a controller before it.
    declared = declared_controllers(around) if needs else {}
    single |= {
        need.controller
        for need in needs
        if need.joint.value not in joints
        and declared[need.controller].name == "type"
        and need.joint.place.file not in around.ownership.own
    }
    for need in needs:
        if need.controller in single:
            continue
        name = need.joint.value
        if name not in joints:
            if need.parameter in _COVERED and name not in around.robot.joints:
                continue
            problem = _without_joint(around, need, joints)
        elif _has(joints[name], need):
            continue
        else:
            problem = _without_interface(need, joints[name][0])
        mark = (problem.place or need.joint.place, need.name)
        if mark not in done and "$" not in name + need.name:
            done.add(mark)
            yield problem


def _of_a_single_robot(
    needs: Sequence[_NeededInterface], joints: Mapping[str, list[Element]]
) -> set[str]:
    """Return the controllers of one robot where the model has two, with prefixes."""
    named: dict[str, set[str]] = {}
    for need in needs:
        named.setdefault(need.controller, set()).add(need.joint.value)
    return {
        controller
        for controller, names in named.items()
        if len(names) > 1
        and all(sum(j.endswith(f"_{name}") for j in joints) > 1 for name in names)
    }


def _has(joints: list[Element], need: _NeededInterface) -> bool:
    found = (i.get("name") for joint in joints for i in joint.find_all(need.kind))
    return need.name in found


def _needs(around: Surroundings) -> Iterator[_NeededInterface]:
    classes = vocabulary("controllers")
    of_model = {
        posixpath.basename(fact.value)
        for plugin in around.plugins
        for fact in plugin.all("parameters")
    }
    for name, kind in declared_controllers(around).items():
        named, is_own = kind.place.file, kind.place.file in around.ownership.own
        if of_model and posixpath.basename(named) not in of_model and not is_own:
            # Another robot of the package has these.
            continue
        several = kind.name == "type" and not of_model and not is_own
        if several and _has_other_robots(around):
            # Any of the robots may have a controller with a section of its own.
            continue
        file = next(f for f in around.yaml_files if f.shown == kind.place.file)
        keys = [key for key in file.nodes if key.rpartition("/")[2] == name]
        given = {n: p for key in keys for n, p in file.of(key).items()}
        for word in classes.get(kind.fact.value, ()):
            sign = "<" if "<" in word else "="
            joints, found, interface = word.partition(sign)
            if found and joints in given:
                where_ = _STATE if sign == "<" else _COMMAND
                for said, place in _interfaces(interface, given):
                    for joint in _items(given[joints]):
                        yield _NeededInterface(name, joint, where_, said, place, joints)


def _has_other_robots(around: Surroundings) -> bool:
    """Return whether another model of the package has a <ros2_control>."""
    own = {file.name for file in around.robot.files}
    return any(
        "<ros2_control" in (around.files.text(path) or "")
        for path in around.files.ending(".xacro", ".urdf", ".sdf")
        if posixpath.basename(path) not in own
    )


def _interfaces(
    word: str, given: Mapping[str, Parameter]
) -> Iterator[tuple[str, Place | None]]:
    """Yield the interfaces that a word of the table means, with their places."""
    if not word.startswith("$"):
        yield word, None
    elif word[1:] in given:
        for fact in _items(given[word[1:]]):
            yield fact.value, fact.place


def _items(parameter: Parameter) -> Iterator[Fact]:
    """Yield the texts of a parameter, each with its place.

    Without those with a <word>, which ReplaceString of Nav2 replaces at the start.
    """
    written, file = parameter.written, parameter.place.file
    is_list = isinstance(written, yaml.SequenceNode)
    nodes: list[yaml.Node] = written.value if is_list else [written]
    for node in nodes:
        if isinstance(node, yaml.ScalarNode) and "<" not in node.value:
            yield Fact(node.value, place_of(node, file))


def _without_joint(
    around: Surroundings, need: _NeededInterface, joints: Mapping[str, list[Element]]
) -> Problem:
    """Report a joint of a controller that <ros2_control> does not have."""
    name, place = need.joint.value, need.joint.place
    first = next(iter(joints.values()))[0]
    near = None if name in around.robot.joints else nearest(name, joints)
    return Problem.at(
        place,
        "warning",
        _CODE,
        f"{need.controller} names the joint {name}, but <ros2_control> has "
        f"{listed(list(joints))} ({where(first.place, place)}): the controller does "
        "not start",
        write(place, name, near)
        if near is not None
        else f'add <joint name="{name}"> with its interfaces to <ros2_control>',
    )


def _without_interface(need: _NeededInterface, joint: Element) -> Problem:
    """Report an interface that a controller needs and a joint does not have."""
    own = joint.find_all(need.kind)
    names = [each.get("name") or "" for each in own]
    kind, name = need.kind.replace("_", " "), need.joint.value
    if need.said is not None and _USUAL in names and need.name != _USUAL:
        if need.kind == _COMMAND:
            return Problem.at(
                need.said,
                "warning",
                _CODE,
                f"{need.controller} needs the {kind} {need.name}, but {name} has "
                f"{listed(names)} ({where(own[0].place, need.said)}): the controller "
                "does not start",
                write(need.said, need.name, names[0]),
            )
    place = own[0].place if len(own) == 1 and need.kind == _COMMAND else joint.place
    added = f'<{need.kind} name="{need.name}"/>'
    fix = Fix(f"add {added} to the joint", put_into(joint.place, added))
    if place is not joint.place:
        fix = write_attribute(place, "name", names[0], need.name)
    has = f", which has {listed(names)}" if names else ", which has none"
    return Problem.at(
        place,
        "warning",
        _CODE,
        f"{need.controller} ({where(need.said or need.joint.place, place)}) needs the "
        f"{kind} {need.name} of {name}{has}: the controller does not start",
        fix,
    )
