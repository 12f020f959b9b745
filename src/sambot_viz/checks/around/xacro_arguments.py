"""The arguments that launch files give to xacro for a model."""

from __future__ import annotations

import ast
import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path

from sambot_viz.checks.around.files.launch import LaunchFile
from sambot_viz.checks.around.files.launch_values import SHARE, keyword
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.launch_files import call_name

_UNKNOWN = "\0"


def xacro_arguments(
    model: Path, packages: Sequence[Package]
) -> Iterator[dict[str, str]]:
    """Give the arguments that launch files give to a model; the first value counts.

    Launch arguments stand for their default values, or for the first of their choices.
    A second answer has 0, a number and a text, for values that are known only when a
    launch file runs.
    """
    found: dict[str, str] = {}
    unknown: dict[str, str] = {}
    launches = [file for package in packages for file in package.launches]
    defaults = {k: v for file in launches for k, v in file.values.defaults()}
    opening = (f for f in launches if any(model.name in text for text in f.strings))
    for launch in opening:
        for name, value in _given(launch):
            path = None if _UNKNOWN in value else _path(value, packages)
            if path is not None:
                found.setdefault(name, path)
            else:
                unknown.setdefault(name, "0")
    known = {**defaults, **found}
    if known:
        yield known
    if unknown.keys() - known.keys():
        yield {**unknown, **known}


def _given(launch: LaunchFile) -> Iterator[tuple[str, str]]:
    choices = dict(_choices(launch))
    for call in launch.calls:
        if call_name(call.func) == "Command" and call.args:
            words = launch.values.items(call.args[0])
            command = "".join(_text(launch, word, choices) for word in words)
            yield from _arguments(command)
        elif call_name(call.func) == "process_file":
            given = launch.values.resolved(keyword(call, "mappings"))
            for key, value in _items(given):
                name, text = launch.values.text(key), _text(launch, value, choices)
                if name:
                    yield name, text


def _arguments(command: str) -> Iterator[tuple[str, str]]:
    """Give the NAME:=VALUE of a command line, as ros2 launch splits it."""
    try:
        words = shlex.split(command)
    except ValueError:
        return
    for word in words:
        name, mark, value = word.partition(":=")
        if mark and _UNKNOWN not in name:
            yield name, value


def _items(node: ast.expr | None) -> Iterator[tuple[ast.expr | None, ast.expr]]:
    if isinstance(node, ast.Dict):
        yield from zip(node.keys, node.values, strict=True)


def _choices(launch: LaunchFile) -> Iterator[tuple[str, str]]:
    """Give the launch arguments with a list of values, and the first of them."""
    for call in launch.calls:
        if call_name(call.func) == "DeclareLaunchArgument":
            name = launch.values.text(keyword(call, "name", 0))
            first = next(launch.values.texts(keyword(call, "choices")), None)
            if name and first:
                yield name, first


def _text(launch: LaunchFile, node: ast.expr, choices: dict[str, str]) -> str:
    text = launch.values.text(node)
    if text is None and isinstance(node, ast.Call):
        argument = launch.values.text(keyword(node, "variable_name", 0))
        if call_name(node.func) == "LaunchConfiguration" and argument:
            text = choices.get(argument)
    return _UNKNOWN if text is None else text


def _path(value: str, packages: Sequence[Package]) -> str | None:
    """Return a value with the folder of a package for its share folder."""
    if SHARE not in value:
        return value
    name, _, below = value.removeprefix(SHARE).partition("/")
    folder = next((p.folder for p in packages if p.name == name), None)
    return None if folder is None else str(folder / below)
