"""How a browser takes what it is sent: in pieces, as fast as it reads."""

from __future__ import annotations

import asyncio
import math
import socket
from collections.abc import AsyncIterator
from contextlib import suppress

from websockets.asyncio.server import ServerConnection

from sambot_viz import viser_private

PIECE = 128 * 1024
"""A longer message is sent in pieces: so much of it is copied at a time [bytes]."""
STALL_PERIOD = 10.0
"""A browser that hardly reads is disconnected after one to two of these [s]."""
SLOWEST = 1000.0
"""A slower browser hardly reads [bytes/s]."""


class Sending:
    """Sends to one browser, whose connection's own `send` it replaces.

    Args:
        connection: of the browser.
    """

    def __init__(self, connection: ServerConnection) -> None:
        self._transport = connection.transport
        self._send = connection.send
        self._given = 0
        _keep_little_in_the_system(self._transport)
        viser_private.replace_methods(connection, send=self.send)

    async def send(self, message: bytes) -> None:
        """Send a message; disconnect a browser that does not take it."""
        timer = StallTimer(self)
        try:
            if len(message) <= PIECE:
                self._given += len(message)
                await self._send(message)
            else:
                await self._send(self._pieces(message))
        finally:
            timer.cancel()

    async def _pieces(self, message: bytes) -> AsyncIterator[memoryview]:
        view = memoryview(message)
        for start in range(0, len(view), PIECE):
            piece = view[start : start + PIECE]
            self._given += len(piece)
            yield piece
            # A browser that reads at once would keep all others waiting.
            await asyncio.sleep(0)

    def taken(self) -> int:
        """How much the browser has taken since it came [bytes]."""
        return self._given - self._transport.get_write_buffer_size()

    def abort(self) -> None:
        """End the connection at once."""
        self._transport.abort()


def _keep_little_in_the_system(transport: asyncio.Transport) -> None:
    """Have the system take no more than a piece that the line cannot take yet.

    It takes megabytes otherwise. On a slow line a question whether the browser is still
    there then waits behind them for longer than the answer is waited for, and nothing
    seems to move for as long.
    """
    line = transport.get_extra_info("socket")
    option = getattr(socket, "TCP_NOTSENT_LOWAT", None)
    if option is not None and line.family in (socket.AF_INET, socket.AF_INET6):
        # A browser that has left already has closed it.
        with suppress(OSError):
            line.setsockopt(socket.IPPROTO_TCP, option, PIECE)


class StallTimer:
    """Disconnects a browser that hardly reads, while something is sent to it.

    Args:
        sending: what is sent to it.
    """

    def __init__(self, sending: Sending) -> None:
        self._sending = sending
        self._taken = -math.inf
        self._start()

    def _start(self) -> None:
        loop = asyncio.get_running_loop()
        self._timer = loop.call_later(STALL_PERIOD, self._look)

    def _look(self) -> None:
        before, self._taken = self._taken, self._sending.taken()
        if self._taken - before < SLOWEST * STALL_PERIOD:
            self._sending.abort()
        else:
            self._start()

    def cancel(self) -> None:
        """Everything was sent."""
        self._timer.cancel()
