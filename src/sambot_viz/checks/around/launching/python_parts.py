"""The values in a Python launch file."""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass

from sambot_viz import limits
from sambot_viz.checks.around.launching.actions import (
    Action,
    ActionGroup,
    Expression,
    FromFile,
    Joined,
    UnknownAction,
)
from sambot_viz.errors import Place


@dataclass(frozen=True, slots=True)
class Listing:
    """A list or tuple of a launch file, or a LaunchDescription.

    Attributes:
        items: the items with their places.
        complete: False when there may be others.
    """

    items: tuple[tuple[PythonValue, Place], ...]
    complete: bool = True


@dataclass(frozen=True, slots=True)
class Table:
    """A dict of a launch file.

    Attributes:
        pairs: the keys and values, with the places of the values.
        complete: False when there may be others.
    """

    pairs: tuple[tuple[Expression, PythonValue, Place], ...]
    complete: bool = True


PythonValue = Expression | Listing | Table | Action | FromFile | ast.FunctionDef
"""The value of an expression; None for one that is not known."""
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


def as_actions(value: PythonValue, place: Place) -> tuple[Action, ...]:
    """Return the actions in a list; what is not known is an unknown action."""
    items = value.items if isinstance(value, Listing) else ((value, place),)
    found = [
        item if isinstance(item, Action) else UnknownAction(where, "true", "an action")
        for item, where in items
    ]
    if isinstance(value, Listing) and not value.complete:
        found.append(UnknownAction(place, "true", "a list"))
    return tuple(found)


def _doubtful(value: PythonValue) -> PythonValue:
    """Return a value that is perhaps not used."""
    if isinstance(value, Action):
        return ActionGroup(value.place, None, (value,), scoped=False)
    return None


def added(one: PythonValue, other: PythonValue) -> PythonValue:
    """Return two texts, lists or tables as one."""
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


def either(one: PythonValue, other: PythonValue) -> PythonValue:
    """Return what is one of two values."""
    if one is other or one == other:
        return one
    if isinstance(one, Listing) and isinstance(other, Listing):
        same = 0
        for left, right in zip(one.items, other.items, strict=False):
            if left[0] is not right[0]:
                break
            same += 1
        rest = (*one.items[same:], *other.items[same:])
        items = tuple((_doubtful(value), place) for value, place in rest)
        both = one.complete and other.complete
        return Listing((*one.items[:same], *items), both)
    actions = [value for value in (one, other) if isinstance(value, Action)]
    if actions:
        return ActionGroup(actions[0].place, None, tuple(actions), scoped=False)
    return None


def assign(target: ast.expr, value: PythonValue, names: Names) -> None:
    """Give a variable, or each of several, its value."""
    if isinstance(target, ast.Name):
        names[target.id] = value
    elif isinstance(target, (ast.Tuple, ast.List)):
        items = value.items if isinstance(value, Listing) else ()
        for at, inner in enumerate(target.elts):
            assign(inner, items[at][0] if at < len(items) else None, names)
    elif isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name):
        names[target.value.id] = None


def item_of(value: PythonValue, key: PythonValue) -> PythonValue:
    """Return what a list or a table has for a key."""
    if isinstance(value, Table) and isinstance(key, str):
        return next((v for k, v, _ in reversed(value.pairs) if k == key), None)
    if isinstance(value, Listing) and isinstance(key, str) and key.isdigit():
        return value.items[int(key)][0] if int(key) < len(value.items) else None
    return None


class Call:
    """A call with its arguments.

    Args:
        node: the call.
        file: of the launch file, for places.
        value: works out an expression.
        result: returns what a function of the file returns.
    """

    def __init__(
        self,
        node: ast.Call,
        file: str,
        value: Callable[[ast.expr | None], PythonValue],
        result: Callable[[ast.FunctionDef], PythonValue],
    ) -> None:
        self._node, self._file = node, file
        self._value, self._result = value, result
        self.place = self._place(node)
        self.complete = all(k.arg for k in node.keywords)

    def _place(self, node: ast.expr) -> Place:
        return Place(self._file, node.lineno, node.col_offset + 1)

    def _given(self, name: str, position: int | None = None) -> ast.expr | None:
        given = next((k.value for k in self._node.keywords if k.arg == name), None)
        if given is None and position is not None and position < len(self._node.args):
            given = self._node.args[position]
        is_none = isinstance(given, ast.Constant) and given.value is None
        return None if is_none else given

    def value(self, name: str, position: int | None = None) -> PythonValue:
        """Return the value of an argument."""
        return self._value(self._given(name, position))

    def text(
        self, name: str, position: int | None = None, default: Expression = ""
    ) -> Expression:
        """Return an argument as a text, and the default where it is not given."""
        node = self._given(name, position)
        return default if node is None else as_text(self._value(node))

    def texts(self) -> tuple[Expression, ...]:
        """Return all arguments without a name as texts."""
        return tuple(as_text(self._value(node)) for node in self._node.args)

    def listing(self, name: str, position: int | None = None) -> Listing:
        """Return an argument as a list; an empty one where it is not given."""
        node = self._given(name, position)
        value = self._value(node)
        if node is None or isinstance(value, Listing):
            return value if isinstance(value, Listing) else Listing(())
        items = ((value, self._place(node)),) if value is not None else ()
        return Listing(items, complete=value is not None)

    def actions(self, name: str, position: int | None = None) -> tuple[Action, ...]:
        """Return an argument as actions; a function stands for what it returns."""
        node = self._given(name, position)
        value = self._value(node)
        if isinstance(value, ast.FunctionDef):
            value = self._result(value)
        return () if node is None else as_actions(value, self.place)

    @property
    def condition(self) -> Expression:
        """The text that has to be true for an action."""
        return self.text("condition", default="true")
