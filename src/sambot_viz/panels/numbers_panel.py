"""The properties and arguments of the model as sliders, above its text."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from sambot_viz.panels.command import FLAG, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Answer, Data, Json, Row
from sambot_viz.robot.xacro.named_numbers import NamedNumber
from sambot_viz.session.editor.model_numbers import ModelNumber
from sambot_viz.session.editor.model_text import ModelText
from sambot_viz.session.signals import Signal
from sambot_viz.session.undo import History

_STEPS = 100
"""The smallest number of steps of a slider."""


class NumbersPanel(Panel):
    """A slider for each number that the model's files name, and where it is used.

    Args:
        text: that of the model.
        history: undoes moves.
        remake: called when the rows are seen, or no longer.
    """

    name = "numbers"

    def __init__(
        self, text: ModelText, history: History, remake: Callable[[Panel], None]
    ) -> None:
        self.remade_by = (text.changed, text.numbers.changed)
        self._text, self._numbers = text, text.numbers
        self._history, self._remake = history, remake
        self._shown = False

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The numbers that are moved."""
        return (self._numbers.moved,)

    def rows(self) -> Sequence[Row]:
        """Return a slider for each number, and the text of each expression."""
        if not self._shown:
            return ()
        listed = self._numbers.listed()
        count = Counter((n.named.kind, n.named.name) for n in listed)
        return [self._row(n, count[n.named.kind, n.named.name] > 1) for n in listed]

    def data(self) -> Sequence[Data]:
        """Return how many are moved, and may be written."""
        listed = self._numbers.listed() if self._shown else ()
        moved = [n for n in listed if n.moved is not None]
        return [
            Data("numbers/shown", self._shown),
            Data("numbers/count", len(listed)),
            Data("numbers/moved", len(moved)),
            Data("numbers/writable", sum(n.can_write for n in moved)),
        ]

    def values(self) -> Mapping[str, Json]:
        """Return where the numbers are that are moved."""
        if not self._shown:
            return {}
        return {_id(key): value for key, value in self._numbers.moved.value.items()}

    def _row(self, number: ModelNumber, is_twice: bool) -> Row:
        named = number.named
        line = f"{number.file.rpartition('/')[2]}:{named.line}"
        label = f"{named.name} ({line})" if is_twice else named.name
        what = "argument" if named.kind == "arg" else "property"
        help_text = f"{what} in {number.file} line {named.line}"
        if number.before is None:
            return Row(
                _id(number.id), "", "readonly", label, named.written, help=help_text
            )
        if number.given:
            help_text += "; the command line gives its value"
        low, high, step = _range(named, number.before)
        moved = number.moved
        return Row(
            _id(number.id),
            "",
            "slider",
            label,
            value=number.before if moved is None else moved,
            unit=named.unit,
            step=step,
            help=help_text,
            bold=moved is not None,
            extra={"low": low, "high": high},
            set=partial(self._move, number),
        )

    def _move(self, number: ModelNumber, value: float) -> None:
        before = self._numbers.moved.value.get(number.id)
        value = float(f"{round(value) if number.named.is_whole else value:.9g}")
        self._numbers.move(number.id, value)
        self._history.record(
            f"Move {number.named.name}",
            partial(self._numbers.move, number.id, before),
            partial(self._numbers.move, number.id, value),
            merge=number.id,
            of_document=False,
        )

    @command("numbers/show", FLAG, client_local=True)
    def _show(self, shown: bool) -> None:
        """Send the numbers, or do not: the panel is on the screen, or is not."""
        self._shown = shown
        self._remake(self)

    @command("numbers/reset", name="Reset")
    def _reset(self) -> Answer:
        before = self._numbers.reset()
        self._history.record(
            "Reset numbers",
            partial(self._numbers.restore, before),
            partial(self._numbers.restore, {}),
            of_document=False,
        )
        return Answer("All numbers are those of the text again; Undo moves them back")


def _id(number_id: str) -> str:
    return f"numbers/{number_id}"


def _range(named: NamedNumber, value: float) -> tuple[float, float, float]:
    """Return the ends of a slider around a value, and its step; all are round."""
    low, high = _ends(named, value)
    if named.is_whole:
        return low, high, 1.0
    step = 10.0 ** math.floor(math.log10((high - low) / _STEPS))
    # Without the last digits, which no person has written.
    return _round(low, step), _round(high, step), step


def _round(value: float, step: float) -> float:
    return float(f"{round(value / step) * step:.9g}")


def _ends(named: NamedNumber, value: float) -> tuple[float, float]:
    size = abs(value)
    half_turn = {"rad": math.pi, "°": 180.0}.get(named.unit)
    if half_turn is not None:
        turns = max(1, math.ceil(size / half_turn))
        return -half_turn * turns, half_turn * turns
    if named.is_whole:
        return min(0.0, value), max(0.0, value, 5.0 if value >= 0 else 0.0) + size
    if not named.signed and value > 0:
        return value / 10, 2 * value
    least = 0.1 if named.unit == "m" else 1.0
    return value - max(size, least), value + max(size, least)
