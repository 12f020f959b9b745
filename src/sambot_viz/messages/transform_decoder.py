"""The one type that has a decoder by hand: transforms, which come by the thousand.

A publisher sends the same frames again and again, so that its messages differ in their
stamps and poses alone. The first one is read field by field and leaves a template; the
next ones are compared with it and give their numbers by two look-ups in numpy.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sambot_viz.errors import DecodeError
from sambot_viz.messages.cdr import CdrReader
from sambot_viz.messages.decoder import Edges, Payload, ReadTransforms
from sambot_viz.messages.templates import Templates

Transforms = tuple[int, Edges, NDArray[np.float64]]
"""Stamp [ns], the frames, and their (N, 7) poses: x, y, z and quaternion x, y, z, w."""
_MOST_KEPT = 20_000
"""Maximum number of cached transform lists; each publisher has one or two."""
_FEWEST_ROWS = 6
"""Fewer transforms are read field by field in less time."""
_LARGEST_TEMPLATE = 1 << 21
"""Bytes of a message; a template has twice as many."""
_NUMBERS = attrgetter(
    *(f"translation.{axis}" for axis in "xyz"), *(f"rotation.{axis}" for axis in "xyzw")
)
_PADDING = 3
_ZEROS = 8
"""The zeros that rclpy.serialize_message adds after a message."""


class TransformDecoder:
    """Reads tf2_msgs/msg/TFMessage, and tf/tfMessage of ROS 1.

    Messages with the same frames give the same `edges` object again, by which callers
    can recognise them.

    Args:
        message_encoding: "cdr" or "ros1"; for others transforms are only sorted.

    Attributes:
        is_fast: whether the encoding is one of these.
    """

    def __init__(self, message_encoding: str) -> None:
        self.is_fast = message_encoding in ("cdr", "ros1")
        self._is_ros1 = message_encoding == "ros1"
        self._edges: dict[Edges, Edges] = {}
        self._edges_kept = 0
        self._templates = Templates[tuple[int, int], _TransformTemplate]()

    def decode(self, payload: Payload) -> list[Transforms]:
        """Return the transforms of a message, one entry for each stamp in it.

        Raises:
            DecodeError: the bytes are no such message.
        """
        data = bytes(payload)
        key = len(data), 0 if self._is_ros1 or not data[1:] else data[1]
        for template in self._templates.of(key):
            if (found := template.read(data)) is not None:
                stamps, poses = found
                return self._split(stamps, template.edges, poses)
        try:
            rows = _Ros1(data) if self._is_ros1 else _Cdr(data)
            read = rows.read()
        except (struct.error, UnicodeDecodeError):
            raise DecodeError("it is cut off or of another type") from None
        edges = self._one(tuple((row[1], row[2]) for row in read))
        if len(read) >= _FEWEST_ROWS and len(data) <= _LARGEST_TEMPLATE:
            template = _TransformTemplate(data, rows, edges)
            self._templates.keep(key, template, len(data))
        poses = np.array([row[3] for row in read], dtype=np.float64)
        return self._split([row[0] for row in read], edges, poses)

    def sorted(self, transforms: Sequence[Any]) -> list[Transforms]:
        """Return transforms that were decoded elsewhere, an entry for each stamp.

        Args:
            transforms: of a tf2_msgs/msg/TFMessage.
        """
        edges = self._one(
            tuple((one.header.frame_id, one.child_frame_id) for one in transforms)
        )
        stamps = [
            one.header.stamp.sec * 10**9 + one.header.stamp.nanosec
            for one in transforms
        ]
        poses = [_NUMBERS(one.transform) for one in transforms]
        return self._split(stamps, edges, np.array(poses, np.float64))

    def rows(self, read: ReadTransforms) -> list[Transforms]:
        """Return transforms that were read elsewhere, an entry for each stamp."""
        stamps, edges, poses = read
        return self._split(stamps, self._one(edges), poses)

    def _split(
        self, stamps: list[int], edges: Edges, poses: NDArray[np.float64]
    ) -> list[Transforms]:
        """Return an entry for each stamp, in the order of their first rows."""
        if stamps.count(stamps[0] if stamps else 0) == len(stamps):
            return [(stamps[0], edges, poses)] if stamps else []
        rows: dict[int, list[int]] = {}
        for row, stamp in enumerate(stamps):
            rows.setdefault(stamp, []).append(row)
        return [
            (stamp, self._one(tuple(edges[row] for row in some)), poses[some])
            for stamp, some in rows.items()
        ]

    def _one(self, edges: Edges) -> Edges:
        if (known := self._edges.get(edges)) is not None:
            return known
        if self._edges_kept > _MOST_KEPT:
            self._edges.clear()
            self._edges_kept = 0
        self._edges_kept += len(edges) + 1
        return self._edges.setdefault(edges, edges)


_Row = tuple[int, str, str, Any]


class _FieldReader:
    """Reads a message field by field, and notes where its numbers are.

    Attributes:
        order: of the bytes, "<" or ">".
        sec: kind of a stamp's seconds: "i4", or "u4" in ROS 1.
        stamps: where each stamp begins.
        poses: where each pose begins.
        gaps: (begin, end) of bytes without meaning.
    """

    order: str = "<"
    sec: str = "u4"

    def __init__(self) -> None:
        self.stamps: list[int] = []
        self.poses: list[int] = []
        self.gaps: list[tuple[int, int]] = []

    def read(self) -> list[_Row]:
        raise NotImplementedError


@dataclass(frozen=True, slots=True)
class _SameBytes:
    """Which bytes are the same in all messages of a template, and these bytes."""

    mask: NDArray[np.uint8]
    constant: bytes

    @classmethod
    def of(cls, data: bytes, reader: _FieldReader) -> _SameBytes:
        mask = np.full(len(data), 255, np.uint8)
        for begin in reader.stamps:
            mask[begin : begin + 8] = 0
        for begin in reader.poses:
            mask[begin : begin + 56] = 0
        for begin, end in reader.gaps:
            mask[begin:end] = 0
        return cls(mask, (np.frombuffer(data, np.uint8) & mask).tobytes())

    def fits(self, data: bytes) -> bool:
        return (np.frombuffer(data, np.uint8) & self.mask).tobytes() == self.constant


class _TransformTemplate:
    """The layout of messages that have the same frames.

    Args:
        data: one of them.
        reader: what has read it.
        edges: its frames.
    """

    def __init__(self, data: bytes, reader: _FieldReader, edges: Edges) -> None:
        self.edges = edges
        self._pattern = _SameBytes.of(data, reader)
        self._stamps = np.array(reader.stamps, np.intp)
        self._poses = np.array(reader.poses, np.intp)
        self._seconds = np.dtype(reader.order + reader.sec)
        self._nanoseconds = np.dtype(reader.order + "u4")
        self._number = np.dtype(reader.order + "f8")

    def read(self, data: bytes) -> tuple[list[int], NDArray[np.float64]] | None:
        """Return the stamps [ns] and poses of a message as long as the first one.

        None when it has other frames.
        """
        if not self._pattern.fits(data):
            return None
        stamps = _pieces(data, 8, self._stamps)
        seconds = np.frombuffer(stamps, self._seconds)[::2].astype(np.int64)
        nanoseconds = np.frombuffer(stamps, self._nanoseconds)[1::2].astype(np.int64)
        poses = np.frombuffer(_pieces(data, 56, self._poses), self._number)
        times = (seconds * 1_000_000_000 + nanoseconds).tolist()
        return times, np.reshape(poses.astype(np.float64), (-1, 7))


def _pieces(data: bytes, size: int, places: NDArray[np.intp]) -> bytes:
    """Return the pieces of that size that begin at some bytes, one after the other."""
    # A piece begins at every byte: fields of ROS 1 are not aligned.
    begins = len(data) - size + 1
    every = np.ndarray((begins,), np.dtype((np.void, size)), data, 0, (1,))
    return every[places].tobytes()


class _Cdr(_FieldReader):
    """A reader of CDR."""

    sec = "i4"

    def __init__(self, data: bytes) -> None:
        super().__init__()
        self._cdr = CdrReader(data)
        self.order, self.gaps = self._cdr.order, self._cdr.gaps
        self._stamp = struct.Struct(self.order + "iI").unpack_from
        self._pose = struct.Struct(self.order + "7d").unpack_from

    def read(self) -> list[_Row]:
        cdr, position, rows = self._cdr, 4, list[_Row]()
        data = cdr.data
        for _ in range(_checked(cdr.length(0), data)):
            position = cdr.aligned(position, 4)
            sec, nanosec = self._stamp(data, position)
            self.stamps.append(position + 4)
            parent, position = cdr.text(position + 8)
            child, position = cdr.text(cdr.aligned(position, 4))
            position = cdr.aligned(position, 8)
            pose = self._pose(data, position)
            self.poses.append(position + 4)
            position += 56
            rows.append((sec * 10**9 + nanosec, parent, child, pose))
        left = len(data) - position
        if left > _PADDING and (left > _ZEROS or any(data[position:])):
            raise DecodeError("it is longer than its transforms")
        self.gaps.append((position + 4, position + 4 + min(left, _PADDING)))
        return rows


class _Ros1(_FieldReader):
    """A reader of ROS 1: nothing is aligned, headers have a number."""

    def __init__(self, data: bytes) -> None:
        super().__init__()
        self._data = data
        self._length = struct.Struct("<I").unpack_from
        self._stamp = struct.Struct("<4xII").unpack_from
        self._pose = struct.Struct("<7d").unpack_from

    def read(self) -> list[_Row]:
        data, position, rows = self._data, 4, list[_Row]()
        for _ in range(_checked(self._length(data, 0)[0], data)):
            sec, nanosec = self._stamp(data, position)
            # The number of the message, which nobody reads.
            self.gaps.append((position, position + 4))
            self.stamps.append(position + 4)
            parent, position = self._text(position + 12)
            child, position = self._text(position)
            pose = self._pose(data, position)
            self.poses.append(position)
            position += 56
            rows.append((sec * 10**9 + nanosec, parent, child, pose))
        if position != len(data):
            raise DecodeError("it is longer than its transforms")
        return rows

    def _text(self, position: int) -> tuple[str, int]:
        end = position + 4 + self._length(self._data, position)[0]
        if end > len(self._data):
            raise DecodeError("a text longer than its message")
        return self._data[position + 4 : end].decode(), end


def _checked(count: int, data: bytes) -> int:
    """Return how many transforms there are, each of which has 70 bytes and more."""
    if count * 70 > len(data):
        raise DecodeError("an array longer than its message")
    return count
