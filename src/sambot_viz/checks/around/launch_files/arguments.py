"""Report launch arguments that a launch file of any form uses and nothing declares."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from sambot_viz.checks.around.launch_files.declarations import (
    ArgumentsOfFile,
    arguments_of_files,
)
from sambot_viz.checks.around.launch_files.included import included_file
from sambot_viz.checks.around.launch_files.new_declaration import declaration
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest

_LIKENESS = 0.65


def undeclared_arguments(around: Surroundings) -> Iterator[Problem]:
    """Report arguments whose use and declaration have different names."""
    files = arguments_of_files(around)
    parents = {file.name for file in files if file.includes}
    every = {name for file in files for name in (*file.given, *file.declared)}
    included = [_included(file, around, parents) for file in files]
    for file, inner in zip(files, included, strict=True):
        outer = (
            other.given
            for other, names in zip(files, included, strict=True)
            if names is None or file.name in names
        )
        given = set(file.given).union(*outer)
        # The arguments of an included file exist after the include.
        known = every if inner is None else given.union(file.declared, *inner.values())
        used: dict[str, list[Place]] = {}
        for name, place in file.used if file.certain else ():
            if name and name not in known:
                used.setdefault(name, []).append(place)
        for name, places in used.items():
            is_first = any((inner or {}).values()) and _is_first(file, around)
            yield from _undeclared(name, places, file, around, is_first)


def _undeclared(
    name: str,
    places: Sequence[Place],
    file: ArgumentsOfFile,
    around: Surroundings,
    is_first: bool,
) -> Iterator[Problem]:
    made = {own for own, parts in file.made_from.items() if name in parts}
    near = nearest(name, [own for own in file.declared if own not in made], _LIKENESS)
    cause = f"the launch argument {name} is not declared"
    if near is None:
        lines = [str(place.line) for place in places[1:]]
        word = "line" if len(lines) == 1 else "lines"
        also = f" ({word} {listed(lines, 3)} too)" if lines else ""
        # An including file may set it; a file that declares others declares all of its
        # own.
        whole = file.declared and not file.includes
        yield Problem.at(
            places[0],
            "warning" if whole or is_first else "info",
            "launch-argument-unknown",
            f"{cause}{also}: ros2 launch stops with it, unless it is given",
            declaration(file, name, around),
        )
        return
    instead = f"write {file.written.format(near)}"
    for place in places:
        yield Problem.at(
            place,
            "error",
            "launch-argument-unknown",
            f"{cause}; {near} is ({where(file.declared[near], place)}): ros2 launch "
            "stops with it",
            write(place, name, near, hint=instead)
            if is_misspelt(name, near) or near.endswith(f"_{name}")
            else f"declare {name}, or {instead}",
        )


def _included(
    file: ArgumentsOfFile, around: Surroundings, parents: Collection[str]
) -> Mapping[str, Collection[str]] | None:
    """Return the included files with their arguments; None where one is unknown.

    Args:
        file: the launch file.
        around: the packages.
        parents: the names of launch files that include others, whose arguments are
            those of several files.
    """
    if not isinstance(file.file, LaunchFile):
        return None if file.includes else {}
    found: dict[str, set[str]] = {}
    for call in file.file.called("IncludeLaunchDescription"):
        inner = included_file(around, file.file, call)
        if inner is None or inner.name in parents:
            return None
        found.setdefault(inner.name, set()).update(inner.arguments)
    return found


def _is_first(file: ArgumentsOfFile, around: Surroundings) -> bool:
    """Return whether no other launch file of the workspace includes a file."""
    workspace = around.files.workspace
    packages = {*around.packages, *(workspace.given if workspace else ())}
    said = {
        text
        for package in packages
        for launch in package.launches
        if launch is not file.file
        for text in launch.strings
    }
    said |= {
        text
        for package in packages
        for root in package.frontends
        for element in root.iter()
        for text in element.attributes.values()
    }
    return not any(text.endswith(file.name) for text in said)
