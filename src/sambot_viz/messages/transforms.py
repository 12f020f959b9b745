"""The one type that has a decoder by hand: transforms, which come by the thousand."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sambot_viz.errors import DecodeError
from sambot_viz.messages.decoder import Payload

Edges = tuple[tuple[str, str], ...]
"""(parent, child) of each transform."""
Transforms = tuple[int, Edges, NDArray[np.float64]]
"""Stamp [ns], the frames, and their (N, 7) poses: x, y, z and quaternion x, y, z, w."""

_MOST_KEPT = 512
"""So many lists of frames are kept; each publisher has one or two."""


class TransformDecoder:
    """Reads tf2_msgs/msg/TFMessage, and tf/tfMessage of ROS 1.

    Messages with the same frames give the same `edges` object again, so that whoever
    takes them can know them by it.

    Args:
        message_encoding: "cdr" or "ros1".
    """

    def __init__(self, message_encoding: str) -> None:
        self._is_ros1 = message_encoding == "ros1"
        self._edges: dict[Edges, Edges] = {}

    def decode(self, payload: Payload) -> list[Transforms]:
        """Return the transforms of a message, one entry for each stamp in it.

        Raises:
            DecodeError: the bytes are no such message.
        """
        try:
            rows = _Ros1(payload) if self._is_ros1 else _Cdr(payload)
            return self._grouped(rows.read())
        except (struct.error, UnicodeDecodeError):
            raise DecodeError("it is cut off or of another type") from None

    def _grouped(self, rows: list[_Row]) -> list[Transforms]:
        stamps: dict[int, list[_Row]] = {}
        for row in rows:
            stamps.setdefault(row[0], []).append(row)
        found: list[Transforms] = []
        for stamp, some in stamps.items():
            edges = tuple((row[1], row[2]) for row in some)
            if len(self._edges) > _MOST_KEPT:
                self._edges.clear()
            edges = self._edges.setdefault(edges, edges)
            poses = np.array([row[3] for row in some], dtype=np.float64)
            found.append((stamp, edges, poses))
        return found


_Row = tuple[int, str, str, Any]


class _Cdr:
    """A reader of CDR: all is aligned to its size, texts end with a zero."""

    def __init__(self, payload: Payload) -> None:
        head = bytes(payload[:2])
        if len(payload) < 4 or head not in (b"\0\0", b"\0\1"):
            raise DecodeError(f"it begins with {head.hex() or 'nothing'}, not CDR")
        order = "<" if head[1] else ">"
        self._data = bytes(memoryview(payload)[4:])
        self._length = struct.Struct(order + "I").unpack_from
        self._stamp = struct.Struct(order + "iI").unpack_from
        self._pose = struct.Struct(order + "7d").unpack_from

    def read(self) -> list[_Row]:
        data, position, rows = self._data, 4, list[_Row]()
        for _ in range(_checked(self._length(data, 0)[0], data)):
            position = (position + 3) & -4
            sec, nanosec = self._stamp(data, position)
            parent, position = self._text(position + 8)
            child, position = self._text((position + 3) & -4)
            position = (position + 7) & -8
            pose = self._pose(data, position)
            position += 56
            rows.append((sec * 10**9 + nanosec, parent, child, pose))
        return rows

    def _text(self, position: int) -> tuple[str, int]:
        end = position + 4 + self._length(self._data, position)[0]
        if end > len(self._data):
            raise DecodeError("a text longer than its message")
        return self._data[position + 4 : end].rstrip(b"\0").decode(), end


class _Ros1:
    """A reader of ROS 1: nothing is aligned, headers have a number."""

    def __init__(self, payload: Payload) -> None:
        self._data = bytes(payload)
        self._length = struct.Struct("<I").unpack_from
        self._stamp = struct.Struct("<4xII").unpack_from
        self._pose = struct.Struct("<7d").unpack_from

    def read(self) -> list[_Row]:
        data, position, rows = self._data, 4, list[_Row]()
        for _ in range(_checked(self._length(data, 0)[0], data)):
            sec, nanosec = self._stamp(data, position)
            parent, position = self._text(position + 12)
            child, position = self._text(position)
            pose = self._pose(data, position)
            position += 56
            rows.append((sec * 10**9 + nanosec, parent, child, pose))
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
