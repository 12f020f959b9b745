"""Find the arguments that launch files give to xacro for a model."""

from __future__ import annotations

import ast
import re
import shlex
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launching.actions import LaunchArgument
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import PythonValue, Table
from sambot_viz.checks.around.launching.texts import UNKNOWN
from sambot_viz.checks.around.running.assemble import system_of
from sambot_viz.checks.around.running.system import Starts
from sambot_viz.checks.around.workspace import Package

_MOST = 3
"""Maximum number of variants of a model besides the first."""
_READS = frozenset({"process_file", "process_doc"})
"""Functions of xacro that take arguments."""
_DECLARED = re.compile(r"<xacro:arg\s[^>]*>")
_ROOT = re.compile(r"<robot\s[^>]*>")
_USED = re.compile(r"\$\(arg\s+([\w.-]+)\s*\)")
_ATTRIBUTE = re.compile(r"""\b(name|default)\s*=\s*(?:"([^"]*)"|'([^']*)')""")


def launched_arguments(
    model: Path, packages: Sequence[Package]
) -> tuple[dict[str, str], ...]:
    """Return the xacro arguments from launch files that open a model.

    Only known values that differ from the default, or that the root tag uses: xacro
    evaluates it before any default.

    Returns:
        First the values common to all of them, with which the check loads the model;
        then the values of single ones, each once.
    """
    # Most launch files give nothing: the check need not follow them.
    if not any(":=" in text for p in packages for text in _said(p)):
        return ({},)
    files = [(each, path) for each in packages for path in each.launch_paths]
    named = {package.name: package for package in packages}
    running = system_of(files, packages, named.get)
    given: list[dict[str, str]] = []
    starts: set[Starts] = set()
    for node in running.started:
        for command in (parameter.robot for parameter in node.parameters):
            if any(word.endswith(f"/{model.name}") for word in command.split()):
                given.append(dict(_arguments(command)))
                starts.add(node.starts)
    defaults = _defaults(packages) if given else {}
    of_root = _used_in_root(model, packages if given else ())
    kept = [dict(_values(each, packages)) for each in given]
    changed = [
        {n: v for n, v in each.items() if n in of_root or defaults.get(n, v) != v}
        for each in kept
    ]
    first = dict(changed[0]) if "yes" in starts else {}
    for each in changed:
        first = {n: v for n, v in first.items() if each.get(n) == v}
    return tuple([first, *(each for each in changed if each != first)][: _MOST + 1])


def _values(
    given: Mapping[str, str], packages: Sequence[Package]
) -> Iterator[tuple[str, str]]:
    """Yield the arguments with a known value."""
    for name, value in given.items():
        path = None if UNKNOWN in value else _path(value, packages)
        if path is not None:
            yield name, path


def _used_in_root(model: Path, packages: Sequence[Package]) -> frozenset[str]:
    for package in packages:
        if model.is_relative_to(package.folder):
            path = model.relative_to(package.folder).as_posix()
            root = _ROOT.search(package.text(path) or "")
            return frozenset[str](_USED.findall(root[0]) if root else ())
    return frozenset[str]()


def _said(package: Package) -> Iterator[str]:
    for launch in package.launches:
        yield from launch.strings
    for root in package.frontends:
        yield from (v for e in root.iter() for v in e.attributes.values())


def _defaults(packages: Sequence[Package]) -> dict[str, str]:
    """Return the defaults of all declared arguments of models."""
    found: dict[str, str] = {}
    for package in packages:
        for path in package.ending(".xacro", ".urdf"):
            for element in _DECLARED.findall(package.text(path) or ""):
                said = {n: one or two for n, one, two in _ATTRIBUTE.findall(element)}
                if "default" in said:
                    found.setdefault(said.get("name", ""), said["default"])
    return found


def xacro_arguments(
    model: Path, packages: Sequence[Package]
) -> Iterator[dict[str, str]]:
    """Yield the arguments that launch files may give to a model, for one without.

    They are those of `given_arguments` and all arguments of the launch files. A second
    result has 0, a number and a text for values that only a run reveals.
    """
    found, unknown = _of_model(model, packages)
    launches = [file for package in packages for file in package.launches]
    defaults = {k: v for file in launches for k, v in file.values.defaults.items()}
    known = {**defaults, **found}
    if known:
        yield known
    if unknown.keys() - known.keys():
        yield {**unknown, **known}


def given_arguments(
    model: Path, packages: Sequence[Package]
) -> Iterator[dict[str, str]]:
    """Yield the arguments that launch files give to a model; the first value counts.

    Launch arguments have their default values, or the first of their choices, and a
    variable has the first of its texts.
    """
    found, _ = _of_model(model, packages)
    if found:
        yield found


def _of_model(
    model: Path, packages: Sequence[Package]
) -> tuple[dict[str, str], dict[str, str]]:
    """Return the given arguments with a known value, and those without."""
    found: dict[str, str] = {}
    unknown: dict[str, str] = {}
    launches = [file for package in packages for file in package.launches]
    opening = (f for f in launches if any(model.name in text for text in f.strings))
    for launch in opening:
        for name, value in _given(launch):
            path = None if UNKNOWN in value else _path(value, packages)
            if path is not None:
                found.setdefault(name, path)
            else:
                unknown.setdefault(name, "0")
    return found, unknown


def _given(launch: LaunchFile) -> Iterator[tuple[str, str]]:
    choices = dict(_choices(launch))
    for call in launch.calls:
        if call.name == "Command" and call.node.args:
            words = call.listing("command", 0).items
            command = "".join(_text(launch, word, choices) for word, _ in words)
            yield from _arguments(command)
        elif call.name in _READS:
            given = call.value("mappings")
            for pair in given.pairs if isinstance(given, Table) else ():
                name, text = launch.values.said(pair.key), ""
                if isinstance(pair.node, ast.Name):
                    text = _first_text(launch, pair.node.id)
                if name:
                    yield name, text or _text(launch, pair.value, choices)


def _first_text(launch: LaunchFile, variable: str) -> str:
    """Return the first of several texts that a variable gets; empty without one."""
    for node in ast.walk(launch.tree):
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name)], value=ast.Constant(value=str(text))
            ) if name == variable:
                return text
            case _:
                pass
    return ""


def _arguments(command: str) -> Iterator[tuple[str, str]]:
    """Yield the NAME:=VALUE of a command line, as ros2 launch splits it."""
    try:
        words = shlex.split(command)
    except ValueError:
        return
    for word in words:
        name, mark, value = word.partition(":=")
        if mark and UNKNOWN not in name:
            yield name, value


def _choices(launch: LaunchFile) -> Iterator[tuple[str, str]]:
    """Yield the launch arguments with a list of values, and the first of them."""
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
    return UNKNOWN if text is None else text


def _path(value: str, packages: Sequence[Package]) -> str | None:
    """Return a value with the folder of a package for its share folder."""
    if SHARE not in value:
        return value
    name, _, below = value.removeprefix(SHARE).partition("/")
    folder = next((p.folder for p in packages if p.name == name), None)
    return None if folder is None else str(folder / below)
