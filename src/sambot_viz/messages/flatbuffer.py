"""Read messages in FlatBuffers by the binary schema (.bfbs) of their channel.

The package of Google reads only types that its compiler has made code of, and trusts
every offset; here the schema is read when a channel comes, and every offset is checked.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

import numpy as np

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.messages.decoder import Decoder, Payload
from sambot_viz.messages.kept_elements import KeptElements
from sambot_viz.messages.plain_fields import within_limit
from sambot_viz.messages.schema import Schema

_NUMBERS = ("?", "b", "B", "h", "H", "i", "I", "q", "Q", "f", "d")
"""Letters of numbers by their base type less two, from Bool to Double."""
_BOOL, _DOUBLE, _STRING, _VECTOR, _TABLE, _ARRAY = 2, 12, 13, 14, 15, 17
"""Base types; those of numbers lie between the first two."""
_REALS = (11, 12)

Read = Callable[["FlatBufferReading", int], Any]


class FlatBufferDecoder(Decoder):
    """Reads the messages of one type.

    Args:
        schema: with the binary schema.

    Raises:
        DecodeError: it does not describe the type.
    """

    def __init__(self, schema: Schema) -> None:
        super().__init__(schema.name, "flatbuffer")
        data = schema.text
        if not isinstance(data, bytes) or not data:
            raise DecodeError("its messages are flatbuffer, and have no schema")
        if len(data) > limits.DEFINITION.value:
            raise DecodeError(f"its schema has {limits.DEFINITION.said(len(data))}")
        try:
            self._types = _types_of(data)
        except (DecodeError, struct.error, ValueError):
            raise DecodeError("its flatbuffer schema is damaged") from None
        if schema.name not in self._types:
            raise DecodeError(f"its flatbuffer schema does not describe {schema.name}")

    def decode(
        self, payload: Payload, kept: KeptElements | None = None
    ) -> dict[str, Any]:
        """Return the fields of a message, with defaults for those not set."""
        reading = FlatBufferReading(within_limit(payload))
        try:
            return self._types[self.type_name].read(reading, reading.jump(0))
        except (struct.error, ValueError):
            raise DecodeError("it is cut off or of another type") from None


class FlatBufferReading:
    """One message that is read, with what may still be read of it.

    Args:
        data: the message.
    """

    def __init__(self, data: bytes | memoryview) -> None:
        self.data = data
        self.depth = 0
        self._left = limits.FLAT_SHARED.value * len(data)

    def number(self, letter: str, at: int) -> Any:
        """Return a number; `struct` would count a negative place from the end."""
        if at < 0:
            raise DecodeError("it refers to what is not in it")
        return struct.unpack_from(f"<{letter}", self.data, at)[0]

    def jump(self, at: int) -> int:
        """Return where an offset leads to."""
        return at + self.number("I", at)

    def take(self, count: int) -> None:
        """Count the parts that are read: a message with circular parts never ends."""
        self._left -= count
        if self._left < 0:
            raise DecodeError("its parts are each other")

    def place(self, table: int, slot: int) -> int:
        """Return the position of a field of a table; 0 if it is not set."""
        vtable = table - self.number("i", table)
        entry = 4 + 2 * slot
        if entry + 2 > self.number("H", vtable):
            return 0
        offset = self.number("H", vtable + entry)
        return table + offset if offset else 0

    def text(self, at: int) -> str:
        """Return a text that an offset leads to."""
        at = self.jump(at)
        end = at + 4 + self.number("I", at)
        if end > len(self.data):
            raise DecodeError("a text longer than its message")
        self.take(end - at)
        return str(self.data[at + 4 : end], "utf-8")

    def vector(self, at: int) -> tuple[int, int]:
        """Return where the elements of a vector begin, and how many there are."""
        at = self.jump(at)
        count = self.number("I", at)
        self.take(count)
        return at + 4, count


class _Type:
    """A table or struct of the schema.

    Attributes:
        size: of a struct [bytes]; 0 for a table.
        fields: name, place (the slot in a table, the offset in a struct), how it is
            read, and what it is when it is not set.
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.fields: list[tuple[str, int, Read, Any]] = []

    def read(self, reading: FlatBufferReading, at: int) -> dict[str, Any]:
        """Return the fields of the table at a position."""
        reading.take(len(self.fields))
        reading.depth += 1
        if reading.depth > limits.FIELDS_DEPTH.value:
            most = limits.FIELDS_DEPTH.value
            raise DecodeError(f"its fields are nested too deeply: more than {most}")
        found: dict[str, Any] = {}
        for name, place, read, default in self.fields:
            where = at + place if self.size else reading.place(at, place)
            value = read(reading, where) if where else default
            if value is not None:
                found[name] = value
        reading.depth -= 1
        return found

    def read_inner(self, reading: FlatBufferReading, at: int) -> dict[str, Any]:
        """Return the fields of one that is in another, or that an offset leads to."""
        return self.read(reading, at if self.size else reading.jump(at))


