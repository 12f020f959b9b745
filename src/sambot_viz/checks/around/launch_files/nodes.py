"""Check what launch files give to the nodes that they start."""

from __future__ import annotations

import ast
import posixpath
import re
from collections.abc import Iterator

from sambot_viz.checks.around.launch_files.names import bound_names
from sambot_viz.checks.around.launching.actions import RobotText
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import (
    Call,
    Pair,
    PythonValue,
    Table,
)
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import write_attribute
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.xml.element import Element

_PUBLISHER, _DESCRIPTION = "robot_state_publisher", "robot_description"
_JOINT_PUBLISHERS = ("joint_state_publisher", "joint_state_publisher_gui")
_MODELS = (".urdf", ".xacro", ".sdf")
_CONDITIONS = frozenset({"IfCondition", "UnlessCondition"})
_SUBSTITUTION = re.compile(r"\$\([^()]*\)")
_LIKENESS = 0.8


def descriptions(around: Surroundings) -> Iterator[Problem]:
    """Report a robot_state_publisher that does not get the text of a model."""
    for launch, call in _nodes(around):
        if launch.text(call, "executable") != _PUBLISHER:
            continue
        given = call.listing("parameters")
        tables = [item for item, _ in given.items if isinstance(item, Table)]
        keys = {p.key: p for t in tables for p in t.pairs if isinstance(p.key, str)}
        plain = next((node for item, node in given.items if _is_model(item)), None)
        if plain is not None and _DESCRIPTION not in keys:
            right = f"{{'{_DESCRIPTION}': {ast.unparse(plain)}}}"
            yield Problem.at(
                launch.place(plain),
                "error",
                "launch-description",
                "a text in parameters is the path of a file, but this is the text of "
                f"the model: {_PUBLISHER} stops, and has no {_DESCRIPTION}",
                rewritten(plain, launch.shown, right),
            )
            continue
        if _DESCRIPTION in keys:
            yield from _without_text(keys[_DESCRIPTION], launch)
            continue
        near = nearest(_DESCRIPTION, keys, _LIKENESS)
        known = given.complete and len(tables) == len(given.items)
        pairs = sum(len(t.pairs) for t in tables)
        known = known and all(t.complete for t in tables) and len(keys) == pairs
        if near is not None:
            yield Problem.at(
                launch.place(keys[near].key_node),
                "error",
                "launch-description",
                f"{_PUBLISHER} reads the parameter {_DESCRIPTION}, but this is "
                f"{near}: it stops without a model",
                rewritten(keys[near].key_node, launch.shown, f"'{_DESCRIPTION}'"),
            )
        elif known and _gets_nothing_else(launch, call):
            yield Problem.at(
                call.place,
                "error",
                "launch-description",
                f"{_PUBLISHER} gets no {_DESCRIPTION}: it stops without a model",
                "write parameters=[{'robot_description': Command(['xacro ', MODEL])}], "
                "with the path of the model for MODEL",
            )


def _is_model(item: PythonValue) -> bool:
    if isinstance(item, RobotText):
        return True
    return isinstance(item, str) and item.lstrip().startswith(("<robot", "<?xml"))


def described_in_xml(around: Surroundings) -> Iterator[Problem]:
    """Report a robot_state_publisher without a model's text in XML and YAML files."""
    for root in (root for package in around.packages for root in package.frontends):
        for node in root.iter():
            params = {p.get("name") or "": p for p in node.find_all("param")}
            if node.get("exec") == _PUBLISHER and _DESCRIPTION in params:
                yield from _without_command(params[_DESCRIPTION])
            if node.get("exec") != _PUBLISHER or {"", _DESCRIPTION} & {*params}:
                continue
            if node.get("args") is not None:
                continue
            texts = [n for n, p in params.items() if "$(command" in str(p.get("value"))]
            near = nearest(_DESCRIPTION, params, _LIKENESS) or next(iter(texts), None)
            place = params[near].place if near else node.place
            is_xml = not place.file.endswith((".yaml", ".yml"))
            hint = f'write name="{_DESCRIPTION}"'
            yield Problem.at(
                place,
                "error",
                "launch-description",
                f"{_PUBLISHER} gets no {_DESCRIPTION}"
                + (f", but {near}" if near else "")
                + ": it stops without a model",
                write_attribute(place, "name", near, _DESCRIPTION, hint=hint)
                if near and is_xml
                else hint,
            )


def _without_command(param: Element) -> Iterator[Problem]:
    """Report the command or the path that reads a model, in place of its result."""
    value = (param.get("value") or "").strip()
    program, blank, rest = value.partition(" ")
    path = rest if blank and program == "xacro" else value
    is_path = path.endswith(_MODELS) and "<" not in path and "command" not in value
    is_call = blank and program == "xacro"
    if not is_call and (not is_path or " " in _SUBSTITUTION.sub("", path)):
        return
    what = "a command that is not run" if is_call else f"the path {path}"
    right = f"$(command 'xacro {path.strip()}')"
    hint = f'write value="{right}"'
    is_xml = not param.place.file.endswith((".yaml", ".yml"))
    yield Problem.at(
        param.place,
        "error",
        "launch-description",
        f"{_DESCRIPTION} is {what}, not the text of the model: {_PUBLISHER} stops",
        write_attribute(param.place, "value", value, right, hint=hint)
        if is_xml and "'" not in path
        else hint,
    )


def _gets_nothing_else(launch: LaunchFile, call: Call) -> bool:
    """Return whether a call has all parameters, and no arguments."""
    others = {"SetParameter", "SetParametersFromFile", "GroupAction"}
    return (
        call.complete
        and call.given("arguments") is None
        and all(other.name not in others for other in launch.calls)
    )


