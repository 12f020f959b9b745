"""Read sensor_msgs/JointState messages that name the joints of the one before."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from sambot_viz.messages.decoder import Payload

_CDR = b"\x00\x01"
"""Little-endian, without parameters."""
_BODY, _BEHIND_STAMP = 4, 12
"""Where the fields begin, and where those behind the stamp do."""
_COUNT = struct.Struct("<I")


class JointStateTemplate:
    """A decoded message, by which others with the same names are read.

    A message of as many bytes that has the same ones between its stamp and its first
    position has other numbers, and nothing else.

    Attributes:
        names: of the joints.
    """

    def __init__(self, data: bytes, begin: int, names: Sequence[str]) -> None:
        self.names = tuple(names)
        self._length = len(data)
        self._begin = begin
        self._head = data[:_BODY]
        self._same = data[_BEHIND_STAMP:begin]

    @classmethod
    def of(
        cls, payload: Payload, names: Sequence[str], positions: Sequence[float]
    ) -> JointStateTemplate | None:
        """Return the template of a message.

        Args:
            payload: the message.
            names: what a decoder has found in it.
            positions: as many numbers, found so as well [rad or m].

        Returns:
            None: its fields are at other places, or it has no joints.
        """
        data = bytes(payload)
        if not names or len(names) != len(positions) or data[:2] != _CDR:
            return None
        try:
            begin = _first_position(data, names)
        except struct.error:
            return None
        if begin < 0:
            return None
        template = cls(data, begin, names)
        found = template.read(data)
        wanted = np.asarray(positions, np.float64)
        if found is None or not np.array_equal(found, wanted, equal_nan=True):
            return None
        return template

    def read(self, payload: Payload) -> NDArray[np.float64] | None:
        """Return the positions of a message in the order of `names` [rad or m].

        Returns:
            None: it has other names, or more of something; it has to be decoded.
        """
        if len(payload) != self._length:
            return None
        data = bytes(payload)
        same = data[_BEHIND_STAMP : self._begin] == self._same
        if not same or data[:_BODY] != self._head:
            return None
        return np.frombuffer(data, "<f8", len(self.names), self._begin)


def _first_position(data: bytes, names: Sequence[str]) -> int:
    """Return where the positions of a message begin; -1 when it is no JointState.

    Raises:
        struct.error: it is too short.
    """
    at = _BEHIND_STAMP
    at = _aligned(at + _COUNT.size + _count(data, at), 4)
    if _count(data, at) != len(names):
        return -1
    at += _COUNT.size
    for name in names:
        at = _aligned(at, 4)
        length = _count(data, at)
        at += _COUNT.size + length
        if data[at - length : at].rstrip(b"\x00") != name.encode():
            return -1
    at = _aligned(at, 4)
    if _count(data, at) != len(names):
        return -1
    begin = _aligned(at + _COUNT.size, 8)
    return begin if begin + 8 * len(names) <= len(data) else -1


def _count(data: bytes, at: int) -> int:
    number: int = _COUNT.unpack_from(data, at)[0]
    return number


def _aligned(at: int, size: int) -> int:
    return at + (_BODY - at) % size
