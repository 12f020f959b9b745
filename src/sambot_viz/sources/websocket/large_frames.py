"""Remove messages that are too large from a stream of websocket frames.

The package websockets would end the connection. Here the message is discarded as it
comes, in one frame or in several, and the connection goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

HEAD = 1024
"""Kept bytes of a message that is too large: enough to see its topic [bytes]."""
_ACCEPTED = b"HTTP/1.1 101"
_LAST, _CONTROL, _MASKED = 0x80, 0x08, 0x80
_NEXT, _TEXT, _BINARY = range(3)
_NO_SIZE = 2**63
"""No frame is so long; websockets says so [bytes]."""

OnLarge = Callable[[bytes, int, bool], object]
"""Called with the first bytes of a large message, its size and whether it is new."""


@dataclass(slots=True)
class _HeldMessage:
    """A message that comes in several frames, or is too large.

    Attributes:
        kind: text or binary.
        most: the limit [bytes].
        held: its bytes; only the first ones when it is too large.
        size: size of its frames up to now [bytes].
        left: bytes of the frame that are still to come.
        is_last: whether no other frame of it follows.
        said: its size at the last report that it is too large; 0 before [bytes].
    """

    kind: int
    most: int
    held: bytearray = field(default_factory=bytearray)
    size: int = 0
    left: int = 0
    is_last: bool = False
    said: int = 0

    @property
    def is_large(self) -> bool:
        return self.size > self.most

    @property
    def is_complete(self) -> bool:
        return self.is_last and not self.left

    def begin_frame(self, size: int, is_last: bool) -> None:
        self.size += size
        self.left, self.is_last = size, is_last
        if self.is_large:
            del self.held[HEAD:]

    def take(self, data: bytes, at: int) -> int:
        """Take what has come of a frame; returns where its part ends."""
        step = min(self.left, len(data) - at)
        kept = min(step, HEAD - len(self.held)) if self.is_large else step
        self.held += data[at : at + kept]
        self.left -= step
        return at + step

    def as_frame(self, last: int) -> Iterator[bytes]:
        """Yield the held bytes as one frame: the last of the message, or the first."""
        size = len(self.held)
        wide = 0 if size < 126 else 2 if size < 2**16 else 8
        yield bytes([last | self.kind, {0: size, 2: 126, 8: 127}[wide]])
        yield size.to_bytes(wide, "big") if wide else b""
        yield bytes(self.held)


class LargeFrames:
    """A filter for the frames of a server, without masks and without compression.

    A message in several frames goes through as one frame.

    Args:
        most: the largest message that goes through [bytes].
        found: called as soon as possible with the first bytes and the size of each
            larger one, and whether this is the first call for it: the size of a message
            in several frames is known at its end.
    """

    def __init__(self, most: int, found: OnLarge) -> None:
        self._most = most
        self._found = found
        self._has_begun = False
        # The start of a frame whose header is not complete yet.
        self._held = b""
        # How much of a frame that goes through is still to come.
        self._through = 0
        self._message: _HeldMessage | None = None

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
            message = self._message
            if message is not None and message.left:
                at = begin = message.take(data, at)
                parts += self._if_complete(message)
            elif self._through:
                step = min(self._through, len(data) - at)
                self._through -= step
                at += step
            elif (end := _end_of_header(data, at)) > len(data):
                self._held = data[at:]
                break
            elif self._is_taken(data, at, end):
                if begin < at:
                    parts.append(data[begin:at])
                message = self._begin_frame(data[at], _size(data, at, end))
                parts += self._if_complete(message)
                at = begin = end
            else:
                if message is not None and not data[at] & _CONTROL:
                    # It makes no sense within a message: websockets says so.
                    parts += [data[begin:at], *message.as_frame(0)]
                    begin, self._message = at, None
                self._through = _size(data, at, end)
                at = end
        if not parts and begin == 0 and at == len(data):
            return data
        return b"".join([*parts, data[begin:at]])

    def _is_taken(self, data: bytes, at: int, end: int) -> bool:
        """Return whether a frame is held or thrown away; all others go through."""
        size, kind = _size(data, at, end), data[at] & ~_LAST
        if data[at + 1] & _MASKED or size >= _NO_SIZE:
            return False
        if self._message is not None or kind == _NEXT:
            return self._message is not None and kind == _NEXT
        is_whole = bool(data[at] & _LAST)
        return kind in (_TEXT, _BINARY) and (not is_whole or size > self._most)

    def _begin_frame(self, first: int, size: int) -> _HeldMessage:
        message = self._message
        if message is None:
            message = self._message = _HeldMessage(first & ~_LAST, self._most)
        message.begin_frame(size, bool(first & _LAST))
        return message

    def _if_complete(self, message: _HeldMessage) -> Iterator[bytes]:
        """Let a message through as one frame, or say that it is too large."""
        if message.is_large and (message.is_complete or len(message.held) >= HEAD):
            if message.said != message.size:
                is_new, message.said = not message.said, message.size
                self._found(bytes(message.held), message.size, is_new)
        if message.is_complete:
            self._message = None
            if not message.is_large:
                yield from message.as_frame(_LAST)

    def _after_answer(self, data: bytes) -> int:
        """Return where the frames begin; -1 while the server has not answered yet."""
        end = data.find(b"\r\n\r\n")
        if data.startswith(_ACCEPTED[: len(data)]) and end < 0:
            self._held = data
            return -1
        self._has_begun = True
        if not data.startswith(_ACCEPTED):
            # There will be no frames.
            self._through = _NO_SIZE
            return 0
        return end + 4


def _end_of_header(data: bytes, at: int) -> int:
    """Return where the header of the frame at a place ends; it may not be there yet."""
    if at + 1 >= len(data):
        return at + 2
    return at + 2 + {126: 2, 127: 8}.get(data[at + 1], 0)


def _size(data: bytes, at: int, end: int) -> int:
    """Return how much a frame holds [bytes]."""
    length = data[at + 1] & 127
    return int.from_bytes(data[at + 2 : end], "big") if length > 125 else length