def _without_text(pair: Pair, launch: LaunchFile) -> Iterator[Problem]:
    """Report a path, an unread file or an XML document in place of a model's text."""
    text, bare = launch.values.said(pair.value), ast.unparse(pair.node)
    given = launch.origin(pair.node)
    what = better = None
    if text is not None and text.endswith(_MODELS) and "<" not in text:
        what = f"the path of {posixpath.basename(text)}"
        better = _command(pair.node, bound_names(launch.tree))
    elif isinstance(given, ast.Call):
        name = call_name(given.func)
        if name == "open":
            what, better = "a file that is not read", f"{bare}.read()"
        elif name == "process_file":
            what, better = "a document of xacro", f"{bare}.toxml()"
    elif isinstance(given, ast.Attribute) and given.attr in ("read", "toxml"):
        if isinstance(given.value, ast.Call):
            what, better = f"the function {given.attr}", f"{bare}()"
    if what is not None and better is not None:
        yield Problem.at(
            launch.place(pair.node),
            "error",
            "launch-description",
            f"{_DESCRIPTION} is {what}, not the text of the model: {_PUBLISHER} stops",
            f"write {better}",
        )


def _command(value: ast.expr, bound: set[str]) -> str:
    """Write the expression that reads a model, for its path in a launch file."""
    while isinstance(value, ast.Call) and call_name(value.func) == "ParameterValue":
        value = value.args[0]
    command = f"Command(['xacro ', {ast.unparse(value)}])"
    if "ParameterValue" in bound:
        command = f"ParameterValue({command}, value_type=str)"
    if "Command" not in bound:
        command += ", and from launch.substitutions import Command at the top"
    return command


def rviz_without_option(around: Surroundings) -> Iterator[Problem]:
    """Report a config for rviz2 without -d before it."""
    for launch, call in _nodes(around):
        if launch.text(call, "executable") != "rviz2":
            continue
        option: str | None = ""
        for item, node in call.listing("arguments").items:
            text = launch.values.said(item)
            known = option is not None and option[:1] != "-"
            option = text
            if text is None or not text.endswith(".rviz") or text[0] == "-":
                # Also -dFILE and --display-config=FILE.
                continue
            if known and " " not in text:
                yield Problem.at(
                    launch.place(node),
                    "warning",
                    "launch-rviz-config",
                    f"rviz2 reads a config only after -d: {posixpath.basename(text)} "
                    "is not opened",
                    f"write '-d', {ast.unparse(node)}",
                )


def state_publishers(around: Surroundings) -> Iterator[Problem]:
    """Report two publishers of joint states that start together, or not at all."""
    for launch in around.launches:
        found = {launch.text(call, "executable"): call for call in launch.called()}
        both = [found[name] for name in _JOINT_PUBLISHERS if name in found]
        given = [call.given("condition") for call in both]
        nodes = [launch.origin(node) for node in given if node is not None]
        conditions = [node for node in nodes if isinstance(node, ast.Call)]
        if len(conditions) < len(_JOINT_PUBLISHERS):
            continue
        one, other = conditions
        if ast.dump(one) != ast.dump(other) or call_name(one.func) not in _CONDITIONS:
            continue
        # One of the two is for the argument, the other one for its opposite.
        at = 1 if call_name(one.func) == "UnlessCondition" else 0
        right = "IfCondition" if at else "UnlessCondition"
        place = both[at].place
        argument = ast.unparse(one.args[0]) if one.args else ""
        yield Problem.at(
            Place(launch.shown, launch.place(given[at] or one).line),
            "warning",
            "launch-no-joint-states",
            f"{_JOINT_PUBLISHERS[at]} has the same condition as "
            f"{_JOINT_PUBLISHERS[1 - at]} ({where(both[1 - at].place, place)}): either "
            "both publish joint states or neither does, and the wheels have no "
            "transform",
            f"write condition={right}({argument})",
        )


def namespaces(around: Surroundings) -> Iterator[Problem]:
    """Report a robot_state_publisher that does not hear the joint_state_publisher."""
    for launch in around.launches:
        if any(launch.called("PushRosNamespace", "PushROSNamespace")):
            continue
        spaces: dict[str | None, list[tuple[str | None, Call]]] = {}
        for call in launch.called():
            space = launch.text(call, "namespace")
            space = "" if call.given("namespace") is None else space
            if call.given("remappings") is not None or space is None:
                space = None
            program = launch.text(call, "executable")
            spaces.setdefault(program, []).append((space and space.strip("/"), call))
        readers = spaces.get(_PUBLISHER, [])
        writers = [each for name in _JOINT_PUBLISHERS for each in spaces.get(name, [])]
        others = {space for space, _ in writers}
        if len(readers) != 1 or len(others) != 1:
            continue
        ((space, reader),) = readers
        other, writer = writers[0]
        if space is None or other is None or space == other:
            continue
        odd = reader if space else writer
        place = launch.place(odd.given("namespace") or odd.node)
        read, written = (
            f"/{s}/joint_states".replace("//", "/") for s in (space, other)
        )
        program = launch.text(writer, "executable")
        yield Problem.at(
            place,
            "warning",
            "launch-namespace",
            f"{_PUBLISHER} reads {read}, but {program} ({where(writer.place, place)}) "
            f"publishes {written}: wheels and other joints that move have no transform",
            "delete the namespace here, or write it for "
            f"{program if space else _PUBLISHER} too",
        )


def _nodes(around: Surroundings) -> Iterator[tuple[LaunchFile, Call]]:
    for launch in around.launches:
        for call in launch.called():
            yield launch, call
