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
"""Size of the pieces of a longer message [bytes]; one piece is copied at a time."""
STALL_PERIOD = 10.0
"""A client that hardly reads is disconnected after one to two periods [s]."""
SLOWEST = 1000.0
"""A client below this speed hardly reads [bytes/s]."""


class ClientWriter:
    """Send to one client.

    Args:
        connection: connection of the client.
        traffic: counts messages to all clients.
    """

    def __init__(
        self, connection: ServerConnection, traffic: Traffic | None = None
    ) -> None:
        self._connection = connection
        self._traffic = traffic or Traffic()
        self._given = 0
        self._sends_since = math.inf

    def waits(self) -> float:
        """Return how long a message has been waiting for the client [s]."""
        return max(0.0, time.monotonic() - self._sends_since)

    def prepare(self) -> None:
        """Limit the system's send buffer to one piece.

        By default it holds megabytes. On a slow line, a ping would wait behind them for
        longer than the server waits for its answer, and the picture would seem frozen
        for as long.
        """
        line = self._connection.transport.get_extra_info("socket")
        option = getattr(socket, "TCP_NOTSENT_LOWAT", None)
        if option is not None and line.family in (socket.AF_INET, socket.AF_INET6):
            # A client that has left has closed its socket.
            with suppress(OSError):
                line.setsockopt(socket.IPPROTO_TCP, option, PIECE)

    async def send(self, message: str | bytes) -> None:
        """Send a message; disconnect a client that does not take it.

        Args:
            message: bytes, or a text shorter than a piece.
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
            # Otherwise a client that reads at once would block all others.
            await asyncio.sleep(0)

    def taken(self) -> int:
        """Return how much the client has taken since it connected [bytes]."""
        return self._given - self._connection.transport.get_write_buffer_size()

    def abort(self) -> None:
        """End the connection at once."""
        self._connection.transport.abort()


class StallTimer:
    """Disconnect a client that hardly reads during a transfer.

    Args:
        writer: sends to the client.
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
        """Stop: the transfer is complete."""
        self._timer.cancel()
