"""Write the declaration that a launch argument lacks."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.gazebo.starts import starts
from sambot_viz.checks.around.launch_files.declarations import ArgumentsOfFile
from sambot_viz.checks.around.launch_files.names import with_import
from sambot_viz.checks.around.launch_files.order import listed_actions
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import put_into, write_between
from sambot_viz.errors import Fix
from sambot_viz.robot.xml.element import Element

_DECLARES = "DeclareLaunchArgument"
_TIME = "use_sim_time"


def declaration(file: ArgumentsOfFile, name: str, around: Surroundings) -> Fix:
    """Return the fix that declares a launch argument.

    Its default is the one of the other launch files; without one there is no edit.
    Beside Gazebo the nodes use its time.
    """
    known = {*_defaults(name, around)}
    if name == _TIME and isinstance(file.file, LaunchFile) and starts(file.file):
        known = {value for value in known if flag(value)} or {"true"}
    default = known.pop() if len(known) == 1 else None
    plain = default is None or not set(default) & set("'\"<&$\\\n")
    if default is None or not plain:
        return Fix(f"declare {name}")
    if isinstance(file.file, Element):
        written = f'<arg name="{name}" default="{default}"/>'
        is_xml = not file.file.place.file.endswith((".yaml", ".yml"))
        edits = put_into(file.file.place, written) if is_xml else ()
        return Fix(f"add {written} to <launch>" if is_xml else f"declare {name}", edits)
    return _in_python(file.file, f"{_DECLARES}('{name}', default_value='{default}')")


def _defaults(name: str, around: Surroundings) -> Iterator[str]:
    """Yield the defaults that other launch files give to an argument."""
    for launch in around.launches:
        for call in launch.called(_DECLARES):
            given = call.given("default_value", 1)
            value = given.value if isinstance(given, ast.Constant) else None
            if launch.text(call, "name", 0) == name and isinstance(value, str):
                yield value


def _in_python(launch: LaunchFile, written: str) -> Fix:
    """Return the fix that adds an action before all others of the description."""
    hint = f"add {written} to the LaunchDescription"
    needed = with_import(hint, _DECLARES, launch)
    first = next(iter(listed_actions(launch)), None)
    if first is None or needed != hint:
        return Fix(needed)
    place = launch.place(first.written)
    behind = ",\n" + " " * first.written.col_offset
    if isinstance(first.written, ast.stmt):
        call = ast.unparse(first.written).partition("(")[0]
        written, behind = f"{call}({written})", behind.removeprefix(",")
    return write_between(place, place, written + behind, hint)
