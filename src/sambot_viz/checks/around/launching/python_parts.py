"""Represent the values in a Python launch file."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.checks.around.launching.actions import (
    Action,
    ActionGroup,
    Expression,
    FromFile,
    Joined,
    UnknownAction,
)
from sambot_viz.checks.launch_files import call_name
from sambot_viz.errors import Place


class Listing(NamedTuple):
    """A list or tuple of a launch file, or a LaunchDescription.

    Attributes:
        items: the items, each with its expression; those of a glob share one.
        complete: False when there may be others.
    """

    items: tuple[tuple[PythonValue, ast.expr], ...]
    complete: bool = True


class Pair(NamedTuple):
    """A key of a dict with its value.

    Attributes:
        key: the key.
        value: the value.
        key_node: the expression of the key.
        node: the expression of the value.
    """

    key: Expression
    value: PythonValue
    key_node: ast.expr
    node: ast.expr


class Table(NamedTuple):
    """A dict of a launch file.

    Attributes:
        pairs: the keys and values.
        complete: False when there may be others.
    """

    pairs: tuple[Pair, ...]
    complete: bool = True


PythonValue = Expression | Listing | Table | Action | FromFile | ast.FunctionDef
"""The value of an expression; None for an unknown one."""
Names = dict[str, PythonValue]


def as_text(value: PythonValue) -> Expression:
    """Return a value as a text: launch puts the items of a list together."""
    if isinstance(value, Listing):
        parts = tuple(as_text(item) for item, _ in value.items)
        if len(parts) == 1 and value.complete:
            return parts[0]
        return Joined(parts) if value.complete else None
    if isinstance(value, FromFile):
        return value.path
    if isinstance(value, (Table, Action, ast.FunctionDef)):
        return None
    return value


def place_in(file: str, node: ast.expr | ast.stmt) -> Place:
    """Return the place of an expression in a file."""
    return Place(file, node.lineno, node.col_offset + 1)


def as_actions(
    value: PythonValue, file: str, node: ast.expr | ast.stmt
) -> tuple[Action, ...]:
    """Return the actions in a list; an unknown item becomes an unknown action.

    Args:
        value: the list, or one action.
        file: the launch file.
        node: the expression that has this value.
    """
    items = value.items if isinstance(value, Listing) else ((value, node),)
    found = [
        item
        if isinstance(item, Action)
        else UnknownAction(place_in(file, where), "true", "an action")
        for item, where in items
    ]
    if isinstance(value, Listing) and not value.complete:
        found.append(UnknownAction(place_in(file, node), "true", "a list"))
    return tuple(found)


def _doubtful(value: PythonValue) -> PythonValue:
    """Return a value that the launch file may not use."""
    if isinstance(value, Action):
        return ActionGroup(value.place, None, (value,), scoped=False)
    return None


def added(one: PythonValue, other: PythonValue) -> PythonValue:
    """Return two texts, lists or dicts joined."""
    if isinstance(one, Table) and isinstance(other, Table):
        return Table((*one.pairs, *other.pairs), one.complete and other.complete)
    if not isinstance(one, Listing) and not isinstance(other, Listing):
        return Joined((as_text(one), as_text(other)))
    left, right = (
        each if isinstance(each, Listing) else Listing((), complete=False)
        for each in (one, other)
    )
    items = (*left.items, *right.items)
    if len(items) > limits.LAUNCH_VALUE.value:
        return Listing((), complete=False)
    return Listing(items, left.complete and right.complete)


def formatted(text: PythonValue, values: PythonValue) -> PythonValue:
    """Return a text with a value for each %s in it."""
    items = values.items if isinstance(values, Listing) else ((values, None),)
    parts = text.split("%s") if isinstance(text, str) else []
    if len(parts) != len(items) + 1 or "%" in "".join(parts):
        return None
    both = zip(parts, items, strict=False)
    joined = [each for part, (value, _) in both for each in (part, as_text(value))]
    return Joined((*joined, parts[-1]))


def either(one: PythonValue, other: PythonValue) -> PythonValue:
    """Return a value that is one of two."""
    if one is other or one == other:
        return one
    if isinstance(one, Listing) and isinstance(other, Listing):
        same = 0
        for left, right in zip(one.items, other.items, strict=False):
            if left[0] is not right[0]:
                break
            same += 1
        rest = (*one.items[same:], *other.items[same:])
        items = tuple((_doubtful(value), node) for value, node in rest)
        both = one.complete and other.complete
        return Listing((*one.items[:same], *items), both)
    actions = [value for value in (one, other) if isinstance(value, Action)]
    if actions:
        return ActionGroup(actions[0].place, None, tuple(actions), scoped=False)
    return None


def assign(target: ast.expr, value: PythonValue, names: Names) -> None:
    """Assign a value to a variable, or one to each of several."""
    if isinstance(target, ast.Name):
        names[target.id] = value
    elif isinstance(target, (ast.Tuple, ast.List)):
        items = value.items if isinstance(value, Listing) else ()
        for at, inner in enumerate(target.elts):
            assign(inner, items[at][0] if at < len(items) else None, names)
    elif isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name):
        names[target.value.id] = None


def item_of(value: PythonValue, key: PythonValue) -> PythonValue:
    """Return the item of a list or a dict for a key."""
    if isinstance(value, Table) and isinstance(key, str):
        pairs = reversed(value.pairs)
        return next((pair.value for pair in pairs if pair.key == key), None)
    if isinstance(value, Listing) and isinstance(key, str) and key.isdigit():
        return value.items[int(key)][0] if int(key) < len(value.items) else None
    return None


def truth_of(
    node: ast.expr, value: Callable[[ast.expr | None], PythonValue]
) -> bool | None:
    """Return whether an expression is true; None when unknown.

    Args:
        node: the expression.
        value: evaluates an expression in it.
    """
    match node:
        case ast.Constant(value=constant):
            return bool(constant)
        case ast.UnaryOp(op=ast.Not(), operand=inner):
            truth = truth_of(inner, value)
            return None if truth is None else not truth
        case ast.Compare(left=left, ops=[ast.Eq()], comparators=[right]):
            texts = value(left), value(right)
            known = [text for text in texts if isinstance(text, str)]
            return known[0] == known[1] if len(known) == len(texts) else None
        case _:
            return None


class Call:
    """A call with its arguments.

    Args:
        node: the call.
        file: the launch file, for places.
        value: evaluates an expression.
        result: returns the result of a function of the file.

    Attributes:
        node: the call.
        name: of the called function or class: "Node" in ``actions.Node(…)``.
        place: of the call.
        complete: the call has all its arguments, without * and **.
    """

    def __init__(
        self,
        node: ast.Call,
        file: str,
        value: Callable[[ast.expr | None], PythonValue],
        result: Callable[[ast.FunctionDef], PythonValue],
    ) -> None:
        self.node, self._file = node, file
        self._value, self._result = value, result
        self.name = call_name(node.func)
        self.place = place_in(file, node)
        self.complete = all(k.arg for k in node.keywords)

    def given(self, name: str, position: int | None = None) -> ast.expr | None:
        """Return the expression of an argument; None for a missing one."""
        given = next((k.value for k in self.node.keywords if k.arg == name), None)
        if given is None and position is not None and position < len(self.node.args):
            given = self.node.args[position]
        is_none = isinstance(given, ast.Constant) and given.value is None
        return None if is_none else given

    def value(self, name: str, position: int | None = None) -> PythonValue:
        """Return the value of an argument."""
        return self._value(self.given(name, position))

    def text(
        self, name: str, position: int | None = None, default: Expression = ""
    ) -> Expression:
        """Return an argument as a text; the default for a missing one."""
        node = self.given(name, position)
        return default if node is None else as_text(self._value(node))

    def texts(self) -> tuple[Expression, ...]:
        """Return all arguments without a name as texts."""
        return tuple(as_text(self._value(node)) for node in self.node.args)

    def listing(self, name: str, position: int | None = None) -> Listing:
        """Return an argument as a list; an empty one for a missing argument."""
        node = self.given(name, position)
        value = self._value(node)
        if node is None or isinstance(value, Listing):
            return value if isinstance(value, Listing) else Listing(())
        items = ((value, node),) if value is not None else ()
        return Listing(items, complete=value is not None)

    def actions(self, name: str, position: int | None = None) -> tuple[Action, ...]:
        """Return an argument as actions; a function becomes its return value."""
        node = self.given(name, position)
        value = self._value(node)
        if isinstance(value, ast.FunctionDef):
            value = self._result(value)
        return () if node is None else as_actions(value, self._file, self.node)

    @property
    def condition(self) -> Expression:
        """The text that must be true for an action."""
        return self.text("condition", default="true")

    def place_of(self, node: ast.expr) -> Place:
        """Return the place of an expression in it."""
        return place_in(self._file, node)
