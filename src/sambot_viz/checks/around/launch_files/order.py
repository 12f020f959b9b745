"""Report launch arguments that a Python launch file uses before it declares them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.launch_files.included import included_file
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Table
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import source_of, together, write_between
from sambot_viz.errors import Fix, Place, Problem

_DESCRIPTION, _DECLARES = "LaunchDescription", "DeclareLaunchArgument"
_USES = "LaunchConfiguration"
_LATER = frozenset({"OpaqueFunction", "RegisterEventHandler", "TimerAction"})
"""Actions that do what is inside them after the description."""
_INCLUDE = "IncludeLaunchDescription"
_SETS = frozenset({"GroupAction", "OpaqueFunction", "SetLaunchConfiguration"})
"""Actions that may give an argument to those after them."""


class ListedAction(NamedTuple):
    """An action of the description.

    Attributes:
        written: where the description names it, or the statement that adds it.
        action: its expression, where that is known.
    """

    written: ast.expr | ast.stmt
    action: ast.expr


def late_declarations(around: Surroundings) -> Iterator[Problem]:
    """Report declarations behind actions that use their launch argument."""
    for launch in around.launches:
        declared = [launch.text(c, "name", 0) for c in launch.called(_DECLARES)]
        entries = listed_actions(launch)
        for at, entry in enumerate(entries):
            name = _declared(entry, launch)
            if name is None or declared.count(name) != 1:
                continue
            before = entries[:at]
            first = next((e for e in before if name in _used(e.action, launch)), None)
            if first is None:
                continue
            earlier = before[: before.index(first)]
            if not all(_leaves(name, e, launch, around) for e in earlier):
                continue
            yield Problem.at(
                launch.place(entry.written),
                "error",
                "launch-argument-unknown",
                f"the launch argument {name} is declared after its first use "
                f"({where(launch.place(first.written), launch.shown)}): ros2 launch "
                "goes through the actions in their order, and stops there, unless it "
                "is given",
                _moved(entry.written, first.written, launch),
            )


def _leaves(
    name: str, entry: ListedAction, launch: LaunchFile, around: Surroundings
) -> bool:
    """Return whether an action certainly does not set a launch argument."""
    made = entry.action
    if not isinstance(made, ast.Call) or call_name(made.func) in _SETS:
        return False
    if call_name(made.func) != _INCLUDE:
        return True
    call = next(call for call in launch.called(_INCLUDE) if call.node is made)
    file = included_file(around, launch, call)
    table = call.value("launch_arguments")
    given = [pair.key for pair in table.pairs] if isinstance(table, Table) else []
    is_known = isinstance(table, Table) or call.given("launch_arguments") is None
    return file is not None and is_known and name not in (*file.arguments, *given)


def _declared(entry: ListedAction, launch: LaunchFile) -> str | None:
    for call in launch.called(_DECLARES):
        if call.node is entry.action:
            return launch.text(call, "name", 0)
    return None


def listed_actions(launch: LaunchFile) -> list[ListedAction]:
    """Return the actions of the only description, in the order of their execution."""
    descriptions = list(launch.called(_DESCRIPTION))
    if len(descriptions) != 1:
        return []
    found: list[ListedAction] = []
    given = descriptions[0].given("initial_entities", 0)
    for node in given.elts if isinstance(given, ast.List) else ():
        found.append(ListedAction(node, launch.origin(node)))
    added = descriptions[0].place.line
    for function in launch.tree.body:
        for node in function.body if isinstance(function, ast.FunctionDef) else ():
            match node:
                case ast.Expr(
                    value=ast.Call(func=ast.Attribute(attr="add_action"), args=[one])
                ) if node.lineno > added:
                    found.append(ListedAction(node, launch.origin(one)))
                case _:
                    pass
    return found


def _used(action: ast.expr, launch: LaunchFile) -> set[str]:
    """Return the launch arguments without a default that an action needs at once."""
    found: set[str] = set()
    waiting, met = [action], set[int]()
    while waiting:
        node = waiting.pop()
        if id(node) in met:
            continue
        met.add(id(node))
        if isinstance(node, ast.Call):
            name = call_name(node.func)
            if name in _LATER or name == _DECLARES:
                continue
            if name == _USES and len(node.args) + len(node.keywords) == 1:
                text = launch.values.text(
                    [*node.args, *[k.value for k in node.keywords]][0]
                )
                found |= {text} if text else set()
        if isinstance(node, ast.Name):
            inner = launch.origin(node)
            waiting += [] if inner is node else [inner]
        waiting += [n for n in ast.iter_child_nodes(node) if isinstance(n, ast.expr)]
        waiting += [k.value for k in getattr(node, "keywords", ())]
    return found


def _moved(
    late: ast.expr | ast.stmt, first: ast.expr | ast.stmt, launch: LaunchFile
) -> Fix:
    """Return the fix that moves whole lines of a declaration before another action."""
    hint = f"move this declaration before line {first.lineno}"
    source = source_of(launch.shown)
    if source is None:
        return Fix(hint)
    lines = source.text.split("\n")
    end = late.end_lineno or late.lineno
    own = lines[late.lineno - 1 : end]
    before, behind = own[0][: late.col_offset], own[-1][late.end_col_offset or 0 :]
    other = lines[first.lineno - 1][: first.col_offset]
    is_statement = isinstance(late, ast.stmt)
    if before.strip() or other.strip() or behind.strip() not in ("", ","):
        return Fix(hint)
    if not is_statement and behind.strip() == "":
        own[-1] = own[-1].rstrip() + ","
    at, here = Place(launch.shown, first.lineno, 1), Place(launch.shown, late.lineno, 1)
    return together(
        hint,
        write_between(at, at, "\n".join(own) + "\n", hint),
        write_between(here, Place(launch.shown, end + 1, 1), "", hint),
    )
