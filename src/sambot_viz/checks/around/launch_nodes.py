"""What launch files give to the nodes that they start."""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from sambot_viz.checks.around.files.launch import NODES, LaunchFile, LaunchNode
from sambot_viz.checks.around.files.launch_values import SHARE, keyword
from sambot_viz.checks.around.files.parameters import YamlFile
from sambot_viz.checks.around.launch_code import bound_names
from sambot_viz.checks.around.launch_paths import OWN_NAMES
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.launch_files import call_name
from sambot_viz.errors import Place, Problem, nearest

_PUBLISHER, _DESCRIPTION = "robot_state_publisher", "robot_description"
_JOINT_PUBLISHERS = ("joint_state_publisher", "joint_state_publisher_gui")
_MODELS = (".urdf", ".xacro", ".sdf")
_CONDITIONS = frozenset({"IfCondition", "UnlessCondition"})
_LIKENESS = 0.8


class _Wrong(NamedTuple):
    """An argument of a node that launch does not take.

    Attributes:
        argument: its name.
        kind: the expression.
        what: what it is called.
        follows: what happens.
    """

    argument: str
    kind: type[ast.expr]
    what: str
    follows: str


_WRONG = (
    _Wrong("parameters", ast.Dict, "a dict", "ros2 launch stops with it"),
    _Wrong("remappings", ast.Dict, "a dict", "ros2 launch stops with it"),
    _Wrong(
        "arguments",
        ast.Constant,
        "a text",
        "the program gets each of its letters as an argument",
    ),
)


def arguments_without_list(around: Surroundings) -> Iterator[Problem]:
    """Report parameters, remappings and arguments that are no lists."""
    for launch, call in _nodes(around):
        for wrong in _WRONG:
            given = keyword(call, wrong.argument)
            value = launch.values.resolved(given)
            if given is None or not isinstance(value, wrong.kind):
                continue
            if isinstance(value, ast.Constant) and not isinstance(value.value, str):
                continue
            pairs = _pairs(given, wrong.argument)
            yield Problem.at(
                launch.place(given),
                "error",
                "launch-no-list",
                f"{wrong.argument} of a node is a list, but this is {wrong.what}: "
                f"{wrong.follows}",
                rewritten(
                    given,
                    launch.shown,
                    f"[{pairs}]",
                    f"write {wrong.argument}=[{pairs}]",
                ),
            )


def _pairs(given: ast.expr, argument: str) -> str:
    """Write what is to be in the list."""
    if argument == "remappings" and isinstance(given, ast.Dict):
        both = zip(given.keys, given.values, strict=True)
        known = [(ast.unparse(key), ast.unparse(value)) for key, value in both if key]
        return ", ".join(f"({old}, {new})" for old, new in known)
    if isinstance(given, ast.Constant) and isinstance(given.value, str):
        return ", ".join(repr(word) for word in given.value.split())
    return ast.unparse(given)


def descriptions(around: Surroundings) -> Iterator[Problem]:
    """Report a robot_state_publisher that does not get the text of a model."""
    for launch, call in _nodes(around):
        if launch.values.text(keyword(call, "executable")) != _PUBLISHER:
            continue
        items = launch.values.items(keyword(call, "parameters"))
        tables = [item for item in items if isinstance(item, ast.Dict)]
        keys = {
            key.value: (key, value)
            for table in tables
            for key, value in zip(table.keys, table.values, strict=True)
            if isinstance(key, ast.Constant) and isinstance(key.value, str)
        }
        if _DESCRIPTION in keys:
            yield from _without_text(keys[_DESCRIPTION][1], launch)
            continue
        near = nearest(_DESCRIPTION, keys, _LIKENESS)
        known = len(tables) == len(items) and all(
            isinstance(key, ast.Constant) for table in tables for key in table.keys
        )
        if near is not None:
            yield Problem.at(
                launch.place(keys[near][0]),
                "error",
                "launch-description",
                f"{_PUBLISHER} reads the parameter {_DESCRIPTION}, but this is "
                f"{near}: it stops without a model",
                rewritten(keys[near][0], launch.shown, f"'{_DESCRIPTION}'"),
            )
        elif known and _gets_nothing_else(launch, call):
            yield Problem.at(
                launch.place(call),
                "error",
                "launch-description",
                f"{_PUBLISHER} gets no {_DESCRIPTION}: it stops without a model",
                "write parameters=[{'robot_description': Command(['xacro ', MODEL])}], "
                "with the path of the model for MODEL",
            )


