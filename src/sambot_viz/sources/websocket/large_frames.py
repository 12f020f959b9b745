"""Takes frames that are too large out of a stream of websocket frames.

websockets ends the connection at such a frame. Here the rest of it is thrown away as it
comes, and the connection goes on: only the message is lost.
"""

from __future__ import annotations

from collections.abc import Callable

HEAD = 1024
"""What is kept of a frame that is too large: it says what the frame is of [bytes]."""
_SENSIBLE = 16
"""A frame of more limits than this would take too long: it ends the connection."""
_ACCEPTED = b"HTTP/1.1 101"
_WHOLE = (0x81, 0x82)
"""First byte of a text and of a binary message that is one frame."""


class LargeFrames:
    """A filter of what a server sends, without masks and without compression.

    Args:
        most: the largest frame that goes through [bytes].
        found: called with the first bytes and the size of each other one.
    """

    def __init__(self, most: int, found: Callable[[bytes, int], object]) -> None:
        self._most = most
        self._found = found
        self._has_begun = False
        # The beginning of what is not long enough to say what it is.
        self._held = b""
        # How much of a frame is still to come: it goes through, or is thrown away.
        self._through = self._thrown = self._size = 0
        self._head = bytearray()

    def filtered(self, data: bytes) -> bytes:
        """Return the part of what has come that goes through."""
        if self._held:
            data, self._held = self._held + data, b""
        at = 0
        if not self._has_begun:
            at = self._after_answer(data)
            if at < 0:
                return b""
        parts: list[bytes] = []
        begin = 0
        while at < len(data):
            if self._thrown:
                at = begin = self._throw(data, at)
            elif self._through:
                step = min(self._through, len(data) - at)
                self._through -= step
                at += step
            elif (end := _end_of_header(data, at)) > len(data):
                self._held = data[at:]
                parts.append(data[begin:at])
                return b"".join(parts)
            else:
                size = _size(data, at, end)
                if data[at] in _WHOLE and self._is_cut(size):
                    parts.append(data[begin:at])
                    self._thrown = self._size = size
                    begin = end
                else:
                    self._through = size
                at = end
        if not parts and begin == 0:
            return data
        return b"".join([*parts, data[begin:at]])

    def _is_cut(self, size: int) -> bool:
        return self._most < size <= _SENSIBLE * self._most

    def _after_answer(self, data: bytes) -> int:
        """Return where the frames begin; -1 while the server has not answered yet."""
        end = data.find(b"\r\n\r\n")
        if data.startswith(_ACCEPTED[: len(data)]) and end < 0:
            self._held = data
            return -1
        self._has_begun = True
        if not data.startswith(_ACCEPTED):
            # There will be no frames.
            self._through = 2**63
            return 0
        return end + 4

    def _throw(self, data: bytes, at: int) -> int:
        """Throw away what has come of a frame; returns where its part ends."""
        step = min(self._thrown, len(data) - at)
        if len(self._head) < HEAD:
            self._head += data[at : at + min(step, HEAD - len(self._head))]
        self._thrown -= step
        if not self._thrown:
            head, self._head = bytes(self._head), bytearray()
            self._found(head, self._size)
        return at + step


def _end_of_header(data: bytes, at: int) -> int:
    """Return where the header of the frame at a place ends; it may not be there yet."""
    if at + 1 >= len(data):
        return at + 2
    return at + 2 + {126: 2, 127: 8}.get(data[at + 1], 0)


def _size(data: bytes, at: int, end: int) -> int:
    """Return how much a frame holds [bytes]."""
    length = data[at + 1] & 127
    return int.from_bytes(data[at + 2 : end], "big") if length > 125 else length
