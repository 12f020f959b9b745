"""Reads a launch file, whatever its form."""

from __future__ import annotations

import ast

from sambot_viz.checks.around.files.parameters import YamlFile, read_yaml
from sambot_viz.checks.around.launching.actions import Action
from sambot_viz.checks.around.launching.frontend_reader import (
    element_of,
    read_frontend,
)
from sambot_viz.checks.around.launching.python_calls import read_python
from sambot_viz.checks.launch_files import parse_python
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import parse_xml


def read_actions(
    text: str, path: str, shown: str, read: ast.Module | YamlFile | None
) -> tuple[Action, ...] | None:
    """Return what a launch file does; None for one that is not readable.

    Args:
        text: the file.
        path: relative to the package.
        shown: the path as the user would write it.
        read: the file, where it was read for other reasons.
    """
    if path.endswith(".py"):
        tree = read if isinstance(read, ast.Module) else parse_python(text)
        return None if tree is None else read_python(tree, shown)
    if path.endswith((".yaml", ".yml")):
        file = read if isinstance(read, YamlFile) else read_yaml(text, path, shown)
        return None if file is None else read_frontend(element_of(file))
    try:
        return read_frontend(parse_xml(text, shown))
    except XmlFault:
        return None
