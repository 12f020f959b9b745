"""Changes of properties, remembered so that they can be undone exactly.

`remembered` collects what is set inside it, whichever item it belongs to: one value
that a user sets may change others, as "All Links Enabled" does.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Protocol

PutBack = Callable[[], None]
"""Brings something back to how it was."""


class Remembering(Protocol):
    """An item whose properties can be put back."""

    def remember(self, path: str) -> PutBack:
        """A function that puts a property back to what it is now."""
        ...


class Changes:
    """The properties that were set, with what they were before and after."""

    def __init__(self) -> None:
        self._before: dict[tuple[int, str], tuple[Remembering, PutBack]] = {}
        self._after: list[PutBack] = []

    def __bool__(self) -> bool:
        return bool(self._before)

    def note(self, item: Remembering, path: str) -> None:
        """Remember a property before it is set for the first time."""
        key = (id(item), path)
        if key not in self._before:
            self._before[key] = (item, item.remember(path))

    def finish(self) -> None:
        """Remember what the properties are now, for `redo`."""
        known = self._before.items()
        self._after = [item.remember(path) for (_, path), (item, _) in known]

    def undo(self) -> None:
        """Put all properties back, the last one first."""
        for _, put_back in reversed(self._before.values()):
            put_back()

    def redo(self) -> None:
        """Set all properties again."""
        for put_back in self._after:
            put_back()


_collecting: ContextVar[Changes | None] = ContextVar("_collecting", default=None)


@contextmanager
def remembered() -> Generator[Changes]:
    """Collect the properties that this thread sets inside."""
    changes = Changes()
    token = _collecting.set(changes)
    try:
        yield changes
    finally:
        _collecting.reset(token)
        changes.finish()


def note(item: Remembering, path: str) -> None:
    """An item is about to set a property."""
    changes = _collecting.get()
    if changes is not None:
        changes.note(item, path)
