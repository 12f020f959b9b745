"""Types that are nothing but numbers and texts: where these are in a message."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any, cast

from sambot_viz.errors import DecodeError
from sambot_viz.messages.definition import BASE, DUMMY, NAME, Types

Leaf = tuple[str, str]
"""Path of a field, "pose.position.x", and the name of its base type."""

FORMATS: Mapping[str, str] = {
    **{"bool": "?", "byte": "b", "char": "B", "int8": "b", "uint8": "B"},
    **{"int16": "h", "uint16": "H", "int32": "i", "uint32": "I"},
    **{"int64": "q", "uint64": "Q", "float32": "f", "float64": "d"},
}
TEXT = "string"
_LENGTH = 4
"""Bytes of the length before a text."""
_MOST_LEAVES = 64


def leaves_of(name: str, types: Types) -> tuple[Leaf, ...]:
    """Return the numbers and texts of a type; none if it has other fields."""
    found = tuple(islice(_leaves(name, types, ""), _MOST_LEAVES + 1))
    return () if None in found or len(found) > _MOST_LEAVES else cast("Any", found)


def _leaves(name: str, types: Types, path: str) -> Iterator[Leaf | None]:
    # None ends it: nothing may be nested without bound that yields no leaf.
    if not types[name]:
        yield None
    for field, desc in types[name]:
        kind, what = cast("tuple[int, Any]", desc)
        if kind == NAME:
            yield from _leaves(what, types, f"{path}{field}.")
        elif kind == BASE and what[0] in (*FORMATS, TEXT) and field != DUMMY:
            yield f"{path}{field}", what[0]
        else:
            yield None


_SIZES = {TEXT: _LENGTH} | {
    kind: struct.calcsize(f"<{letter}") for kind, letter in FORMATS.items()
}


def size_of(kind: str) -> int:
    """Return how many bytes a base type has; of a text those of its length."""
    return _SIZES[kind]


def smallest(leaves: Sequence[Leaf]) -> int:
    """Return how many bytes a type has at least."""
    return sum(size_of(kind) for _, kind in leaves)


@dataclass(frozen=True, slots=True)
class Layout:
    """The positions of the fields of an element in a message.

    Attributes:
        begin: start of the element.
        end: end of its last field.
        numbers: path → position, counted from `begin`, and numpy's type.
        texts: (start, end) of each text with its length, counted from `begin`.
    """

    begin: int
    end: int
    numbers: Mapping[str, tuple[int, str]]
    texts: Sequence[tuple[int, int]]

    @classmethod
    def of(
        cls,
        leaves: Sequence[Leaf],
        data: memoryview,
        begin: int,
        order: str,
        is_aligned: bool,
    ) -> Layout:
        """Return the layout of the element that begins somewhere in a message.

        Raises:
            DecodeError: the message is cut off.
            struct.error: it is cut off in front of a text.
        """
        at, numbers, texts = begin, dict[str, tuple[int, str]](), list[Any]()
        for path, kind in leaves:
            size = size_of(kind)
            if is_aligned:
                at = (at + size - 1) & -size
            if kind == TEXT:
                (length,) = struct.unpack_from(f"{order}I", data, at)
                texts.append((at - begin, at - begin + _LENGTH + length))
                at += _LENGTH + length
            else:
                numbers[path] = at - begin, order + FORMATS[kind]
                at += size
            if at > len(data):
                raise DecodeError("it is cut off")
        return cls(begin, at, numbers, texts)
