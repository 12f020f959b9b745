"""Evaluate expressions in a Python file without running it."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from typing import NamedTuple

from sambot_viz.checks.around.launching.actions import Expression
from sambot_viz.checks.around.launching.python_parts import (
    Call,
    Listing,
    PythonValue,
    as_text,
)
from sambot_viz.checks.around.launching.python_reader import PythonReader
from sambot_viz.checks.around.launching.texts import LaunchTexts


class Texts(NamedTuple):
    """The texts in a list.

    Attributes:
        items: each with its expression, None for an unknown one; those of a glob share
            one expression.
        complete: False when there may be others.
    """

    items: tuple[tuple[ast.expr, str | None], ...]
    complete: bool = True

    @property
    def known(self) -> frozenset[str] | None:
        """The texts; None when there may be others."""
        texts = frozenset(text for _, text in self.items if text is not None)
        whole = all(text is not None for _, text in self.items)
        return texts if self.complete and whole else None


class PythonValues:
    """Evaluates expressions of a file, each in its place.

    Args:
        tree: the file.
        shown: its path, for places.
        calls: name of a call → the function that makes its result.

    Attributes:
        actions: its actions as a launch file.
        calls: all calls, from top to bottom.
    """

    def __init__(
        self,
        tree: ast.Module,
        shown: str,
        calls: Mapping[str, Callable[[Call], PythonValue]],
    ) -> None:
        reader = PythonReader(tree, shown, calls)
        self.actions = reader.read()
        self._values = reader.values
        self._known: dict[int, str | None] = {}
        self._texts = LaunchTexts()
        found = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
        found.sort(key=lambda call: (call.lineno, call.col_offset))
        self.calls = [Call(node, shown, self.of, lambda _: None) for node in found]

    def of(self, node: ast.expr | None) -> PythonValue:
        """Return the value of an expression; None when uncertain."""
        return self._values.get(id(node))

    def declare(self, name: str, default: Expression) -> None:
        """Use the default as the value of a launch argument."""
        self._texts.arguments[name] = self._texts.settled(default)

    def text(self, node: ast.expr | None) -> str | None:
        """Return the text of an expression; None when uncertain.

        A launch argument becomes its default value, and the share folder of a package
        becomes ``package://NAME``.
        """
        if id(node) not in self._known:
            self._known[id(node)] = self.said(self.of(node))
        return self._known[id(node)]

    def said(self, value: PythonValue) -> str | None:
        """Return the text of a value; None when uncertain."""
        return self._texts.text(as_text(value))

    def items(self, node: ast.expr | None) -> Listing:
        """Return the items of a list; incomplete for uncertain ones."""
        value = self.of(node)
        return value if isinstance(value, Listing) else Listing((), complete=False)

    def listed(self, value: PythonValue) -> Texts:
        """Return the texts in a list."""
        if not isinstance(value, Listing):
            return Texts((), complete=False)
        items = tuple((node, self.said(item)) for item, node in value.items)
        return Texts(items, value.complete)

    def texts(self, node: ast.expr | None) -> list[str]:
        """Return the known texts in a list, or the one text of another expression."""
        value = self.of(node)
        items = [v for v, _ in value.items] if isinstance(value, Listing) else [value]
        return [text for text in map(self.said, items) if text is not None]

    @property
    def defaults(self) -> dict[str, str]:
        """Launch argument → its default value, where known."""
        every = self._texts.arguments.items()
        return {name: text for name, text in every if isinstance(text, str)}
