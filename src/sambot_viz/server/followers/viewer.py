"""The viewer that stands for all who follow: a client without a connection.

It sees what a page sees, from the side of the server: what displays draw for who looks,
the rows of a viewer, the view that a presenter leads to. What would be sent to it is
taken here.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import cast

import msgspec.msgpack
from websockets.exceptions import ConnectionClosedOK
from websockets.protocol import State

from sambot_viz.server.connections.connection import ClientContext, Connection
from sambot_viz.server.connections.page_files import VISER_PROTOCOL
from sambot_viz.server.connections.rate_limit import TokenBucket
from sambot_viz.session.clients.viser_camera import VISER_FIRST_POSITION

NAME = "Followers"
"""What the others read of it."""
_CAMERA = msgspec.msgpack.encode(
    {
        "type": "ViewerCameraMessage",
        "wxyz": (0.5, -0.5, -0.5, 0.5),
        "position": VISER_FIRST_POSITION,
        "fov": 0.785,
        "near": 0.01,
        "far": 1000.0,
        "image_height": 720,
        "image_width": 1280,
        "look_at": (0.0, 0.0, 0.0),
        "up_direction": (0.0, 0.0, 1.0),
    }
)
"""A page is a client when it has said where its camera is: that of one that has just
been opened, so that it is asked for the view of the config."""

Take = Callable[[str | bytes], object]


class TakenWriter:
    """Has the methods of a `ClientWriter`, and hands on what it is given.

    Args:
        take: gets each message, on the event loop.
    """

    def __init__(self, take: Take) -> None:
        self._take = take

    def prepare(self) -> None:
        """Do nothing: there is no line."""

    async def send(self, message: str | bytes) -> None:
        """Hand on a message."""
        self._take(message)
        # Messages that never wait for a line would keep all others waiting.
        await asyncio.sleep(0)


class ViewerConnection:
    """Stands in for the `Connection` of a page, for as long as it is not closed."""

    subprotocol = VISER_PROTOCOL
    close_timeout = 0.0

    def __init__(self, take: Take = lambda _: None) -> None:
        self.context = ClientContext(login=NAME, follows=True)
        self.writer = TakenWriter(take)
        self.rate = TokenBucket(1.0, 10.0)
        self.read = self.receive
        self.client_id: int | None = None
        self.removed = False
        self.transport = self
        self.state = State.OPEN
        self._closed = asyncio.Event()
        self._unread = [_CAMERA]

    def as_connection(self) -> Connection:
        """Return it as what it stands for."""
        return cast(Connection, self)

    async def receive(self) -> bytes:
        """Return the first camera, and nothing more.

        Raises:
            ConnectionClosedOK: it was closed.
        """
        if self._unread:
            return self._unread.pop()
        await self._closed.wait()
        raise ConnectionClosedOK(None, None)

    async def recv(self) -> bytes:
        """Return the next message; viser calls it."""
        return await self.read()

    async def close(self, code: int = 1000, reason: str = "") -> None:
        """End it."""
        del code, reason
        self.abort()

    def abort(self) -> None:
        """End it at once."""
        self.state = State.CLOSED
        self._closed.set()
