"""Check included launch files: their paths and their arguments."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launch_files.declarations import declared_in
from sambot_viz.checks.around.launch_files.included import IncludedFile, included_file
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call, Table
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import meant_word
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Problem

_LIKENESS, _LIKE_FILE = 0.8, 0.85
_FOLDER = "launch/"


def includes_without_argument(around: Surroundings) -> Iterator[Problem]:
    """Report arguments under another name than the included file declares them."""
    every = {
        name
        for package in around.packages
        for file in declared_in(package).values()
        for name in file
    }
    for launch in around.launches:
        for call in launch.called("IncludeLaunchDescription"):
            table = call.value("launch_arguments")
            file = included_file(around, launch, call)
            if file is not None and isinstance(table, Table):
                yield from _undeclared(launch, table, file, every)


def _undeclared(
    launch: LaunchFile, table: Table, file: IncludedFile, every: set[str]
) -> Iterator[Problem]:
    given = [pair.key for pair in table.pairs]
    for pair in table.pairs:
        name = pair.key if isinstance(pair.key, str) else ""
        near = _meant(name, file) if name not in every else None
        if near is None or near in given:
            continue
        place = launch.place(pair.key_node)
        yield Problem.at(
            place,
            "warning",
            "launch-argument-unknown",
            f"{file.name} declares no argument {name}, but {near}: what is given here "
            "has no effect",
            write(place, name, near),
        )


def _meant(name: str, file: IncludedFile) -> str | None:
    """Return the argument that is alike, or that has all words of the name."""
    known = [word for word in file.arguments if "=" not in word]
    words = set(name.split("_"))
    alike = [k for k in known if words < set(k.split("_")) or words > set(k.split("_"))]
    near = meant_word(file.arguments, name, _LIKENESS)
    return near or (alike[0] if len(alike) == 1 and name not in known else None)


def misplaced_includes(around: Surroundings) -> Iterator[Problem]:
    """Report paths at which a well-known package does not have its launch file."""
    files: dict[str, list[str]] = {}
    for whole in vocabulary("launch_files"):
        package, _, name = whole.partition("/")
        files.setdefault(package, []).append(name)
    for launch in around.launches:
        for call in launch.called("IncludeLaunchDescription"):
            path = launch.text(call, "launch_description_source", 0) or ""
            package, _, below = path.removeprefix(SHARE).partition("/")
            known = files.get(package, []) if path.startswith(SHARE) else []
            name = below.rpartition("/")[2]
            right = (
                name if name in known else meant_word(tuple(known), name, _LIKE_FILE)
            )
            if package in around.names or right is None or below == _FOLDER + right:
                continue
            yield _misplaced(launch, call, package, below, right)


def _misplaced(
    launch: LaunchFile, call: Call, package: str, below: str, right: str
) -> Problem:
    """Report one file, if possible at the text that names it."""
    name = below.rpartition("/")[2]
    given = call.given("launch_description_source", 0) or call.node
    texts = [n for n in ast.walk(given) if isinstance(n, ast.Constant)]
    said = next((n for n in texts if str(n.value).endswith(name)), None)
    better = right if below.startswith(_FOLDER) else f"{_FOLDER}{right}"
    folder = below.rpartition("/")[0]
    parts = [n for n in texts if folder and str(n.value).strip("/") == folder]
    if name == right and len(parts) == 1:
        said, name = parts[0], str(parts[0].value)
        better = name.replace(folder, _FOLDER.strip("/"))
    place = launch.place(said or given)
    return Problem.at(
        place,
        "error",
        "launch-file-missing",
        f"the package {package} has no {below}, but {_FOLDER}{right}: ros2 launch "
        "stops with it",
        write(place, name, better),
    )
