"""Read CBOR (RFC 8949): bytes stay views, arrays of numbers (RFC 8746) numpy's.

No length of the peer is trusted: what it announces must be there.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from sambot_viz import limits

_FLOATS = {25: struct.Struct(">e"), 26: struct.Struct(">f"), 27: struct.Struct(">d")}
_SIMPLE = {20: False, 21: True, 22: None, 23: None}
_ARRAYS = {
    **{64 + number: f">u{1 << number}" for number in range(4)},
    68: "u1",
    **{68 + number: f"<u{1 << number}" for number in range(1, 4)},
    **{72 + number: f">i{1 << number}" for number in range(4)},
    **{76 + number: f"<i{1 << number}" for number in range(1, 4)},
    **{80 + number: f">f{2 << number}" for number in range(3)},
    **{84 + number: f"<f{2 << number}" for number in range(3)},
}
"""Tags of arrays of numbers → numpy's type of their elements."""
_T = TypeVar("_T")
_BREAK = 0xFF
_ENDLESS = 31

Value = (
    int
    | float
    | str
    | bool
    | memoryview
    | list["Value"]
    | dict["Value", "Value"]
    | npt.NDArray[Any]
    | None
)


class CborError(ValueError):
    """Bytes that are not CBOR, or not as many as they announce."""


class CborTooDeep(CborError):
    """More values are in values than are read."""


def read_cbor(frame: bytes | memoryview) -> Value:
    """Return the value that a frame holds; arrays of bytes are views of it.

    Raises:
        CborError: it is cut, nested too deeply, or not CBOR.
    """
    reader = _CborReader(memoryview(frame))
    value = reader.value(0)
    if reader.at != len(frame):
        raise CborError(f"{len(frame) - reader.at} bytes are left over")
    return value


class _CborReader:
    def __init__(self, view: memoryview) -> None:
        self.view = view
        self.at = 0

    def take(self, count: int) -> memoryview:
        end = self.at + count
        if end > len(self.view):
            raise CborError(f"{count} bytes are announced, {end - self.at} are there")
        taken = self.view[self.at : end]
        self.at = end
        return taken

    def value(self, depth: int) -> Value:
        if depth > limits.FIELDS_DEPTH.value:
            most = limits.FIELDS_DEPTH.value
            raise CborTooDeep(f"with values in values, more than {most} deep")
        first = self.take(1)[0]
        major, short = first >> 5, first & 31
        if major == 7:
            return self.simple(short)
        if short == _ENDLESS:
            return self.endless(major, depth)
        return self.sized(major, self.number(short), depth)

    def number(self, short: int) -> int:
        if short < 24:
            return short
        if short > 27:
            raise CborError(f"a length of kind {short}")
        return int.from_bytes(self.take(1 << (short - 24)), "big")

    def sized(self, major: int, number: int, depth: int) -> Value:
        if major == 0:
            return number
        if major == 1:
            return -1 - number
        if major == 2:
            return self.take(number)
        if major == 3:
            return self.string(self.take(number))
        if major == 6:  # a tag says how to understand what follows
            return _tagged(number, self.value(depth + 1))
        # Each entry takes a byte at least.
        if number > len(self.view) - self.at:
            raise CborError(f"{number} entries are announced")
        if major == 4:
            return [self.value(depth + 1) for _ in range(number)]
        return dict(self.pair(depth) for _ in range(number))

    def endless(self, major: int, depth: int) -> Value:
        if major == 4:
            return list(self.until_break(lambda: self.value(depth + 1)))
        if major == 5:
            return dict(self.until_break(lambda: self.pair(depth)))
        parts = self.until_break(lambda: self.value(depth + 1))
        if major == 2 and all(isinstance(part, memoryview) for part in parts):
            return memoryview(b"".join(p for p in parts if isinstance(p, memoryview)))
        if major == 3 and all(isinstance(part, str) for part in parts):
            return "".join(part for part in parts if isinstance(part, str))
        raise CborError(f"an endless value of kind {major}")

    def until_break(self, entry: Callable[[], _T]) -> list[_T]:
        found: list[_T] = []
        while self.at < len(self.view) and self.view[self.at] != _BREAK:
            found.append(entry())
        self.take(1)
        return found

    def pair(self, depth: int) -> tuple[Value, Value]:
        key = self.value(depth + 1)
        if not isinstance(key, str | int | float | None):
            raise CborError("a key is not a text or a number")
        return key, self.value(depth + 1)

    def simple(self, short: int) -> Value:
        if short in _FLOATS:
            layout = _FLOATS[short]
            return float(layout.unpack(self.take(layout.size))[0])
        if short in _SIMPLE:
            return _SIMPLE[short]
        raise CborError(f"a simple value {short}")

    def string(self, view: memoryview) -> str:
        try:
            return str(view, "utf-8")
        except UnicodeDecodeError as error:
            raise CborError("a text is not UTF-8") from error


def _tagged(tag: int, value: Value) -> Value:
    """Return a value as its tag says it is to be understood."""
    kind = _ARRAYS.get(tag)
    if kind is None or not isinstance(value, memoryview):
        return value
    if len(value) % np.dtype(kind).itemsize:
        raise CborError(f"{len(value)} bytes are no array of the tag {tag}")
    return np.frombuffer(value, kind)