def _gets_nothing_else(launch: LaunchFile, call: ast.Call) -> bool:
    """True when all parameters are in the call, and there are no arguments."""
    given = keyword(call, "parameters")
    listed = given is None or isinstance(
        launch.values.resolved(given), (ast.List, ast.Tuple)
    )
    others = {"SetParameter", "SetParametersFromFile", "GroupAction"}
    return (
        listed
        and keyword(call, "arguments") is None
        and all(k.arg for k in call.keywords)
        and all(call_name(other.func) not in others for other in launch.calls)
    )


def _without_text(value: ast.expr, launch: LaunchFile) -> Iterator[Problem]:
    """Report a path, a file that is not read, and a document that is no text."""
    given = launch.values.resolved(value)
    text, bare = launch.values.text(value), ast.unparse(value)
    what = better = None
    if text is not None and text.endswith(_MODELS) and "<" not in text:
        what = f"the path of {posixpath.basename(text)}"
        better = _command(value, bound_names(launch.tree))
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
            launch.place(value),
            "error",
            "launch-description",
            f"{_DESCRIPTION} is {what}, not the text of the model: {_PUBLISHER} stops",
            f"write {better}",
        )


def _command(value: ast.expr, bound: set[str]) -> str:
    """Write what reads a model, for its path in a launch file."""
    while isinstance(value, ast.Call) and call_name(value.func) == "ParameterValue":
        value = value.args[0]
    command = f"Command(['xacro ', {ast.unparse(value)}])"
    if "ParameterValue" in bound:
        command = f"ParameterValue({command}, value_type=str)"
    if "Command" not in bound:
        command += ", and from launch.substitutions import Command at the top"
    return command


def rviz_without_option(around: Surroundings) -> Iterator[Problem]:
    """Report a config that is given to rviz2 without -d."""
    for launch, call in _nodes(around):
        given = launch.values.resolved(keyword(call, "arguments"))
        items = given.elts if isinstance(given, (ast.List, ast.Tuple)) else []
        if launch.values.text(keyword(call, "executable")) != "rviz2":
            continue
        for before, item in pairwise([None, *items]):
            text = launch.values.text(item) or ""
            option = None if before is None else launch.values.text(before)
            known = before is None or (option is not None and option[:1] != "-")
            if (
                item is not None
                and text.endswith(".rviz")
                and known
                and " " not in text
            ):
                yield Problem.at(
                    launch.place(item),
                    "warning",
                    "launch-rviz-config",
                    f"rviz2 reads a config only after -d: {posixpath.basename(text)} "
                    "is not opened",
                    f"write '-d', {ast.unparse(item)}",
                )


def parameters_left_out(around: Surroundings) -> Iterator[Problem]:
    """Report a node that does not get the file with its parameters."""
    used = {
        around.shown(fact.value) for launch in around.launches for fact in launch.paths
    }
    said = {text for launch in around.launches for text in launch.strings}
    for launch in around.launches:
        for node in launch.nodes:
            name = node.name or OWN_NAMES.get(node.executable)
            if not name or node.files or not node.complete or node.arguments:
                continue
            files = [
                (package, file)
                for package in around.packages
                for file in package.yaml_files
                if name in {key.rpartition("/")[2] for key in file.nodes}
            ]
            if len(files) != 1:
                continue
            ((package, file),) = files
            unsaid = not any(posixpath.basename(file.path) in text for text in said)
            if file.shown not in used and unsaid and not _gives(launch, node, file):
                yield _left_out(launch, node, name, file, package)


def _gives(launch: LaunchFile, node: LaunchNode, file: YamlFile) -> bool:
    """Tell whether a launch file itself gives a node parameters that a file has."""
    names = {p.name for p in file.parameters}
    return any(
        launch.values.text(key) in names - {"use_sim_time"}
        for call in launch.calls
        if launch.place(call) == node.place
        for item in launch.values.items(keyword(call, "parameters"))
        if isinstance(item, ast.Dict)
        for key in item.keys
    )


