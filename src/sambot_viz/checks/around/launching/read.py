"""Read a launch file, whatever its form."""

from __future__ import annotations

from sambot_viz.checks.around.files.parameters import YamlFile, read_yaml
from sambot_viz.checks.around.launching.actions import Action
from sambot_viz.checks.around.launching.python_calls import CALLS
from sambot_viz.checks.around.launching.python_reader import PythonReader
from sambot_viz.checks.launch_files import parse_python
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml


def read_actions(
    text: str, path: str, shown: str, read: YamlFile | None
) -> tuple[Action, ...] | None:
    """Return the actions of a launch file; None for an unreadable one.

    Args:
        text: the file.
        path: relative to the package.
        shown: the path as the user would write it.
        read: the YAML file, where another rule has read it.
    """
    if path.endswith(".py"):
        tree = parse_python(text)
        return None if tree is None else PythonReader(tree, shown, CALLS).read()
    root = read_root(text, path, shown, read)
    if root is None:
        return None
    # Import late, as below: most launch files are in Python.
    from sambot_viz.checks.around.launching.frontend_reader import read_frontend

    return read_frontend(root)


def read_root(
    text: str, path: str, shown: str, read: YamlFile | None = None
) -> Element | None:
    """Return the <launch> of a file in XML or YAML; None for one that is neither.

    Args:
        text: as for `read_actions`.
        path: as for `read_actions`.
        shown: as for `read_actions`.
        read: as for `read_actions`.
    """
    if path.endswith((".yaml", ".yml")):
        from sambot_viz.checks.around.launching.frontend_reader import element_of

        file = read or read_yaml(text, path, shown)
        return None if file is None else element_of(file)
    try:
        return parse_xml(text, shown)
    except XmlFault:
        return None
