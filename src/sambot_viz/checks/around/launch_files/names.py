"""The names that have a value in some Python, and the import of others."""

from __future__ import annotations

import ast
import builtins

from sambot_viz.checks.around.launch_files.imports import modules
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.launch_files import imported_by

PREDEFINED = frozenset(dir(builtins)) | {"__file__", "__name__", "__doc__"}


def bound_names(tree: ast.Module) -> set[str]:
    """Return all names that get a value anywhere in a file; "*" for possible others."""
    return {*PREDEFINED, *names_in(tree)}


def names_in(tree: ast.AST) -> set[str]:
    """Return the names that get a value in some Python; "*" for possible others."""
    found: set[str] = set()
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name, ctx=ast.Store() | ast.Del()):
                found.add(name)
            case ast.Import() | ast.ImportFrom():
                found.update(each.name for each in imported_by(node))
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                found.add(node.name)
            case ast.arg(arg=name) | ast.ExceptHandler(name=str(name)):
                found.add(name)
            case ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
                found.add(name)
            case ast.MatchMapping(rest=str(name)):
                found.add(name)
            case ast.Call(func=ast.Name(id="exec" | "globals" | "vars" | "locals")):
                found.add("*")
            case _ if type(node).__name__ in ("TypeVar", "TypeAlias"):
                found.add("*")
            case _:
                pass
    return found


def with_import(hint: str, name: str, launch: LaunchFile) -> str:
    """Return a hint to write a name of launch, with its import where that is missing.

    Args:
        hint: what to write.
        name: a name of the vocabulary of launch; see `modules`.
        launch: the file.
    """
    if name in bound_names(launch.tree):
        return hint
    return f"{hint}, and import {name} from {modules()[name]}"
