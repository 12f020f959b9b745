"""The properties and arguments of a model, and where users have moved them.

A number that was moved is laid over the text of its file, an argument is given to
xacro; neither is a change of the text until it is written there.
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
        id: the same as long as it is the same one in its file.
        file: the name of that file.
        named: what the file says of it.
        given: what the command line gives for it; "" for nothing.
        before: the value without moving it; None for an expression.
        moved: where a user has moved it; None for nowhere.
    """

    id: str
    file: str
    named: NamedNumber
    given: str
    before: float | None
    moved: float | None

    @property
    def written(self) -> str:
        """The moved value as it is written into a file."""
        return "" if self.moved is None else f"{self.moved:.9g}"

    @property
    def can_write(self) -> bool:
        """Whether the moved value may be written in place of the one in the file."""
        return (
            self.moved is not None and self.named.value is not None and not self.given
        )


class ModelSources(NamedTuple):
    """The files that a model is made of.

    Attributes:
        texts: file → its text.
        names: file → what users call it; numbers of others cannot be changed.
    """

    texts: Mapping[str, str]
    names: Mapping[str, str]


class ModelNumbers:
    """The numbers that a model uses.

    Args:
        given: values of arguments on the command line.
        sources: returns the texts as they are in the editor.
        change: of the session.
        moved: those that are moved from the beginning.

    Attributes:
        moved: id → the value of each number that was moved.
        changed: told when others are moved than before.
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
        """Return all, in the order of the files."""
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

    # What users do; with the session locked.

    def move(self, number_id: str, value: float | None) -> None:
        """Show the model with another number, and leave its text alone.

        Args:
            number_id: of the number.
            value: the number; None for the one that it has without moving it.
        """
        self._set({**self.moved.value, number_id: value})

    def reset(self) -> Mapping[str, float]:
        """Take all numbers back; return those that were moved, for `restore`."""
        before = self.moved.value
        self._set({})
        return before

    def restore(self, moved: Mapping[str, float]) -> None:
        """Move numbers to where they were before `reset`."""
        self._set(moved)

    def forget(self) -> None:
        """Forget what is written by now, or no longer there."""
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
    """Return the arguments that were moved, with their values for xacro."""
    return {
        n.named.name: n.written
        for n in numbers
        if n.moved is not None and n.named.kind == "arg"
    }


def laid_over(text: str, numbers: Iterable[ModelNumber]) -> str:
    """Return the text of a file with the properties where they were moved.

    Args:
        text: of the file.
        numbers: those of this file.
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
