"""Find the launch arguments that launch files of any form declare, use and give."""

from __future__ import annotations

import ast
import posixpath
import re
import sys
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.errors import Place
from sambot_viz.robot.xml.element import Element

_SETTING = ("SetLaunchConfiguration", "OpaqueFunction", "GroupAction")
_VARIABLE = re.compile(r"\$\(var\s+([\w.-]+)\s*\)")
_DECLARE_NONE = sys.stdlib_module_names | {
    *("ament_index_python", "launch", "launch_ros", "launch_testing", "launch_xml"),
    *("launch_yaml", "nav2_common", "ros_gz_bridge", "ros_gz_sim", "xacro", "yaml"),
}
"""Modules whose functions declare no launch arguments by themselves."""


class ArgumentsOfFile(NamedTuple):
    """The launch arguments of a file.

    Attributes:
        file: the launch file, as its Python or as the root of its XML or YAML.
        declared: name → where.
        used: name and place of each use without a default value.
        made_from: the name of a variable → the names in its own value.
        given: the names of those of the included files.
        written: the syntax of a use, with {} for the name.
        certain: no other action sets one.
        includes: it includes other files.
    """

    file: LaunchFile | Element
    declared: Mapping[str, Place]
    used: Sequence[tuple[str, Place]]
    made_from: Mapping[str, Sequence[str]]
    given: frozenset[str]
    written: str
    certain: bool
    includes: bool

    @property
    def name(self) -> str:
        """The name of the file."""
        file = self.file
        return posixpath.basename(
            file.path if isinstance(file, LaunchFile) else file.place.file
        )


def arguments_of_files(around: Surroundings) -> list[ArgumentsOfFile]:
    """Return the launch arguments of each launch file."""
    files = [_of_python(launch) for launch in around.launches]
    files += [_of_frontend(root) for each in around.packages for root in each.frontends]
    return files


def declared_in(package: Package) -> Mapping[str, Mapping[str, Place]]:
    """Return the launch files of a package, with the arguments that each declares.

    Without those that its included files declare.
    """
    files = {launch.shown: _declared(launch) for launch in package.launches}
    return files | {
        root.place.file: _of_frontend(root).declared for root in package.frontends
    }


def _declared(launch: LaunchFile) -> dict[str, Place]:
    return {
        launch.text(call, "name", 0) or "": call.place
        for call in launch.called("DeclareLaunchArgument")
    }


def _of_python(launch: LaunchFile) -> ArgumentsOfFile:
    declared = _declared(launch)
    used = [
        (launch.text(call, "variable_name", 0) or "", call.place)
        for call in launch.in_use
        if call.name == "LaunchConfiguration" and call.given("default", 1) is None
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
    return ArgumentsOfFile(
        launch,
        declared,
        used,
        {},
        given,
        "LaunchConfiguration('{}')",
        certain,
        bool(includes),
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


def _of_frontend(root: Element) -> ArgumentsOfFile:
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
    return ArgumentsOfFile(
        root, declared, used, made_from, given, "$(var {})", certain, includes
    )