# the schema, which is a message in FlatBuffers itself


def _types_of(data: bytes) -> dict[str, _Type]:
    """Return the types that a binary schema has, by their names."""
    schema = FlatBufferReading(data)
    tables = _tables(schema, schema.jump(0), 0)
    if len(tables) > limits.DEFINITION_TYPES.value:
        raise DecodeError("it has too many types")
    listed: list[tuple[str, _Type]] = []
    for table in tables:
        is_struct = _number(schema, table, 2, "?")
        size = _number(schema, table, 4, "i") if is_struct else 0
        listed.append((schema.text(_required(schema, table, 0)), _Type(size)))
    types = [one for _, one in listed]
    for table, one in zip(tables, types, strict=True):
        for field in _tables(schema, table, 1):
            name = schema.text(_required(schema, field, 0))
            kind = schema.jump(_required(schema, field, 1))
            read, default = _reader(schema, kind, types), None
            if read is None:
                continue
            base = _number(schema, kind, 0, "b")
            if base <= _DOUBLE and not _number(schema, field, 11, "?"):
                is_real = base in _REALS
                default = _number(schema, field, *((5, "d") if is_real else (4, "q")))
            place = _number(schema, field, 3 if one.size else 2, "H")
            one.fields.append((name, place, read, default))
    return dict(listed)


def _reader(schema: FlatBufferReading, kind: int, types: list[_Type]) -> Read | None:
    """Return the reader of a field; None for unions and unknown types."""
    base = int(_number(schema, kind, 0, "b"))
    element = int(_number(schema, kind, 1, "b"))
    index = int(_number(schema, kind, 2, "i", -1))
    if _BOOL <= base <= _DOUBLE:
        letter = _NUMBERS[base - _BOOL]
        return lambda reading, at: reading.number(letter, at)
    if base == _STRING:
        return FlatBufferReading.text
    if base == _TABLE and 0 <= index < len(types):
        return types[index].read_inner
    if base == _ARRAY and _BOOL <= element <= _DOUBLE:
        count, dtype = int(_number(schema, kind, 3, "H")), _dtype(element)
        return lambda reading, at: np.frombuffer(reading.data, dtype, count, at)
    if base != _VECTOR:
        return None
    if _BOOL <= element <= _DOUBLE:
        return _numbers_reader(_dtype(element))
    if element == _STRING:
        return _list_reader(FlatBufferReading.text, 4)
    if element == _TABLE and 0 <= index < len(types):
        inner = types[index]
        return _list_reader(inner.read_inner, inner.size or 4)
    return None


def _dtype(base: int) -> np.dtype[Any]:
    return np.dtype(f"<{_NUMBERS[base - _BOOL]}")


def _numbers_reader(dtype: np.dtype[Any]) -> Read:
    def read(reading: FlatBufferReading, at: int) -> Any:
        begin, count = reading.vector(at)
        return np.frombuffer(reading.data, dtype, count, begin)

    return read


def _list_reader(read_one: Read, step: int) -> Read:
    def read(reading: FlatBufferReading, at: int) -> list[Any]:
        begin, count = reading.vector(at)
        if begin + step * count > len(reading.data):
            raise DecodeError("an array longer than its message")
        return [read_one(reading, begin + step * number) for number in range(count)]

    return read


def _number(
    schema: FlatBufferReading, table: int, slot: int, letter: str, default: int = 0
) -> Any:
    place = schema.place(table, slot)
    return schema.number(letter, place) if place else default


def _required(schema: FlatBufferReading, table: int, slot: int) -> int:
    place = schema.place(table, slot)
    if not place:
        raise DecodeError("it lacks a part")
    return place


def _tables(schema: FlatBufferReading, table: int, slot: int) -> list[int]:
    """Return where the tables of a vector are; none where it is not set."""
    place = schema.place(table, slot)
    if not place:
        return []
    begin, count = schema.vector(place)
    return [schema.jump(begin + 4 * number) for number in range(count)]
