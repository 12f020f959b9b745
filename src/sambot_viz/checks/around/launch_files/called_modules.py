"""Report a Python module in place of its member of the same name, or the reverse."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

from sambot_viz.checks.around.launch_files.code import python_files, stopped
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Problem

if TYPE_CHECKING:
    from sambot_viz.checks.around.launching.launch_file import LaunchFile
    from sambot_viz.checks.around.setup_file import SetupFile


def called_modules(around: Surroundings) -> Iterator[Problem]:
    """Report a call of a module in place of the function in it: glob( … )."""
    for file in python_files(around):
        bound = _bound_otherwise(file)
        whole = {
            each.name: each.step
            for each in file.imports
            if each.member is None and each.name == each.module
            if each.name not in bound and each.step in file.tree.body
        }
        for node in ast.walk(file.tree) if whole else ():
            called = node.func if isinstance(node, ast.Call) else None
            name = called.id if isinstance(called, ast.Name) else ""
            step = whole.get(name)
            if called is None or step is None:
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


def members_as_modules(around: Surroundings) -> Iterator[Problem]:
    """Report a member of what was imported from the module: glob.glob( … )."""
    for file in python_files(around):
        imported = [
            each
            for each in file.imports
            if each.member == each.module == each.name and each.step in file.tree.body
            if each.module in sys.stdlib_module_names
        ]
        for each in imported:
            name, code, stops = each.name, *stopped(file)
            uses = [
                node
                for node in ast.walk(file.tree)
                if isinstance(node, ast.Attribute) and node.attr == name
                if isinstance(node.value, ast.Name) and node.value.id == name
            ]
            others = len(uses) != _uses(name, file.tree)
            for use in uses[: None if others else 1]:
                yield Problem.at(
                    file.place(use),
                    "error",
                    code,
                    f"{name} is not the module here but its {name} (line "
                    f"{each.step.lineno}), which has no {name}: {stops} stops with it",
                    rewritten(use, file.shown, name)
                    if others or len(each.step.names) > 1
                    else rewritten(each.step, file.shown, f"import {name}"),
                )


def _uses(name: str, tree: ast.Module) -> int:
    return sum(
        isinstance(node, ast.Name) and node.id == name for node in ast.walk(tree)
    )


def _bound_otherwise(file: LaunchFile | SetupFile) -> set[str]:
    """Return the names that get a value, except those of whole modules."""
    names = [node for node in ast.walk(file.tree) if isinstance(node, ast.Name)]
    given = {name.id for name in names if not isinstance(name.ctx, ast.Load)}
    return given | {each.name for each in file.imports if each.member is not None}


def _has_members(name: str, tree: ast.Module) -> bool:
    """Return whether a file uses a member of a module by its full name."""
    return any(
        isinstance(n, ast.Attribute)
        and isinstance(n.value, ast.Name)
        and n.value.id == name
        for n in ast.walk(tree)
    )
