"""A client's websocket, with all state that this server holds for it."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed, ProtocolError
from websockets.frames import CTRL_OPCODES, Frame, Opcode
from websockets.protocol import State
from websockets.typing import Data

from sambot_viz import limits
from sambot_viz.server.connections.client_writer import ClientWriter
from sambot_viz.server.connections.connection_limit import ConnectionLimiter
from sambot_viz.server.connections.rate_limit import TokenBucket
from sambot_viz.server.connections.traffic import Traffic

BURST = 600.0
"""Number of messages that may come at once."""
SMALL_FRAME = 1000
"""Smaller frames have a rate limit; larger ones count as part of a message [bytes]."""
SMALL_FRAMES_PER_SECOND = 10.0
"""The server's own pings cause three answers a minute."""
SMALL_FRAMES_AT_ONCE = 100.0


@dataclass(frozen=True, slots=True)
class ClientContext:
    """Facts about a client from the request for its connection.

    Attributes:
        presenter: whether it used the presenter's link.
        copy: whether it asks for a private copy of the shared session.
        ticket: ticket of its page; "" for a program without one.
        channel: whether it is a page's channel, not viser's connection.
        login: user name from a trusted proxy; "" without one.
        follows: whether it represents all viewers at followers of this server.
    """

    presenter: bool = False
    copy: bool = False
    ticket: str = ""
    channel: bool = False
    login: str = ""
    follows: bool = False


class Connection(ServerConnection):
    """A connection with a count, an inbound filter and writes in pieces.

    Args:
        limiter: counts the connection; one too many gets one answer at most.
        traffic: counts messages to the client.

    Attributes:
        context: facts from its request.
        writer: sends to it.
        rate: limits its messages; a page's channel shares its client's limit.
        read: reads the next message that may be handled; the inbound filter if there
            is one.
        client_id: viser's number of the client; None for a channel.
        client: for a channel, the connection to viser of the same page.
        on_lost: called when the connection has ended.
        removed: whether the presenter has closed the page.
    """

    def __init__(
        self,
        limiter: ConnectionLimiter,
        traffic: Traffic,
        *arguments: Any,
        **settings: Any,
    ) -> None:
        super().__init__(*arguments, **settings)
        self.context = ClientContext()
        self.writer = ClientWriter(self, traffic)
        self.rate = TokenBucket(limits.PAGE_MESSAGES.value, BURST)
        self.read: Callable[[], Awaitable[Data]] = self.receive
        self.client_id: int | None = None
        self.client: Connection | None = None
        self.on_lost: Callable[[], object] = lambda: None
        self.removed = False
        self._limiter = limiter
        self._traffic = traffic
        self._limit_small_frames()

    def _limit_small_frames(self) -> None:
        """End a connection that floods the server below the level of messages.

        The websockets library answers a ping as soon as it arrives, however many
        answers wait, and collects the parts of a message, even if they are all empty.
        Browsers send neither pings nor messages in small parts.
        """
        take = self.protocol.recv_frame
        rate = TokenBucket(SMALL_FRAMES_PER_SECOND, SMALL_FRAMES_AT_ONCE)

        def recv_frame(frame: Frame) -> None:
            part = frame.opcode is Opcode.CONT or frame.opcode in CTRL_OPCODES
            if part and len(frame.data) < SMALL_FRAME and rate.take() > 0.0:
                raise ProtocolError("too many small frames")
            take(frame)

        self.protocol.recv_frame = recv_frame  # type: ignore[method-assign]

    async def recv(self, decode: bool | None = None) -> Any:
        """Return the next message that passes `read`; viser calls this."""
        return await self.read()

    async def receive(self) -> Data:
        """Return the next message without a filter."""
        return await super().recv()

    async def answers(self, timeout: float) -> bool:
        """Return whether the client answers a ping in time [s], or keeps reading."""
        if self.state is State.CONNECTING:
            return True

        async def ping() -> None:
            await (await self.ping())

        taken = self.writer.taken()
        try:
            await asyncio.wait_for(ping(), timeout)
        except ConnectionClosed:
            return False
        except asyncio.TimeoutError:
            # On a slow line the ping waits behind other messages.
            return self.writer.taken() > taken
        return True

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Count a new connection."""
        super().connection_made(transport)
        self._traffic.clients.add(self.writer)
        self._limiter.admit(self)

    def data_received(self, data: bytes) -> None:
        """Read on, but not forever from a connection that must close."""
        end = self.close_deadline
        if end is not None and self.loop.time() > end:
            self.transport.abort()
        else:
            super().data_received(data)

    def connection_lost(self, exc: Exception | None) -> None:
        """Make room for another connection."""
        self._limiter.lost(self)
        self._traffic.clients.discard(self.writer)
        self.on_lost()
        super().connection_lost(exc)
