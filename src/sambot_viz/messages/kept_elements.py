"""Arrays of which most elements are as in the message before: only the rest is read.

A program that sends all its markers again has changed a few, or has moved them. An
element of the same bytes is the same object; of another one each part of the same
bytes has the same values.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from sambot_viz.errors import DecodeError

MOST_BYTES = 16_000_000
"""Elements hold their messages: after this amount all are read again [bytes]."""
_WIDEST = 8
"""No field is aligned to more bytes, so that it matters where a part begins."""
Read = Callable[[memoryview, int, Callable[..., Any], Any], tuple[Any, int]]
"""Reads the element at a position of a message, as rosbags generates it: returns an
object of its values, and the position of its end."""


@dataclass(slots=True, eq=False)
class _Element:
    """An element as it was read.

    Attributes:
        message: itself.
        data: its bytes.
        begin: where they begin in the message.
        parts: where its parts begin and end in these bytes, and their values.
    """

    message: Any
    data: bytes
    begin: int
    parts: Sequence[tuple[int, int, tuple[Any, ...]]]


class KeptElements:
    """The elements of the last message of a topic, for whoever reads the next one.

    They are for one thread.
    """

    def __init__(self) -> None:
        self._arrays: dict[ElementReader, tuple[Sequence[_Element], int]] = {}

    def of(self, reader: ElementReader) -> Sequence[_Element]:
        """Return the elements that an array had before; none after many messages."""
        elements, held = self._arrays.get(reader, ((), 0))
        return elements if held < MOST_BYTES else ()

    def keep(
        self, reader: ElementReader, elements: Sequence[_Element], size: int
    ) -> None:
        """Keep the elements of an array.

        Args:
            reader: of the array.
            elements: all of them.
            size: of the message, if some of them were read from it [bytes].
        """
        _, held = self._arrays.get(reader, ((), 0))
        held = held + size if held < MOST_BYTES else size
        self._arrays[reader] = elements, held


class ReadingMessage(Protocol):
    """What one reading of a message has at hand."""

    @property
    def kept(self) -> KeptElements | None:
        """Elements of the message before."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class ElementReader:
    """Reads arrays of one type.

    Attributes:
        cls: makes an element of its values.
        whole: reads an element.
        parts: what reads each part of one, and to how many bytes that is aligned.
    """

    cls: Callable[..., Any]
    whole: Read
    parts: Sequence[tuple[int, Read]]

    def __call__(
        self, data: memoryview, at: int, count: int, store: ReadingMessage
    ) -> tuple[Sequence[Any], int]:
        """Return the elements that begin somewhere, and where they end.

        Args:
            data: the message.
            at: where it is.
            count: of elements.
            store: what rosbags' functions ask for others, with what was kept.

        Raises:
            DecodeError: there are fewer than `count`.
        """
        if count > len(data) - at:
            raise DecodeError("an array longer than its message")
        if store.kept is not None:
            return self._with_kept(data, at, count, store, store.kept)
        found: list[Any] = []
        to = self.parts[0][0] - 1
        for _ in range(count):
            one, at = self.whole(data, (at + to) & ~to, self.cls, store)
            found.append(one)
        return found, at

    def _with_kept(
        self,
        data: memoryview,
        at: int,
        count: int,
        store: ReadingMessage,
        kept: KeptElements,
    ) -> tuple[Sequence[Any], int]:
        raw, before, found = bytes(data), kept.of(self), list[_Element]()
        to, known, is_same = self.parts[0][0] - 1, len(before), True
        for number in range(count):
            at = (at + to) & ~to
            last = before[number] if number < known else None
            if last is not None and _is_there(raw, at, last.data, last.begin):
                found.append(last)
                at += len(last.data)
            else:
                one, at = self._read(raw, data, at, last, store)
                found.append(one)
                is_same = False
        kept.keep(self, found, 0 if is_same else len(data))
        return [one.message for one in found], at

    def _read(
        self,
        raw: bytes,
        data: memoryview,
        begin: int,
        last: _Element | None,
        store: ReadingMessage,
    ) -> tuple[_Element, int]:
        """Return an element, with the values that are as in the last one."""
        at, parts = begin, list[tuple[int, int, tuple[Any, ...]]]()
        all_values: list[Any] = []
        for number, (alignment, read) in enumerate(self.parts):
            at = (at + alignment - 1) & -alignment
            start, values = at - begin, None
            if last is not None:
                first, end, kept = last.parts[number]
                if _is_there(raw, at, last.data[first:end], last.begin + first):
                    at += end - first
                    values = kept
            if values is None:
                values, at = read(data, at, _values, store)
            parts.append((start, at - begin, values))
            all_values += values
        message = self.cls(*all_values)
        return _Element(message, raw[begin:at], begin, parts), at


def _values(*values: Any) -> tuple[Any, ...]:
    """Return values instead of an object that has them."""
    return values


def _is_there(raw: bytes, at: int, data: bytes, begin: int) -> bool:
    """Return whether bytes are at a place in a message where they mean the same."""
    return not (at - begin) % _WIDEST and raw.startswith(data, at)
