"""Report values of other kinds where launch takes only texts and substitutions."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.launch_files.names import with_import
from sambot_viz.checks.around.launching.launch_file import NODES, LaunchFile
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write_between
from sambot_viz.errors import Fix, Place, Problem

_CODE = "launch-code"
_STOPS = "ros2 launch stops with it"
_PAIRS = "launch_arguments"
_CONDITIONS = ("IfCondition", "UnlessCondition")
_TEXTS: dict[str, tuple[tuple[str, int | None], ...]] = {
    "AppendEnvironmentVariable": (("name", 0), ("value", 1)),
    "DeclareLaunchArgument": (("default_value", 1),),
    **dict.fromkeys(_CONDITIONS, (("predicate_expression", 0),)),
    "LogInfo": (("msg", None),),
    "PushROSNamespace": (("namespace", 0),),
    "PushRosNamespace": (("namespace", 0),),
    "SetEnvironmentVariable": (("name", 0), ("value", 1)),
    "SetLaunchConfiguration": (("name", 0), ("value", 1)),
    **dict.fromkeys(
        NODES,
        tuple((n, None) for n in ("package", "executable", "name", "namespace")),
    ),
}
"""Call → its arguments that are texts, each with its position."""
_NUMBERS = frozenset({"float", "int", "len"})
_TRUE = frozenset({"true", "1"})
_FALSE = frozenset({"false", "0"})


def arguments_that_are_no_texts(around: Surroundings) -> Iterator[Problem]:
    """Report defaults and launch arguments that are not texts, and a dict of them."""
    for launch in around.launches:
        for call in launch.called(*_TEXTS):
            for name, position in _TEXTS[call.name]:
                given = call.given(name, position)
                if given is not None:
                    yield from _no_text(given, name, launch)
        for call in launch.called("IncludeLaunchDescription"):
            given = call.given(_PAIRS)
            if given is not None:
                yield from _no_pairs(given, launch)


def _no_pairs(given: ast.expr, launch: LaunchFile) -> Iterator[Problem]:
    table = launch.assigned(given)
    if isinstance(table, ast.Dict):
        end = Place(
            launch.shown, given.end_lineno or 1, (given.end_col_offset or 0) + 1
        )
        after = "the }" if table is given else ast.unparse(given)
        yield Problem.at(
            end,
            "error",
            _CODE,
            f"{_PAIRS} takes pairs of a name and a value, and a dict gives its names "
            f"alone: {_STOPS}",
            write_between(end, end, ".items()", f"write .items() after {after}"),
        )
        return
    for name, value in _pairs(table, launch):
        said = name.value if isinstance(name, ast.Constant) else "a value"
        yield from _no_text(value, str(said), launch)


def _pairs(
    given: ast.expr, launch: LaunchFile
) -> Iterator[tuple[ast.expr | None, ast.expr]]:
    """Yield the names and values in a list of pairs, or in the items of a dict."""
    match given:
        case ast.List(elts=pairs) | ast.Tuple(elts=pairs):
            for pair in pairs:
                if isinstance(pair, (ast.Tuple, ast.List)) and len(pair.elts) == 2:
                    yield pair.elts[0], pair.elts[1]
        case ast.Call(func=ast.Attribute(value=inner, attr="items")):
            table = launch.assigned(inner)
            if isinstance(table, ast.Dict):
                yield from zip(table.keys, table.values, strict=True)
        case _:
            pass


def _no_text(value: ast.expr, name: str, launch: LaunchFile) -> Iterator[Problem]:
    """Report a value, or an item of a list of texts that launch joins."""
    made = launch.assigned(value)
    for item in made.elts if isinstance(made, ast.List) else [value]:
        inner = launch.assigned(item)
        if not _is_other(inner):
            continue
        written = ast.unparse(inner)
        at = f" ({where(launch.place(inner), launch.shown)})"
        yield Problem.at(
            launch.place(item),
            "error",
            _CODE,
            f"{name} is {written}{at if inner is not item else ''}, and launch takes "
            f"only texts for it: {_STOPS}",
            _as_text(item, inner, launch),
        )


def _is_other(node: ast.expr) -> bool:
    """Return whether an expression is certainly neither a text nor a substitution."""
    match node:
        case ast.UnaryOp(op=ast.Not()) | ast.Compare() | ast.Dict():
            return True
        case ast.UnaryOp(operand=inner):
            return isinstance(inner, ast.Constant)
        case ast.Constant(value=value):
            return not isinstance(value, str)
        case ast.Call(func=ast.Name(id=name)):
            return name in _NUMBERS
        case _:
            return False


def _as_text(item: ast.expr, inner: ast.expr, launch: LaunchFile) -> Fix:
    """Return the fix that makes a text of a value."""
    match inner:
        case ast.Constant(value=None) | ast.Dict():
            return Fix("write a text, or delete it")
        case ast.Compare(left=left, ops=[ast.Eq()], comparators=[right]):
            is_later = isinstance(launch.assigned(left), ast.Call)
            if is_later and isinstance(right, ast.Constant):
                return _compared(item, left, str(right.value), launch)
            return Fix(f"write str({ast.unparse(item)})")
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            return Fix(f"write UnlessCondition({ast.unparse(operand)}) for the whole")
        case _:
            written = ast.unparse(inner)
            right = f"'{written}'" if inner is item else f"str({ast.unparse(item)})"
            if isinstance(inner, ast.Call):
                right = f"str({ast.unparse(item)})"
            return rewritten(item, launch.shown, right)


def _compared(item: ast.expr, left: ast.expr, right: str, launch: LaunchFile) -> Fix:
    """Return the fix for a substitution that Python compares before it has a text."""
    said, conditions = ast.unparse(left), [*launch.called(*_CONDITIONS)]
    is_condition = any(item in call.node.args for call in conditions)
    if is_condition and right.lower() in _TRUE:
        return rewritten(item, launch.shown, said)
    if is_condition and right.lower() in _FALSE:
        return Fix(f"write UnlessCondition({said}) for the whole")
    name = "EqualsSubstitution"
    hint = f"write {name}({said}, '{right}')"
    return Fix(with_import(hint, name, launch))
