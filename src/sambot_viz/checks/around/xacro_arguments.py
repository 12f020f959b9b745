"""The arguments that launch files give to xacro for a model."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launch_file import LaunchFile
from sambot_viz.checks.around.launching.actions import LaunchArgument
from sambot_viz.checks.around.launching.python_parts import PythonValue, Table
from sambot_viz.checks.around.workspace import Package

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
    defaults = {k: v for file in launches for k, v in file.values.defaults.items()}
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
        if call.name == "Command" and call.node.args:
            words = call.listing("command", 0).items
            command = "".join(_text(launch, word, choices) for word, _ in words)
            yield from _arguments(command)
        elif call.name == "process_file":
            given = call.value("mappings")
            for pair in given.pairs if isinstance(given, Table) else ():
                name = launch.values.said(pair.key)
                if name:
                    yield name, _text(launch, pair.value, choices)


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


def _choices(launch: LaunchFile) -> Iterator[tuple[str, str]]:
    """Give the launch arguments with a list of values, and the first of them."""
    for call in launch.calls:
        if call.name == "DeclareLaunchArgument":
            name = launch.text(call, "name", 0)
            texts = launch.values.texts(call.given("choices"))
            if name and texts:
                yield name, texts[0]


def _text(launch: LaunchFile, value: PythonValue, choices: dict[str, str]) -> str:
    text = launch.values.said(value)
    if text is None and isinstance(value, LaunchArgument):
        text = choices.get(launch.values.said(value.name) or "")
    return _UNKNOWN if text is None else text


def _path(value: str, packages: Sequence[Package]) -> str | None:
    """Return a value with the folder of a package for its share folder."""
    if SHARE not in value:
        return value
    name, _, below = value.removeprefix(SHARE).partition("/")
    folder = next((p.folder for p in packages if p.name == name), None)
    return None if folder is None else str(folder / below)
