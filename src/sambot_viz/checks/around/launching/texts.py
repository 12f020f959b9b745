"""Evaluate the texts of launch files: arguments, paths and conditions."""

from __future__ import annotations

import ast
import operator
import posixpath
from collections.abc import Callable, Sequence
from typing import Any

from sambot_viz import limits
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launching.actions import (
    Expression,
    Joined,
    LaunchArgument,
    Operation,
    RobotText,
    ShareFolder,
)
from sambot_viz.checks.launch_files import parse_python

_TRUTH = {"true": True, "1": True, "false": False, "0": False}
_COMPARED: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda one, other: one in other,
    ast.NotIn: lambda one, other: one not in other,
}
UNKNOWN = "\0"
"""The text for an unknown part of a command."""
_METHODS = frozenset({"lower", "upper", "strip", "startswith", "endswith"})


class _NotKnown(Exception):
    """An expression of Python that this module does not understand."""


class LaunchTexts:
    """Evaluates expressions with the values of launch arguments.

    Attributes:
        arguments: name → its value as an expression without arguments.
        folder: the folder of the launch file, such as package://cart/launch.
    """

    def __init__(self) -> None:
        self.arguments: dict[str, Expression] = {}
        self.folder: str | None = None
        self._left = limits.LAUNCH_STEPS.value

    def settled(self, expression: Expression) -> Expression:
        """Return an expression without arguments: a text, a robot's, or None."""
        match expression:
            case RobotText(source=source):
                return RobotText(self.marked(source))
            case LaunchArgument():
                return self._argument(expression)
            case Joined(parts=(only,)):
                return self.settled(only)
            case _:
                return self.text(expression)

    def text(self, expression: Expression) -> str | None:
        """Return the text of an expression; None when unknown."""
        self._left -= 1
        if self._left < 0:
            return None
        found = self._text(expression)
        short = found is not None and len(found) <= limits.LAUNCH_VALUE.value
        return found if short else None

    def marked(self, expression: Expression) -> str | None:
        """Return the text of a command, with UNKNOWN for each unknown part."""
        if isinstance(expression, Joined) and not expression.is_path:
            return "".join(self.marked(part) or UNKNOWN for part in expression.parts)
        return self.text(expression)

    def _text(self, expression: Expression) -> str | None:
        match expression:
            case str():
                return expression
            case Joined(parts=parts, is_path=is_path):
                return self._joined(parts, is_path)
            case LaunchArgument():
                found = self._argument(expression)
                return found if isinstance(found, str) else None
            case ShareFolder(package=""):
                return self.folder
            case ShareFolder(package=package):
                name = self.text(package)
                return None if name is None else SHARE + name
            case Operation(name="eval", operands=(inner,)):
                written = self.text(inner)
                return None if written is None else evaluated(written)
            case Operation(name="if-else", operands=(test, *others)):
                truth = self.truth(test)
                chosen = others[0 if truth else 1 :][:1] if truth is not None else []
                return self.text(chosen[0]) if chosen else None
            case Operation():
                truth = self.truth(expression)
                return None if truth is None else str(truth)
            case _:
                return None

    def _argument(self, expression: LaunchArgument) -> Expression:
        name = self.text(expression.name)
        if name in self.arguments:
            return self.arguments[name]
        return self.settled(expression.default)

    def _joined(self, parts: Sequence[Expression], is_path: bool) -> str | None:
        texts = [self.text(part) for part in parts]
        known = [text for text in texts if text is not None]
        if len(known) < len(texts):
            return None
        if not is_path or not known:
            return "".join(known)
        first, *rest = known
        joined = "/".join([first.rstrip("/"), *(text.strip("/") for text in rest)])
        scheme = SHARE if joined.startswith(SHARE) else ""
        below = joined.removeprefix(scheme)
        return scheme + (posixpath.normpath(below) if ".." in below else below)

    def truth(self, expression: Expression) -> bool | None:
        """Return whether a text is true; None when unknown."""
        match expression:
            case Operation(name="not", operands=(inner,)):
                truth = self.truth(inner)
                return None if truth is None else not truth
            case Operation(name="and" | "or" as name, operands=operands):
                found = [self.truth(each) for each in operands]
                decisive = name == "or"
                if decisive in found:
                    return decisive
                return None if None in found else not decisive
            case Operation(name="equals" | "differs" as name, operands=(one, other)):
                texts = self.text(one), self.text(other)
                same = texts[0] == texts[1]
                return None if None in texts else same == (name == "equals")
            case _:
                text = self.text(expression)
                return None if text is None else _TRUTH.get(text.strip().lower())

    def no_truth(self, expression: Expression) -> tuple[str, str] | None:
        """Return an argument that is neither true nor false, and its value.

        Args:
            expression: the condition; None for one that is not an argument.
        """
        match expression:
            case Operation(name="not", operands=(inner,)):
                return self.no_truth(inner)
            case LaunchArgument(name=str(name)):
                text = (self.text(expression) or "").strip()
                return (name, text) if text and text.lower() not in _TRUTH else None
            case _:
                return None


def evaluated(written: str) -> str | None:
    """Return the value of an expression of Python; None for one not understood."""
    tree = parse_python(written.strip())
    match tree:
        case ast.Module(body=[ast.Expr(value=inner)]):
            try:
                return str(_python(inner))
            except (_NotKnown, TypeError, RecursionError):
                return None
        case _:
            return None


def _python(node: ast.expr) -> Any:
    match node:
        case ast.Constant(value=value):
            return value
        case ast.BoolOp(op=op, values=values):
            decisive = isinstance(op, ast.Or)
            found: Any = None
            for inner in values:
                found = _python(inner)
                if bool(found) == decisive:
                    break
            return found
        case ast.UnaryOp(op=ast.Not(), operand=inner):
            return not _python(inner)
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_python(inner)
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            return _COMPARED[type(op)](_python(left), _python(right))
        case ast.IfExp(test=test, body=body, orelse=orelse):
            return _python(body if _python(test) else orelse)
        case ast.List(elts=parts) | ast.Tuple(elts=parts):
            return [_python(part) for part in parts]
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _python(left) + _python(right)
        case ast.Call(func=ast.Attribute(value=inner, attr=name), args=arguments):
            owner = _python(inner)
            if name not in _METHODS or not isinstance(owner, str):
                raise _NotKnown
            return getattr(owner, name)(*(_python(each) for each in arguments))
        case _:
            raise _NotKnown
