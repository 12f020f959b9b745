"""Report names that launch files import from modules without them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache

from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.errors import Problem, nearest

_TABLE = "launch_modules"
_LIKENESS = 0.85
_PACKAGES = ("launch", "launch_ros")


@cache
def modules() -> dict[str, str]:
    """Return the first module of the vocabulary that has a name, by the name."""
    rows = list(vocabulary(_TABLE).items())[::-1]
    return {name: module for module, names in rows for name in names}


def wrong_imports(around: Surroundings) -> Iterator[Problem]:
    """Report imports from a module that does not have the name, or does not exist."""
    for launch in around.launches:
        tried = {
            id(step)
            for node in ast.walk(launch.tree)
            if isinstance(node, ast.Try)
            for step in ast.walk(node)
        }
        for step in dict.fromkeys(each.step for each in launch.imports):
            if isinstance(step, ast.ImportFrom) and id(step) not in tried:
                yield from _wrong(step, launch)


def _wrong(node: ast.ImportFrom, launch: LaunchFile) -> Iterator[Problem]:
    table, module = vocabulary(_TABLE), node.module or ""
    names = [alias.name for alias in node.names]
    meant = {name: _meant(module, name) for name in names}
    wrong = {name: right for name, right in meant.items() if right is not None}
    if not wrong or node.level:
        return
    groups: dict[str, list[str]] = {}
    for alias in node.names:
        target, name = wrong.get(alias.name, (module, alias.name))
        kept = name != alias.name and launch.uses(alias.name)
        renamed = alias.asname or (alias.name if kept else None)
        written = ast.unparse(ast.alias(name, renamed))
        groups.setdefault(target, []).append(written)
    lines = [f"from {each} import {', '.join(found)}" for each, found in groups.items()]
    right = f"\n{' ' * node.col_offset}".join(lines)
    cause = (
        f"there is no module {module}"
        if module not in table
        else f"{module} has no {listed(wrong)}"
    )
    said = "; ".join(line for line in lines if not line.startswith(f"from {module} "))
    yield Problem.at(
        launch.place(node),
        "error",
        "launch-code",
        f"{cause}: ros2 launch stops with it",
        rewritten(node, launch.shown, right, f"write {said or right}"),
    )


def _meant(module: str, name: str) -> tuple[str, str] | None:
    """Return the right module and name; None for a right import."""
    table = vocabulary(_TABLE)
    if module in table:
        if name in table[module] or f"{module}.{name}" in table:
            return None
        if name in modules():
            return modules()[name], name
        near = nearest(name, table[module], _LIKENESS)
        return None if near is None else (module, near)
    if module.partition(".")[0] in _PACKAGES:
        near = nearest(module, table, _LIKENESS)
        if near is not None and name in table[near]:
            return near, name
    return None
