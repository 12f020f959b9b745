"""Report missing members in Python launch files, and names read too early."""

from __future__ import annotations

import ast
import os
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from sambot_viz.checks.around.launch_files.names import PREDEFINED, names_in
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import write_between
from sambot_viz.errors import Place, Problem, nearest

_LIKENESS = 0.75
_STOPS = "ros2 launch stops with it"
_OF_SUBSTITUTIONS = ("perform", "describe", "variable_name", "default_value")
_MEMBERS: dict[str, Sequence[str]] = {
    "LaunchConfiguration": _OF_SUBSTITUTIONS,
    "PathJoinSubstitution": _OF_SUBSTITUTIONS,
    "LaunchDescription": ("add_action", "add_entity", "entities", "describe", "visit"),
}
"""Call → the members of its result."""
_OTHER_SCOPES = (
    ast.FunctionDef,
    ast.AsyncFunctionDef,
    ast.ClassDef,
    ast.Lambda,
    ast.ListComp,
    ast.SetComp,
    ast.DictComp,
    ast.GeneratorExp,
)


class _Owner(NamedTuple):
    """A module or value with members.

    Attributes:
        name: its name in a message.
        members: the names of these.
    """

    name: str
    members: Sequence[str]


def misspelt_members(around: Surroundings) -> Iterator[Problem]:
    """Report a misspelt member of a module or a value."""
    for launch in around.launches:
        members = (n for n in ast.walk(launch.tree) if isinstance(n, ast.Attribute))
        for node in members:
            owner = _owner(launch.origin(node.value))
            right = nearest(node.attr, owner.members, _LIKENESS) if owner else None
            if owner is None or right is None or node.attr in owner.members:
                continue
            line, column = node.end_lineno or 1, node.end_col_offset or 0
            begin = Place(launch.shown, line, column + 1 - len(node.attr))
            end = Place(launch.shown, line, column + 1)
            yield Problem.at(
                begin,
                "error",
                "launch-code",
                f"{owner.name} has no {node.attr}, but {right}: {_STOPS}",
                write_between(begin, end, right, f"write {right}"),
            )


def _owner(node: ast.expr) -> _Owner | None:
    match node:
        case ast.Dict():
            return _Owner("a dict", dir(dict))
        case ast.Constant(value=str()):
            return _Owner("a text", dir(str))
        case ast.Name(id="os"):
            return _Owner("os", dir(os))
        case ast.Attribute(value=ast.Name(id="os"), attr="path"):
            return _Owner("os.path", dir(os.path))
        case ast.Call() if call_name(node.func) in _MEMBERS:
            name = call_name(node.func)
            return _Owner(name, _MEMBERS[name])
        case _:
            return None


def names_before_values(around: Surroundings) -> Iterator[Problem]:
    """Report variables that the file reads above the line that sets them."""
    for launch in around.launches:
        bodies = [(launch.tree.body, PREDEFINED)]
        for node in ast.walk(launch.tree):
            if isinstance(node, ast.FunctionDef):
                bodies.append((node.body, frozenset(names_in(node.args))))
        quoted = {id(node) for node in _named(launch)}
        for body, known in bodies:
            for name, line in _too_early(body, known).values():
                yield Problem.at(
                    launch.place(name),
                    "error",
                    "launch-code",
                    f"{name.id} is used here, but gets its first value in line {line}: "
                    f"{_STOPS}",
                    rewritten(name, launch.shown, f"'{name.id}'")
                    if id(name) in quoted
                    else f"write another name here, or move line {line} above this one",
                )


def _named(launch: LaunchFile) -> Iterator[ast.expr | None]:
    """Yield names of arguments, packages and programs, which are mostly texts."""
    for call in launch.called("LaunchConfiguration", "FindPackageShare"):
        yield from call.node.args[:1]
    for call in launch.called():
        yield from map(call.given, ("package", "executable", "name"))


def _too_early(
    body: Sequence[ast.stmt], known: frozenset[str]
) -> dict[str, tuple[ast.Name, int]]:
    """Return the names that steps read before the first one sets them, by name."""
    first: dict[str, int] = {}
    for at, step in enumerate(body):
        for name in names_in(step):
            first.setdefault(name, at)
        if isinstance(step, (ast.Global, ast.Nonlocal)) or "*" in first:
            return {}
    found: dict[str, tuple[ast.Name, int]] = {}
    for at, step in enumerate(body):
        for node in _read_in(step):
            set_at = first.get(node.id, -1) if node.id not in known else -1
            itself = set_at == at and isinstance(step, ast.Assign)
            if set_at > at or itself:
                found.setdefault(node.id, (node, body[set_at].lineno))
    return found


def _read_in(step: ast.stmt) -> Iterator[ast.Name]:
    """Yield the names that a step reads itself, without the functions in it."""
    waiting: list[ast.AST] = [step]
    while waiting:
        node = waiting.pop()
        if isinstance(node, _OTHER_SCOPES):
            continue
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            yield node
        waiting += ast.iter_child_nodes(node)
