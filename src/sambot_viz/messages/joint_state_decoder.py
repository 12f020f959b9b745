"""Read sensor_msgs/JointState messages that name the joints of the one before."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from sambot_viz.errors import DecodeError
from sambot_viz.messages.cdr import HEAD, CdrReader
from sambot_viz.messages.decoder import Payload

_BEHIND_STAMP = 8


class JointStateTemplate:
    """A decoded message, by which others with the same names are read.

    A message of as many bytes that has the same ones between its stamp and its first
    position has other numbers, and nothing else.

    Attributes:
        names: of the joints.
    """

    def __init__(
        self, data: bytes, order: str, begin: int, names: Sequence[str]
    ) -> None:
        self.names = tuple(names)
        self._length = len(data)
        self._begin = begin
        self._number = np.dtype(order + "f8")
        self._head = data[:HEAD]
        self._same = data[HEAD + _BEHIND_STAMP : begin]

    @classmethod
    def of(
        cls, payload: Payload, names: Sequence[str], positions: Sequence[float]
    ) -> JointStateTemplate | None:
        """Return the template of a message.

        Args:
            payload: the message.
            names: the names that a decoder has found in it.
            positions: the positions that it has found, one for each name [rad or m].

        Returns:
            None if its fields are at other positions, or if it has no joints.
        """
        data = bytes(payload)
        if not names or len(names) != len(positions):
            return None
        try:
            cdr = CdrReader(data)
            begin = _first_position(cdr, names)
        except (DecodeError, UnicodeDecodeError, struct.error):
            return None
        if begin is None or begin + 8 * len(names) > len(data):
            return None
        template = cls(data, cdr.order, begin, names)
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
        same = data[HEAD + _BEHIND_STAMP : self._begin] == self._same
        if not same or data[:HEAD] != self._head:
            return None
        return np.frombuffer(data, self._number, len(self.names), self._begin)


def _first_position(cdr: CdrReader, names: Sequence[str]) -> int | None:
    """Return the start of the positions in a message; None if it is no JointState."""
    _, at = cdr.text(_BEHIND_STAMP)
    at = cdr.aligned(at, 4)
    if cdr.length(at) != len(names):
        return None
    at += 4
    for name in names:
        word, at = cdr.text(cdr.aligned(at, 4))
        if word != name:
            return None
    at = cdr.aligned(at, 4)
    if cdr.length(at) != len(names):
        return None
    return HEAD + cdr.aligned(at + 4, 8)
