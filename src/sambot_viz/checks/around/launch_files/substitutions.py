"""Report substitutions of launch that Python takes for texts before launch runs."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import write_between
from sambot_viz.errors import Fix, Place, Problem

_CODE = "launch-code"
_STOPS = "ros2 launch stops with it"
_OF_TEXTS = frozenset(
    {
        "open",
        "os.listdir",
        "os.path.abspath",
        "os.path.basename",
        "os.path.dirname",
        "os.path.exists",
        "os.path.isfile",
        "os.path.join",
        "os.path.splitext",
        "xacro.process",
        "xacro.process_file",
    }
)
"""Functions of Python whose arguments are texts."""
SUBSTITUTIONS = frozenset(
    {
        "Command",
        "EnvironmentVariable",
        "FindExecutable",
        "FindPackagePrefix",
        "FindPackageShare",
        "LaunchConfiguration",
        "PathJoinSubstitution",
        "PythonExpression",
        "TextSubstitution",
        "ThisLaunchFileDir",
    }
)
_JOINING = frozenset({"Command", "IfCondition", "PythonExpression", "UnlessCondition"})
"""Calls that join the texts of a list, in which no other list may be."""
_WORDS = ("arguments", "cmd")


class _EarlyUse(NamedTuple):
    """A substitution in an expression of Python that needs its text.

    Attributes:
        whole: the expression.
        part: the substitution in it.
        effect: of the expression.
        stops: Python stops with it.
    """

    whole: ast.expr
    part: ast.expr
    effect: str
    stops: bool


def substitution_in(node: ast.expr, launch: LaunchFile) -> ast.Call | None:
    """Return the substitution that an expression or its variable is."""
    made = launch.assigned(node)
    is_call = isinstance(made, ast.Call) and call_name(made.func) in SUBSTITUTIONS
    return made if is_call and isinstance(made, ast.Call) else None


def substitutions_for_texts(around: Surroundings) -> Iterator[Problem]:
    """Report substitutions of launch in functions of Python that take texts."""
    for launch in around.launches:
        found: dict[int, tuple[ast.Call, str]] = {}
        for call in launch.calls:
            function = ast.unparse(call.node.func)
            for node in call.node.args if function in _OF_TEXTS else ():
                inner = launch.origin(node)
                name = call_name(inner.func) if isinstance(inner, ast.Call) else ""
                if isinstance(inner, ast.Call) and name in SUBSTITUTIONS:
                    found.setdefault(id(inner), (inner, function))
        for inner, function in found.values():
            yield _no_plain_text(inner, function, launch)


def _no_plain_text(node: ast.Call, function: str, launch: LaunchFile) -> Problem:
    name = call_name(node.func)
    fix = Fix(
        "write PathJoinSubstitution([…]) with the same parts for os.path.join"
        if function == "os.path.join"
        else "read the text in an OpaqueFunction with .perform(context)"
    )
    given = [*node.args, *(k.value for k in node.keywords)]
    package = launch.values.text(given[0]) if given else None
    if name == "FindPackageShare" and package is not None:
        end = Place(launch.shown, node.end_lineno or 1, (node.end_col_offset or 0) + 1)
        added = f".find('{package}')"
        fix = write_between(end, end, added, f"write {added} after it")
    return Problem.at(
        launch.place(node),
        "error",
        _CODE,
        f"{name} is a substitution, whose text launch finds later, and {function} "
        f"takes texts: {_STOPS}",
        fix,
    )


def substitutions_in_python(around: Surroundings) -> Iterator[Problem]:
    """Report substitutions that Python adds, compares or formats like texts."""
    for launch in around.launches:
        parents = {
            id(child): node
            for node in ast.walk(launch.tree)
            for child in ast.iter_child_nodes(node)
        }
        for node in ast.walk(launch.tree):
            for use in _early_uses(node, launch):
                made = substitution_in(use.part, launch)
                name = "" if made is None else call_name(made.func)
                yield Problem.at(
                    launch.place(use.whole),
                    "error" if use.stops else "warning",
                    _CODE,
                    f"{name} is a substitution, whose text launch finds later, and "
                    f"{use.effect}",
                    _later(use, parents, launch),
                )


def _early_uses(node: ast.AST, launch: LaunchFile) -> Iterator[_EarlyUse]:
    match node:
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            texts = [left, right]
            parts = [n for n in texts if substitution_in(n, launch) is not None]
            if len(parts) == 1 and not isinstance(texts[parts == [left]], ast.List):
                effect = f"Python cannot add a text to it: {_STOPS}"
                yield _EarlyUse(node, parts[0], effect, stops=True)
        case ast.If(test=ast.Compare(left=left, comparators=[ast.Constant()]) as test):
            if substitution_in(left, launch) is not None:
                effect = "Python compares it before that: it is never equal to a text"
                yield _EarlyUse(test, left, effect, stops=False)
        case ast.If(test=test) if substitution_in(test, launch) is not None:
            effect = "Python asks before that: this is always true"
            yield _EarlyUse(test, test, effect, stops=False)
        case ast.JoinedStr(values=values):
            for value in values:
                if not isinstance(value, ast.FormattedValue):
                    continue
                if substitution_in(value.value, launch) is not None:
                    effect = "this text has the name of a Python object in its place"
                    yield _EarlyUse(node, value.value, effect, stops=False)
                    return
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            if substitution_in(inner, launch) is not None:
                effect = "str() makes the name of a Python object of it"
                yield _EarlyUse(node, inner, effect, stops=False)
        case _:
            pass


def _later(use: _EarlyUse, parents: dict[int, ast.AST], launch: LaunchFile) -> Fix:
    """Return the fix that leaves the text to launch."""
    above = parents.get(id(use.whole))
    is_words = isinstance(above, ast.keyword) and above.arg in _WORDS
    match use.whole if use.whole is not use.part else None:
        case ast.BinOp(left=left, right=right):
            texts = [ast.unparse(left), ast.unparse(right)]
        case ast.JoinedStr(values=values):
            texts = [
                repr(value.value)
                if isinstance(value, ast.Constant)
                else ast.unparse(value.value)
                for value in values
                if isinstance(value, (ast.Constant, ast.FormattedValue))
            ]
        case ast.Call():
            right = ast.unparse(use.part)
            return rewritten(use.whole, launch.shown, right)
        case _:
            return Fix(
                "write condition=IfCondition(…) for the action, or ask in an "
                "OpaqueFunction with .perform(context)"
            )
    if is_words:
        texts = [text.replace(" '", "'") for text in texts]
    call = parents.get(id(above)) if isinstance(above, ast.List) else None
    joined = ", ".join(texts)
    is_joined = isinstance(call, ast.Call) and call_name(call.func) in _JOINING
    right = joined if is_joined or len(texts) == 1 else f"[{joined}]"
    return rewritten(use.whole, launch.shown, right)
