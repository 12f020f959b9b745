"""Report parts that a launch file loads into a container that it does not start."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.xml.element import Element

_LOADS = {
    "LoadComposableNodes": "target_container",
    "RosGzBridge": "container_name",
    "GzServer": "container_name",
}
"""Action → its argument with the name of a container."""
_OF_GZ = frozenset({"RosGzBridge", "GzServer"})
_MAKES = frozenset({"ComposableNodeContainer", "Node"})
_IN_XML = {
    "load_composable_node": "target",
    "ros_gz_bridge": "container_name",
    "gz_server": "container_name",
}
_PROGRAM = "component_container"
_USUAL = "ros_gz_container"
_LIKENESS = 0.75


class _Container(NamedTuple):
    """The name of a container.

    Attributes:
        name: without the first slash; None for an unknown one.
        place: where it is written.
        is_own: the action starts it.
    """

    name: str | None
    place: Place
    is_own: bool


def unknown_containers(around: Surroundings) -> Iterator[Problem]:
    """Report names of containers that are nearly those of the file's own."""
    files = [(_of_python(launch), _is_alone(launch)) for launch in around.launches]
    for root in (root for package in around.packages for root in package.frontends):
        alone = all(element.tag != "include" for element in root.iter())
        files.append((list(_of_elements(root)), alone))
    every = {c.name for found, _ in files for c in found if c.is_own}
    for found, alone in files:
        made = {c.name: c for c in found if c.is_own}
        names = [name for name in made if name is not None]
        for one in found if None not in every else ():
            if one.is_own or one.name is None or one.name in every:
                continue
            near = nearest(one.name, names, _LIKENESS)
            near = names[0] if near is None and alone and len(names) == 1 else near
            if near is not None:
                yield Problem.at(
                    one.place,
                    "warning",
                    "launch-container-unknown",
                    f"this is to be loaded into the container {one.name}, but the one "
                    f"that starts is {near} ({where(made[near].place, one.place)}): it "
                    "never runs",
                    write(one.place, one.name, near),
                )


def _is_alone(launch: LaunchFile) -> bool:
    return not any(launch.called("IncludeLaunchDescription"))


def _of_python(launch: LaunchFile) -> list[_Container]:
    found: list[_Container] = []
    for call in launch.called(*_MAKES, *_LOADS):
        if call.name not in _MAKES:
            one = _loaded(launch, call)
            found += [one] if one is not None else []
            continue
        program = launch.text(call, "executable") or ""
        if program.startswith(_PROGRAM) or call.name != "Node":
            given = call.given("name")
            name = launch.text(call, "name")
            place = call.place if given is None else launch.place(given)
            found.append(_Container(_bare(name), place, is_own=True))
    return found


def _loaded(launch: LaunchFile, call: Call) -> _Container | None:
    """Return the container of an action that loads parts into one."""
    given = call.given(_LOADS[call.name], 1 if call.name not in _OF_GZ else None)
    own = False
    if call.name in _OF_GZ:
        used, makes = (
            flag(launch.text(call, name) or "") if call.given(name) else False
            for name in ("use_composition", "create_own_container")
        )
        if used is None or makes is None:
            return _Container(None, call.place, is_own=True)
        if not used:
            return None
        own = makes
    elif not isinstance(given, (ast.Constant, ast.Name)):
        # The object of a container, or text from several parts.
        return None
    if given is None:
        return _Container(_USUAL, call.place, is_own=own)
    return _Container(_bare(launch.values.text(given)), launch.place(given), own)


def _of_elements(root: Element) -> Iterator[_Container]:
    for element in root.iter():
        if element.tag == "node_container":
            yield _Container(_bare(element.get("name")), element.place, is_own=True)
        elif element.tag in _IN_XML:
            name = element.get(_IN_XML[element.tag])
            makes = False
            if element.tag != "load_composable_node":
                if flag(element.get("use_composition") or "false") is False:
                    continue
                makes = flag(element.get("create_own_container") or "false")
                name = name or _USUAL
            yield _Container(_bare(name), element.place, is_own=makes is not False)


def _bare(name: str | None) -> str | None:
    """Return a name without the first slash; None with a substitution."""
    return None if not name or "$" in name else name.strip("/")