def _left_out(
    launch: LaunchFile,
    node: LaunchNode,
    name: str,
    file: YamlFile,
    package: Package,
) -> Problem:
    key = next(k for k in file.nodes if k.rpartition("/")[2] == name)
    share = launch.values.named(f"{SHARE}{package.name}")
    share = share or f"get_package_share_directory('{package.name}')"
    return Problem.at(
        node.place,
        "warning",
        "launch-parameters-missing",
        f"no node is given the parameters for {name} "
        f"({where(file.nodes[key], node.place)}): it runs with its defaults",
        f"add os.path.join({share}, '{file.path}') to its parameters",
    )


def state_publishers(around: Surroundings) -> Iterator[Problem]:
    """Report two publishers of joint states that start together, or not at all."""
    for launch in around.launches:
        found: dict[str, tuple[ast.Call, ast.Call]] = {}
        for call in launch.calls:
            program = launch.values.text(keyword(call, "executable"))
            condition = launch.values.resolved(keyword(call, "condition"))
            if call_name(call.func) in NODES and program in _JOINT_PUBLISHERS:
                if isinstance(condition, ast.Call):
                    found[program] = call, condition
        if len(found) < len(_JOINT_PUBLISHERS):
            continue
        (first, one), (second, other) = (found[name] for name in _JOINT_PUBLISHERS)
        if ast.dump(one) != ast.dump(other) or call_name(one.func) not in _CONDITIONS:
            continue
        # One of the two is for the argument, the other one for its opposite.
        wanted = "IfCondition"
        wrong = second if call_name(one.func) != wanted else first
        right = wanted if wrong is second else "UnlessCondition"
        place = launch.place(wrong)
        names = _JOINT_PUBLISHERS if wrong is first else _JOINT_PUBLISHERS[::-1]
        argument = ast.unparse(one.args[0]) if one.args else ""
        there = where(launch.place(second if wrong is first else first), place)
        yield Problem.at(
            Place(launch.shown, _line(wrong, "condition")),
            "warning",
            "launch-no-joint-states",
            f"{names[0]} has the same condition as {names[1]} ({there}): either both "
            "publish joint states or neither does, and the wheels have no transform",
            f"write condition={right}({argument})",
        )


def _line(call: ast.Call, argument: str) -> int:
    given = keyword(call, argument)
    return call.lineno if given is None else given.lineno


def namespaces(around: Surroundings) -> Iterator[Problem]:
    """Report a robot_state_publisher that does not hear the joint_state_publisher."""
    for launch in around.launches:
        if any(
            call_name(call.func) in ("PushRosNamespace", "PushROSNamespace")
            for call in launch.calls
        ):
            continue
        spaces: dict[str, list[tuple[str | None, ast.Call]]] = {}
        for call in launch.calls:
            program = launch.values.text(keyword(call, "executable"))
            if call_name(call.func) in NODES and program:
                given = keyword(call, "namespace")
                space = launch.values.text(given) if given is not None else ""
                if keyword(call, "remappings") is not None:
                    space = None
                spaces.setdefault(program, []).append((space, call))
        readers = spaces.get(_PUBLISHER, [])
        writers = [each for name in _JOINT_PUBLISHERS for each in spaces.get(name, [])]
        if len(readers) != 1 or not writers:
            continue
        ((space, reader),) = readers
        others = {None if other is None else other.strip("/") for other, _ in writers}
        if space is None or None in others or len(others) != 1:
            continue
        (other,) = others
        if space.strip("/") == other or other is None:
            continue
        odd = reader if space.strip("/") else writers[0][1]
        place = launch.place(keyword(odd, "namespace") or odd)
        yield _apart(launch, place, reader, writers[0][1], (space.strip("/"), other))


def _apart(
    launch: LaunchFile,
    place: Place,
    reader: ast.Call,
    writer: ast.Call,
    spaces: tuple[str, str],
) -> Problem:
    read, written = (f"/{s}/joint_states".replace("//", "/") for s in spaces)
    program = launch.values.text(keyword(writer, "executable"))
    there = where(launch.place(writer), place)
    return Problem.at(
        place,
        "warning",
        "launch-namespace",
        f"{_PUBLISHER} reads {read}, but {program} ({there}) publishes {written}: "
        "wheels and other joints that move have no transform",
        f"delete the namespace here, or write it for {program} too"
        if spaces[0]
        else f"delete the namespace here, or write it for {_PUBLISHER} too",
    )


def _nodes(around: Surroundings) -> Iterator[tuple[LaunchFile, ast.Call]]:
    for launch in around.launches:
        for call in launch.calls:
            if call_name(call.func) in NODES:
                yield launch, call
