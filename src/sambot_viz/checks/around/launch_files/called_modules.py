"""Report calls of a Python module in place of the function in it."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.launch_files.code import python_files, stopped
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Problem


def called_modules(around: Surroundings) -> Iterator[Problem]:
    """Report a call of a module in place of the function in it: glob( … )."""
    for file in python_files(around):
        imports = [n for n in file.tree.body if isinstance(n, ast.Import)]
        whole = {a.name: n for n in imports for a in n.names if a.asname is None}
        for node in ast.walk(file.tree):
            called = node.func if isinstance(node, ast.Call) else None
            name = called.id if isinstance(called, ast.Name) else ""
            step = whole.get(name)
            if called is None or step is None or name in _bound_otherwise(file.tree):
                continue
            code, stops = stopped(file)
            right = f"from {name} import {name}"
            alone = len(step.names) == 1 and not _has_members(name, file.tree)
            yield Problem.at(
                file.place(called),
                "error",
                code,
                f"{name} is a module here (line {step.lineno}), and a module cannot be "
                f"called: {stops} stops with it",
                rewritten(step, file.shown, right)
                if alone
                else rewritten(called, file.shown, f"{name}.{name}"),
            )
            if alone:
                break


def _bound_otherwise(tree: ast.Module) -> set[str]:
    """Return the names that get a value, except those of whole modules."""
    steps = [n for n in ast.walk(tree) if not isinstance(n, ast.Import)]
    return {n.id for n in steps if isinstance(n, ast.Name) and not _is_read(n)} | {
        alias.asname or alias.name
        for n in steps
        if isinstance(n, ast.ImportFrom)
        for alias in n.names
    }


def _is_read(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Load)


def _has_members(name: str, tree: ast.Module) -> bool:
    """Return whether a file uses a member of a module by its full name."""
    return any(
        isinstance(n, ast.Attribute)
        and isinstance(n.value, ast.Name)
        and n.value.id == name
        for n in ast.walk(tree)
    )
