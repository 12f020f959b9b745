"""The properties and arguments of a model, and the values that users move them to.

A moved property replaces the number in the file's text, a moved argument goes to xacro.
Neither changes the text until the user writes it there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from sambot_viz.robot.xacro.named_numbers import NamedNumber, named_numbers
from sambot_viz.robot.xml.diagnose.source_text import SourceText
from sambot_viz.session.signals import Change, Signal


@dataclass(frozen=True, slots=True)
class ModelNumber:
    """A property or an argument of the model.

    Attributes:
        id: identifier that lasts as long as the number stays in its file.
        file: name of that file.
        named: its definition in the file.
        given: value from the command line; "" for none.
        before: value without the move; None for an expression.
        moved: value that a user has chosen; None for none.
    """

    id: str
    file: str
    named: NamedNumber
    given: str
    before: float | None
    moved: float | None

    @property
    def written(self) -> str:
        """The moved value in the form in which a file holds it."""
        return "" if self.moved is None else f"{self.moved:.9g}"

    @property
    def can_write(self) -> bool:
        """Return whether the moved value may replace the one in the file."""
        return (
            self.moved is not None and self.named.value is not None and not self.given
        )


class ModelSources(NamedTuple):
    """The files that make up a model.

    Attributes:
        texts: file → its text.
        names: file → its name for users, who cannot change numbers of other files.
    """

    texts: Mapping[str, str]
    names: Mapping[str, str]


class ModelNumbers:
    """The numbers that a model uses.

    Args:
        given: values of arguments on the command line.
        sources: returns the texts in the editor.
        change: change signal of the session.
        moved: numbers that are moved from the start.

    Attributes:
        moved: id → value of each moved number.
        changed: signal that other numbers have moved.
    """

    def __init__(
        self,
        given: Mapping[str, str],
        sources: Callable[[], ModelSources],
        change: Change,
        moved: Mapping[str, float],
    ) -> None:
        self._given, self._sources = given, sources
        self._read: tuple[Mapping[str, str], list[NamedNumber]] = ({}, [])
        self.moved: Signal[Mapping[str, float]] = Signal(change, moved)
        self.changed = Signal(change, None)

    def listed(self) -> list[ModelNumber]:
        """Return all numbers, in the order of the files."""
        texts, names = self._sources()
        if texts != self._read[0]:
            sources = {file: SourceText(text) for file, text in texts.items()}
            self._read = texts, named_numbers(sources)
        own = (one for one in self._read[1] if one.file in names)
        return [self._number(one, names[one.file]) for one in own]

    def _number(self, named: NamedNumber, file: str) -> ModelNumber:
        key = f"{file}/{named.kind}/{named.name}/{named.count}"
        given = self._given.get(named.name, "") if named.kind == "arg" else ""
        before = _float(given) if given else named.value
        moved = None if before is None else self.moved.value.get(key)
        return ModelNumber(key, file, named, given, before, moved)

    # Actions of users; the caller holds the session's lock.

    def move(self, number_id: str, value: float | None) -> None:
        """Show the model with another number, and leave its text alone.

        Args:
            number_id: id of the number.
            value: new value; None for the value in the file.
        """
        self._set({**self.moved.value, number_id: value})

    def reset(self) -> Mapping[str, float]:
        """Move all numbers back; return the moved ones, for `restore`."""
        before = self.moved.value
        self._set({})
        return before

    def restore(self, moved: Mapping[str, float]) -> None:
        """Move numbers to their values from before `reset`."""
        self._set(moved)

    def forget(self) -> None:
        """Forget moves that a file now holds, and numbers that no longer exist."""
        if self.moved.value:
            self._set(self.moved.value)

    def _set(self, moved: Mapping[str, float | None]) -> None:
        before = {one.id: one.before for one in self.listed()}
        kept = {
            key: value
            for key, value in moved.items()
            if value is not None and before.get(key) not in (None, value)
        }
        if kept.keys() != self.moved.value.keys():
            self.changed.touch()
        self.moved.set(kept)


def arguments_of(numbers: Iterable[ModelNumber]) -> dict[str, str]:
    """Return the moved arguments, with their values for xacro."""
    return {
        n.named.name: n.written
        for n in numbers
        if n.moved is not None and n.named.kind == "arg"
    }


def laid_over(text: str, numbers: Iterable[ModelNumber]) -> str:
    """Return the text of a file with its moved properties.

    Args:
        text: text of the file.
        numbers: numbers of this file.
    """
    for one in sorted(numbers, key=_start, reverse=True):
        if one.moved is not None and one.named.kind == "property":
            start, end = one.named.extent
            text = text[:start] + one.written + text[end:]
    return text


def _start(number: ModelNumber) -> int:
    return number.named.extent.start


def _float(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
