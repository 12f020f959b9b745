"""A connection that takes what small messages have come a few times in a second."""

from __future__ import annotations

import socket
from contextlib import suppress
from typing import Any

from websockets.asyncio.client import ClientConnection

from sambot_viz import limits
from sambot_viz.sources.websocket.large_frames import LargeFrames, OnLarge

PACE = 0.010
"""Pause after a read that emptied the socket [s]."""
_MUCH = 65_536
"""Size of a read that may not have emptied the socket [bytes]."""
_ACKNOWLEDGE = getattr(socket, "TCP_QUICKACK", None)


class PacedConnection(ClientConnection):
    """Reads many small messages at once, because a wake-up for each costs more.

    It acknowledges the data at each read. Otherwise a peer that collects small messages
    until the last ones are acknowledged (Nagle's algorithm) would wait for the 40 ms of
    Linux, and the picture would lag behind by a message.

    A message that is too large is not read, and the connection goes on.

    Attributes:
        on_large: called with the first bytes of such a message, its size up to now
            [bytes], and whether it is a new one.
    """

    def __init__(self, *parts: Any, **options: Any) -> None:
        super().__init__(*parts, **options)
        self.on_large: OnLarge = lambda head, size, is_new: None
        self._large = LargeFrames(
            limits.MESSAGE.value,
            lambda head, size, is_new: self.on_large(head, size, is_new),
        )

    def data_received(self, data: bytes) -> None:
        """Take what has come, and read again soon; at once when there is more."""
        if through := self._large.filtered(data):
            super().data_received(through)
        if len(data) < _MUCH and not self.transport.is_closing():
            self.transport.pause_reading()
            self.loop.call_later(PACE, self._read_again)

    def _read_again(self) -> None:
        # The connection may have ended in the meantime.
        if self.transport.is_closing():
            return
        self.transport.resume_reading()
        peer: socket.socket | None = self.transport.get_extra_info("socket")
        if peer is not None and _ACKNOWLEDGE is not None:
            # Once: an even number lets Linux wait again after that.
            with suppress(OSError):
                peer.setsockopt(socket.IPPROTO_TCP, _ACKNOWLEDGE, 2)
