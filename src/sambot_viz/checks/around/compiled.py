"""Report Python files of a package that Python reads and cannot compile."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import compile_error
from sambot_viz.edits import write_between
from sambot_viz.errors import Fix, Place, Problem


def unusable_python(around: Surroundings) -> Iterator[Problem]:
    """Report launch files, and a setup.py, that Python reads but cannot compile."""
    for package in around.packages:
        files = [(launch.path, launch.tree) for launch in package.launches]
        files += [("setup.py", package.setup.tree)] if package.setup else []
        for path, tree in files:
            error = compile_error(tree, path)
            if error is None:
                continue
            line = error.lineno or 1
            place = Place(package.shown(path), line, error.offset or 1)
            is_setup = path == "setup.py"
            stops = "colcon build" if is_setup else "ros2 launch"
            yield Problem.at(
                place,
                "error",
                "python-syntax",
                f"this file is not Python: {error.msg}; {stops} stops with it",
                _indented(tree, place),
            )


def _indented(tree: ast.Module, place: Place) -> Fix:
    """Return the fix for a statement that left the function before it."""
    hint, before = Fix("correct this line"), None
    for node in tree.body:
        is_here = node.lineno == place.line and isinstance(node, ast.Return)
        if is_here and isinstance(before, ast.FunctionDef):
            blanks = before.body[0].col_offset
            at = Place(place.file, place.line, 1)
            said = f"write {blanks} blanks before it"
            return write_between(at, at, " " * blanks, said)
        before = node
    return hint
