"""Read foxglove.FrameTransforms in Protobuf without an object for each field.

Google's package makes an object of each field, and reading them takes 8 µs for each
transform. A publisher sends the same frames repeatedly, so that its messages differ
only in their stamps and poses: the first one of a length is parsed by the descriptor
and gives a template, as in CDR. Other layouts are left to the package.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from sambot_viz.messages.decoder import Edges, Payload, ReadTransforms
from sambot_viz.messages.templates import Templates

if TYPE_CHECKING:
    from google.protobuf.descriptor import Descriptor

_FEWEST = 6
"""Fewer transforms are read by the package in less time."""
_LARGEST = 1 << 20
"""Longer messages are read by the package [bytes]."""
_VARINT, _FIXED, _LENGTH = 0, 1, 2
"""Wire types of Protobuf: a number of some bytes, one of eight bytes, and a length."""
_LONGEST_VARINT = 5
_PADDING = 8
"""Zeros after a message, where missing numbers are read."""
_SECOND = 1_000_000_000
_POSE = (
    *(("translation", axis) for axis in "xyz"),
    *(("rotation", axis) for axis in "xyzw"),
)


class _OtherLayoutError(Exception):
    """A message that only the package can read."""


class ProtobufTransforms:
    """Reads the messages of one channel.

    Args:
        descriptor: of foxglove.FrameTransforms, as the channel has it.
    """

    def __init__(self, descriptor: Descriptor) -> None:
        self._templates = Templates[int, _Template]()
        self._numbers = _numbers_of(descriptor)

    def read(self, payload: Payload) -> ReadTransforms | None:
        """Return the transforms of a message; None where the package is to read it."""
        data = bytes(payload)
        if self._numbers is None or len(data) > _LARGEST:
            return None
        for template in self._templates.of(len(data)):
            if (found := template.read(data)) is not None:
                return found
        try:
            template = _Template(data, self._numbers)
        except (_OtherLayoutError, IndexError, UnicodeDecodeError):
            return None
        if len(template.edges) < _FEWEST:
            return None
        self._templates.keep(len(data), template, len(data))
        return template.read(data)


_Numbers = dict[tuple[str, ...], int]
"""The path of a field, by names → its number."""


def _numbers_of(descriptor: Descriptor) -> _Numbers | None:
    """Return the numbers of the fields that are read; None for another schema."""
    numbers: _Numbers = {}
    waiting: list[tuple[tuple[str, ...], Descriptor]] = [((), descriptor)]
    while waiting:
        path, kind = waiting.pop()
        for field in kind.fields:
            here = (*path, field.name)
            if field.is_repeated != (here == ("transforms",)) or len(here) > 3:
                return None
            numbers[here] = field.number
            if field.message_type is not None:
                waiting.append((here, field.message_type))
    wanted = {("transforms", *path) for path in _PATHS}
    return numbers if wanted == numbers.keys() - {("transforms",)} else None


_PATHS = {
    ("timestamp",),
    ("timestamp", "seconds"),
    ("timestamp", "nanos"),
    ("parent_frame_id",),
    ("child_frame_id",),
    ("translation",),
    ("rotation",),
    *_POSE,
}


class _Template:
    """The layout of messages that have the same frames.

    Args:
        data: one of them.
        numbers: of the fields.

    Raises:
        _OtherLayoutError: it has more, or less, than transforms usually have.
        IndexError: it is cut off.
    """

    def __init__(self, data: bytes, numbers: _Numbers) -> None:
        self._paths = {(path[:-1], number): path for path, number in numbers.items()}
        self._mask = np.full(len(data) + _PADDING, 255, np.uint8)
        places: list[list[int]] = []
        stamps: list[list[int]] = []
        edges: list[tuple[str, str]] = []
        for begin, end in self._children(data, 0, len(data)):
            found = dict(self._fields(data, begin, end, ("transforms",)))
            if not found.keys() >= {("timestamp",), ("translation",), ("rotation",)}:
                raise _OtherLayoutError
            texts = (found.get((f"{end}_frame_id",)) for end in ("parent", "child"))
            parent, child = (
                "" if text is None else data[slice(*text)].decode() for text in texts
            )
            edges.append((parent, child))
            places.append([self._number(found.get(path), data) for path in _POSE])
            stamps += (
                self._varint(found.get(("timestamp", part)), data)
                for part in ("seconds", "nanos")
            )
        self.edges: Edges = tuple(edges)
        padded = np.frombuffer(data + bytes(_PADDING), np.uint8)
        self._constant = (padded & self._mask).tobytes()
        begins = np.reshape(np.array(places, np.intp), (-1, 7, 1))
        self._doubles = begins + np.arange(8)
        parts = np.array(stamps, np.intp)
        self._stamps = np.reshape(parts, (-1, 2, _LONGEST_VARINT))

    def read(self, data: bytes) -> ReadTransforms | None:
        """Return the transforms of a message as long; None when it has other frames."""
        padded = np.frombuffer(data + bytes(_PADDING), np.uint8)
        if (padded & self._mask).tobytes() != self._constant:
            return None
        parts = (padded[self._stamps] & 127).astype(np.int64) @ _WEIGHTS
        if (parts >= _LIMITS).any():
            return None
        poses = np.frombuffer(padded[self._doubles].tobytes(), "<f8")
        times = (parts[:, 0] * _SECOND + parts[:, 1]).tolist()
        return times, self.edges, np.reshape(poses.astype(np.float64), (-1, 7))

    def _children(self, data: bytes, begin: int, end: int) -> Iterator[tuple[int, int]]:
        for path, wire, first, last in self._walk(data, begin, end, ()):
            if path != ("transforms",) or wire != _LENGTH:
                raise _OtherLayoutError
            yield first, last

    def _fields(
        self, data: bytes, begin: int, end: int, above: tuple[str, ...]
    ) -> Iterator[tuple[tuple[str, ...], tuple[int, int]]]:
        """Yield the paths below a transform, and where their values are."""
        seen: set[tuple[str, ...]] = set()
        for path, wire, first, last in self._walk(data, begin, end, above):
            here = path[1:]
            is_text = here[0].endswith("_frame_id")
            is_number = len(here) == 2
            wanted = _LENGTH
            if is_number:
                wanted = _VARINT if here[0] == "timestamp" else _FIXED
            if path in seen or wire != wanted:
                # What comes twice is joined by rules that the package knows.
                raise _OtherLayoutError
            seen.add(path)
            yield here, (first, last)
            if not is_text and not is_number:
                yield from self._fields(data, first, last, path)

    def _walk(
        self, data: bytes, begin: int, end: int, above: tuple[str, ...]
    ) -> Iterator[tuple[tuple[str, ...], int, int, int]]:
        """Yield path, wire type, and begin and end of the value of each field."""
        while begin < end:
            key, begin = _varint_of(data, begin)
            path, wire = self._paths.get((above, key >> 3)), key & 7
            if path is None:
                raise _OtherLayoutError
            if wire == _LENGTH:
                size, begin = _varint_of(data, begin)
                after = begin + size
            elif wire == _FIXED:
                after = begin + 8
            elif wire == _VARINT:
                after = _varint_of(data, begin)[1]
            else:
                raise _OtherLayoutError
            if after > end:
                raise _OtherLayoutError
            yield path, wire, begin, after
            begin = after

    def _number(self, place: tuple[int, int] | None, data: bytes) -> int:
        """Return the position of a number; a missing one is read from the zeros."""
        if place is None:
            return len(data)
        self._mask[slice(*place)] = 0
        return place[0]

    def _varint(self, place: tuple[int, int] | None, data: bytes) -> list[int]:
        """Return where the bytes of a number are; how many it has stays the same."""
        bytes_of = range(*place) if place is not None else range(0)
        if len(bytes_of) > _LONGEST_VARINT:
            raise _OtherLayoutError
        self._mask[bytes_of.start : bytes_of.stop] = 128
        return [*bytes_of, *[len(data)] * (_LONGEST_VARINT - len(bytes_of))]


_LIMITS = np.array([1 << 31, _SECOND])
"""Seconds and nanoseconds that a stamp of ROS has not."""
_WEIGHTS = 128 ** np.arange(_LONGEST_VARINT, dtype=np.int64)


def _varint_of(data: bytes, begin: int) -> tuple[int, int]:
    """Return a number, and where what follows it begins."""
    value = 0
    for shift in range(0, 70, 7):
        byte = data[begin]
        begin += 1
        value |= (byte & 127) << shift
        if byte < 128:
            return value, begin
    raise _OtherLayoutError
