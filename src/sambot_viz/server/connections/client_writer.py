"""Send to one client in pieces, as fast as it reads (backpressure)."""

from __future__ import annotations

import asyncio
import math
import socket
import time
from collections.abc import AsyncIterator
from contextlib import suppress

from websockets.asyncio.server import ServerConnection

from sambot_viz.server.connections.traffic import Traffic

PIECE = 128 * 1024
"""A longer message is sent in pieces: so much of it is copied at a time [bytes]."""
STALL_PERIOD = 10.0
"""A client that hardly reads is disconnected after one to two of these [s]."""
SLOWEST = 1000.0
"""A slower client hardly reads [bytes/s]."""


class ClientWriter:
    """Send to one client.

    Args:
        connection: of the client.
        traffic: counts what is sent to all clients.
    """

    def __init__(
        self, connection: ServerConnection, traffic: Traffic | None = None
    ) -> None:
        self._connection = connection
        self._traffic = traffic or Traffic()
        self._given = 0
        self._sends_since = math.inf

    def waits(self) -> float:
        """Return for how long the client has not taken a message [s]."""
        return max(0.0, time.monotonic() - self._sends_since)

    def prepare(self) -> None:
        """Have the system take no more than a piece that the line cannot take yet.

        It takes megabytes otherwise. On a slow line a question whether the client is
        still there then waits behind them for longer than the answer is waited for, and
        nothing seems to move for as long.
        """
        line = self._connection.transport.get_extra_info("socket")
        option = getattr(socket, "TCP_NOTSENT_LOWAT", None)
        if option is not None and line.family in (socket.AF_INET, socket.AF_INET6):
            # A client that has left already has closed it.
            with suppress(OSError):
                line.setsockopt(socket.IPPROTO_TCP, option, PIECE)

    async def send(self, message: str | bytes) -> None:
        """Send a message; disconnect a client that does not take it.

        Args:
            message: bytes, or a text that is shorter than a piece.
        """
        timer = StallTimer(self)
        self._traffic.frames += 1
        self._sends_since = min(self._sends_since, time.monotonic())
        try:
            if isinstance(message, str) or len(message) <= PIECE:
                self._count(len(message))
                await self._connection.send(message)
            else:
                await self._connection.send(self._pieces(message))
        finally:
            timer.cancel()
            self._sends_since = math.inf

    def _count(self, size: int) -> None:
        self._given += size
        self._traffic.sent += size

    async def _pieces(self, message: bytes) -> AsyncIterator[memoryview]:
        view = memoryview(message)
        for start in range(0, len(view), PIECE):
            piece = view[start : start + PIECE]
            self._count(len(piece))
            yield piece
            # A client that reads at once would keep all others waiting.
            await asyncio.sleep(0)

    def taken(self) -> int:
        """Return how much the client has taken since it came [bytes]."""
        return self._given - self._connection.transport.get_write_buffer_size()

    def abort(self) -> None:
        """End the connection at once."""
        self._connection.transport.abort()


class StallTimer:
    """Disconnect a client that hardly reads, while something is sent to it.

    Args:
        writer: sends to it.
    """

    def __init__(self, writer: ClientWriter) -> None:
        self._writer = writer
        self._taken = -math.inf
        self._start()

    def _start(self) -> None:
        loop = asyncio.get_running_loop()
        self._timer = loop.call_later(STALL_PERIOD, self._look)

    def _look(self) -> None:
        before, self._taken = self._taken, self._writer.taken()
        if self._taken - before < SLOWEST * STALL_PERIOD:
            self._writer.abort()
        else:
            self._start()

    def cancel(self) -> None:
        """Stop: everything was sent."""
        self._timer.cancel()
