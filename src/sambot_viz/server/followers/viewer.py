"""The viewer that represents all followers: a client without a connection.

It has a page's view of the server: the drawings of displays for viewers, the rows of a
viewer, the view of a presenter. This module takes the messages that a page would get.
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
"""Name that other users see."""
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
"""Camera of a page that has just opened. A page counts as a client once it has sent its
camera; this one makes the server ask for the view of the config."""

Take = Callable[[str | bytes], object]


class TakenWriter:
    """Has the methods of a `ClientWriter`, and passes its messages on.

    Args:
        take: receives each message, on the event loop.
    """

    def __init__(self, take: Take) -> None:
        self._take = take

    def prepare(self) -> None:
        """Do nothing: there is no line."""

    async def send(self, message: str | bytes) -> None:
        """Pass a message on."""
        self._take(message)
        # Messages that never wait for a line would block all other clients.
        await asyncio.sleep(0)


class ViewerConnection:
    """Takes the place of a page's `Connection` until closed."""

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
        """Return this object under the type that it imitates."""
        return cast(Connection, self)

    async def receive(self) -> bytes:
        """Return the first camera, and nothing after it.

        Raises:
            ConnectionClosedOK: the connection was closed.
        """
        if self._unread:
            return self._unread.pop()
        await self._closed.wait()
        raise ConnectionClosedOK(None, None)

    async def recv(self) -> bytes:
        """Return the next message; viser calls it."""
        return await self.read()

    async def close(self, code: int = 1000, reason: str = "") -> None:
        """Close the connection."""
        del code, reason
        self.abort()

    def abort(self) -> None:
        """Close the connection at once."""
        self.state = State.CLOSED
        self._closed.set()
