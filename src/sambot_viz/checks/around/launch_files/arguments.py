"""Report launch arguments that a launch file of any form uses and nothing declares."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.xml.element import Element

_SETTING = ("SetLaunchConfiguration", "OpaqueFunction", "GroupAction")
_VARIABLE = re.compile(r"\$\(var\s+([\w.-]+)\s*\)")
_LIKENESS = 0.65
_DECLARE_NONE = sys.stdlib_module_names | {
    *("ament_index_python", "launch", "launch_ros", "launch_testing", "launch_xml"),
    *("launch_yaml", "nav2_common", "ros_gz_bridge", "ros_gz_sim", "xacro", "yaml"),
}
"""Modules whose functions declare no launch arguments by themselves."""


class _File(NamedTuple):
    """The launch arguments of a file.

    Attributes:
        declared: name → where.
        used: name and place of each use without a default value.
        made_from: the name of a variable → the names in its own value.
        given: the names of those of the included files.
        written: the syntax of a use, with {} for the name.
        certain: no other action sets one.
        includes: it includes other files.
    """

    declared: Mapping[str, Place]
    used: Sequence[tuple[str, Place]]
    made_from: Mapping[str, Sequence[str]]
    given: frozenset[str]
    written: str
    certain: bool
    includes: bool


def undeclared_arguments(around: Surroundings) -> Iterator[Problem]:
    """Report arguments whose use and declaration have different names."""
    files = [_of_python(launch) for launch in around.launches]
    files += [_of_frontend(root) for each in around.packages for root in each.frontends]
    given = {name for file in files for name in file.given}
    every = given.union(*(file.declared for file in files))
    for file in files:
        # The arguments of an included file exist after the include.
        known = every if file.includes else given.union(file.declared)
        for name, place in file.used if file.certain else ():
            if name and name not in known:
                yield _undeclared(name, place, file)


def declared_in(package: Package) -> Mapping[str, Mapping[str, Place]]:
    """Return the launch files of a package, with the arguments that each declares.

    Without those that its included files declare.
    """
    files = {launch.shown: _declared(launch) for launch in package.launches}
    return files | {
        root.place.file: _of_frontend(root).declared for root in package.frontends
    }


def _undeclared(name: str, place: Place, file: _File) -> Problem:
    made = {own for own, parts in file.made_from.items() if name in parts}
    near = nearest(name, [own for own in file.declared if own not in made], _LIKENESS)
    cause = f"the launch argument {name} is not declared"
    if near is None:
        # An including file may set it; a file that declares others declares all of its
        # own.
        whole = file.declared and not file.includes
        return Problem.at(
            place,
            "warning" if whole else "info",
            "launch-argument-unknown",
            f"{cause}: ros2 launch stops with it, unless it is given",
            f"declare {name}",
        )
    instead = f"write {file.written.format(near)}"
    return Problem.at(
        place,
        "error",
        "launch-argument-unknown",
        f"{cause}; {near} is ({where(file.declared[near], place)}): ros2 launch stops "
        "with it",
        write(place, name, near, hint=instead)
        if is_misspelt(name, near) or near.endswith(f"_{name}")
        else f"declare {name}, or {instead}",
    )


def _declared(launch: LaunchFile) -> dict[str, Place]:
    return {
        launch.text(call, "name", 0) or "": call.place
        for call in launch.called("DeclareLaunchArgument")
    }


def _of_python(launch: LaunchFile) -> _File:
    declared = _declared(launch)
    used = [
        (launch.text(call, "variable_name", 0) or "", call.place)
        for call in launch.called("LaunchConfiguration")
        if call.given("default", 1) is None
    ]
    includes = list(launch.called("IncludeLaunchDescription"))
    tables = [call.given("launch_arguments") for call in includes]
    texts = [node for table in tables if table is not None for node in ast.walk(table)]
    given = frozenset(
        node.value
        for node in texts
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ).union(declared if includes else ())
    certain = (
        "" not in declared
        and not any(launch.called(*_SETTING))
        and not _calls_others(launch)
    )
    return _File(
        declared, used, {}, given, "LaunchConfiguration('{}')", certain, bool(includes)
    )


def _calls_others(launch: LaunchFile) -> bool:
    """Return whether a file calls what another module defines: maybe a declaration."""
    others = {
        each.name
        for each in launch.imports
        if each.module.partition(".")[0] not in _DECLARE_NONE
    }
    return any(
        isinstance(part, ast.Name) and part.id in others
        for node in (ast.walk(launch.tree) if others else ())
        if isinstance(node, ast.Call)
        for part in ast.walk(node.func)
    )


def _of_frontend(root: Element) -> _File:
    elements = list(root.iter())
    named = {
        element.get("name") or "": element
        for element in elements
        if element.tag in ("arg", "let")
    }
    declared = {
        name: element.place
        for name, element in named.items()
        if element.parent is None or element.parent.tag != "include"
    }
    used = [
        (name, element.place)
        for element in elements
        for value in element.attributes.values()
        for name in _VARIABLE.findall(value)
    ]
    includes = any(element.tag == "include" for element in elements)
    given = frozenset(named if includes else ())
    certain = not any("$" in name for name in declared)
    made_from = {
        name: _VARIABLE.findall(" ".join(element.attributes.values()))
        for name, element in named.items()
        if element.tag == "let"
    }
    return _File(declared, used, made_from, given, "$(var {})", certain, includes)
