"""Write the functions that read types, as Python code.

Numbers that follow each other are read by one call of `struct`, across the borders of
small types; the code has no loop but those of arrays. It is made of numbered names
alone: nothing that a definition says becomes code.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from typing import Any, NoReturn, Protocol, cast

import numpy as np

from sambot_viz.errors import DecodeError
from sambot_viz.messages.definition import ARRAY, BASE, DUMMY, NAME, Types
from sambot_viz.messages.flat_types import FORMATS, TEXT, size_of
from sambot_viz.messages.rows import ArrayReader, Read

_MOST_VALUES = 100
"""A function with more reads types in it by functions of their own."""
_COUNT = "uint32"


class Readers(Protocol):
    """What the code of a type needs of others."""

    types: Types
    order: str
    aligned: bool
    classes: Mapping[str, type]

    def reader(self, name: str) -> Read:
        """Return what reads a type."""
        ...

    def array_reader(self, name: str) -> ArrayReader:
        """Return what reads arrays of a type."""
        ...


class ReaderCode:
    """The code of one function.

    Args:
        readers: the other functions.
    """

    def __init__(self, readers: Readers) -> None:
        self._readers = readers
        self._lines: list[str] = ["def read(data, at):", "    size = len(data)"]
        self._known: dict[str, Any] = {
            "frombuffer": np.frombuffer,
            "bad_text": _bad_text,
            "too_many": _too_many,
        }
        self._values = 0
        # Numbers that one call will read: their format and names, and how many bytes
        # they have from a place that is a multiple of `_base`.
        self._form, self._names, self._size, self._base = "", list[str](), 0, 1

    def function(self, name: str) -> Read:
        """Return the function that reads a type."""
        made = self._object(name)
        self._flush()
        self._lines.append(f"    return {made}, at")
        exec("\n".join(self._lines), self._known)
        return self._known["read"]

    # Names

    def _value(self) -> str:
        self._values += 1
        return f"v{self._values}"

    def _constant(self, value: object) -> str:
        word = f"k{len(self._known)}"
        self._known[word] = value
        return word

    def _say(self, *lines: str) -> None:
        self._lines += [f"    {line}" for line in lines]

    # Places

    def _align(self, size: int) -> None:
        """Go to the next multiple of a size."""
        if not self._readers.aligned:
            return
        if self._base < size:
            self._flush()
            self._say(f"at = (at + {size - 1}) & -{size}")
            self._base = size
        elif gap := -self._size % size:
            self._form += f"{gap}x"
            self._size += gap

    def _flush(self) -> None:
        """Read the numbers that wait for it, and go behind them."""
        if self._names:
            form = struct.Struct(self._readers.order + self._form)
            unpack = self._constant(form.unpack_from)
            self._say(f"{', '.join(self._names)}, = {unpack}(data, at)")
        if self._size:
            self._say(f"at += {self._size}")
            self._base = math.gcd(self._base, self._size)
        self._form, self._names, self._size = "", [], 0

    # Fields: each returns an expression

    def _object(self, name: str) -> str:
        # Objects count: those of types without fields must not be without number.
        self._value()
        fields = self._readers.types[name]
        values = [self._field(field, desc) for field, desc in fields]
        made = self._constant(self._readers.classes[name])
        return f"{made}({', '.join(filter(None, values))})"

    def _field(self, name: str, desc: Any) -> str:
        kind, what = cast("tuple[int, Any]", desc)
        if kind == NAME:
            if self._values < _MOST_VALUES:
                return self._object(what)
            return self._called(self._readers.reader(what))
        if kind == BASE:
            if name == DUMMY and not self._readers.aligned:
                return ""
            return self._text() if what[0] == TEXT else self._number(what[0])
        (inner, of), count = what
        length = str(count) if kind == ARRAY else self._number(_COUNT)
        if inner == BASE and of[0] != TEXT:
            return (self._numbers if kind == ARRAY else self._sequence)(of[0], length)
        if inner == NAME:
            return self._called(self._readers.array_reader(of), length)
        return self._called(TextsReader(self._readers), length)

    def _number(self, kind: str) -> str:
        self._align(size_of(kind))
        self._form += FORMATS[kind]
        self._size += size_of(kind)
        self._names.append(self._value())
        return self._names[-1]

    def _called(self, function: object, count: str = "") -> str:
        """Return what a function reads here: an object, or so many of them."""
        self._flush()
        value, called = self._value(), self._constant(function)
        if count:
            call = f"{called}(data, at, {count}) if {count} else ([], at)"
        else:
            call = f"{called}(data, at)"
        self._say(f"{value}, at = {call}")
        self._base = 1
        return value

    def _text(self) -> str:
        length = self._number(_COUNT)
        self._flush()
        value, has_zero = self._value(), self._readers.aligned
        wrong = f"end > size or not {length} or data[end - 1]"
        last = "end - 1" if has_zero else "end"
        self._say(
            f"end = at + {length}",
            f"if {wrong if has_zero else 'end > size'}:",
            "    bad_text(end > size)",
            f"{value} = str(data[at:{last}], 'utf-8') if {last} > at else ''",
            "at = end",
        )
        self._base = 1
        return value

    def _numbers(self, kind: str, count: str) -> str:
        """Return an array whose length the definition says."""
        size, value = size_of(kind), self._value()
        self._align(size)
        self._flush()
        self._say(self._array(value, kind, count), f"at += {count} * {size}")
        self._base = size
        return value

    def _sequence(self, kind: str, length: str) -> str:
        """Return an array whose length the message says."""
        size, value = size_of(kind), self._value()
        self._flush()
        empty = np.zeros(0, FORMATS[kind])
        empty.flags.writeable = False
        # Without elements there is nothing to align.
        gap = [f"    at = (at + {size - 1}) & -{size}"] if self._readers.aligned else []
        self._say(
            f"if {length} * {size} > size - at:",
            "    too_many()",
            f"if {length}:",
            *gap,
            f"    {self._array(value, kind, length)}",
            f"    at += {length} * {size}",
            "else:",
            f"    {value} = {self._constant(empty)}",
        )
        self._base = min(size, size_of(_COUNT))
        return value

    def _array(self, value: str, kind: str, count: str) -> str:
        dtype = self._dtype(kind)
        native = np.dtype(FORMATS[kind])
        swapped = "" if dtype == native else f".astype({self._constant(native)})"
        known = self._constant(dtype)
        return f"{value} = frombuffer(data, {known}, {count}, at){swapped}"

    def _dtype(self, kind: str) -> np.dtype[Any]:
        return np.dtype(self._readers.order + FORMATS[kind])


class TextsReader:
    """Reads arrays of texts.

    Args:
        readers: say how they are written.
    """

    def __init__(self, readers: Readers) -> None:
        self._length = struct.Struct(readers.order + FORMATS[_COUNT]).unpack_from
        self._aligned = readers.aligned

    def __call__(self, data: memoryview, at: int, count: int) -> tuple[list[str], int]:
        """Return the texts that begin somewhere, and where they end.

        Raises:
            DecodeError: there are fewer than `count`, or one is longer than it can be.
        """
        if count * size_of(TEXT) > len(data) - at:
            _too_many()
        found: list[str] = []
        for _ in range(count):
            if self._aligned:
                at = (at + 3) & -4
            (length,) = self._length(data, at)
            end = at + size_of(TEXT) + length
            has_end = length and end <= len(data) and not data[end - 1]
            if end > len(data) or (self._aligned and not has_end):
                _bad_text(end > len(data))
            found.append(str(data[at + 4 : end - self._aligned], "utf-8"))
            at = end
        return found, at


def _too_many() -> NoReturn:
    raise DecodeError("an array longer than its message")


def _bad_text(is_long: bool) -> NoReturn:
    if is_long:
        raise DecodeError("a text longer than its message")
    raise DecodeError("it is cut off or of another type")
