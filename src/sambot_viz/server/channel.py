"""The page's own websocket, beside viser's: sends rows, exchanges cameras.

It uses the same port and passes the same checks as viser's connection, with its own
subprotocol. `server.tickets` finds the connection to viser of the same page.

The server sends JSON objects: the rows that the page lacks (`panels.row_store`), as
text or, when long, compressed in a binary frame, and the camera that the page should
use (`session.clients.client_camera`). The page sends JSON lists for edits and pressed
buttons (`panels.sent`), and JSON objects for its camera. It may ask ``"ping"`` at any
time. The answer ``"pong"`` follows all changes that its earlier edits have caused so
far. A page that gets no answer knows that its connection is lost.

The server makes a patch only when the connection can take one. So a slow page gets the
newest state, and no queue builds up.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any, cast

import msgspec
from websockets.protocol import State

from sambot_viz.panels import sent
from sambot_viz.panels.rows.row_store import ClientRows
from sambot_viz.server.connections.connection import Connection
from sambot_viz.server.connections.rate_limit import InFlightLimit
from sambot_viz.server.protection.client_messages import CameraReport
from sambot_viz.server.protection.inbound_filter import ClientHandler, report

SUBPROTOCOL = "sambot-viz-1"
"""Change the number when older pages can no longer talk to this server."""
PING, PONG = '"ping"', '"pong"'


class Channel:
    """The channel of one page.

    Args:
        connection: connection of the page.
        handler: returns the current receiver of edits.
    """

    def __init__(
        self, connection: Connection, handler: Callable[[], ClientHandler]
    ) -> None:
        self.connection = connection
        self._handler = handler
        self._client_id: int | None = None
        self._pings = 0
        self._news = asyncio.Event()

    async def read(self) -> None:
        """Handle the page's messages until its connection ends."""
        in_flight = InFlightLimit(self._behind)
        while True:
            message = await self.connection.receive()
            if (pause := self.connection.rate.take()) > 0.0:
                if self.connection.state is not State.OPEN:
                    # The client left during a flood; its messages can be dropped.
                    continue
                await asyncio.sleep(pause)
            await in_flight.wait()
            if message == PING and self._client_id is None:
                await self.connection.writer.send(PONG)
            elif message == PING:
                self._pings += 1
                self._news.set()
            else:
                self._take(message)

    def _behind(self, action: Callable[[], None]) -> None:
        if self._client_id is None:
            action()
        else:
            self._handler().behind(self._client_id, action)

    def _take(self, message: str | bytes) -> None:
        edit: Any = None
        with suppress(msgspec.MsgspecError, UnicodeError, RecursionError):
            edit = msgspec.json.decode(message) if isinstance(message, str) else None
        if self._client_id is None:
            report(None, "an edit before the first camera")
        elif isinstance(edit, dict):
            self._take_camera(self._client_id, cast("dict[str, Any]", edit))
        elif sent.read(edit) is None:
            report(self._client_id, "what is not an edit")
        else:
            self._handler().take_edit(self._client_id, edit)

    def _take_camera(self, client_id: int, message: dict[str, Any]) -> None:
        try:
            camera = msgspec.convert(message, CameraReport)
        except msgspec.ValidationError:
            report(client_id, "what is not a camera")
        else:
            self._handler().take_camera(client_id, camera)

    async def write(self, client_id: int, rows: ClientRows) -> None:
        """Send the rows that the page lacks, whenever the connection is free."""
        self._client_id = client_id
        loop = asyncio.get_running_loop()

        def wake() -> None:
            # Rows change in the session's thread. A set event means that the loop will
            # clear it before it reads the rows, so no change is missed.
            if not self._news.is_set():
                # The loop may have ended already.
                with suppress(RuntimeError):
                    loop.call_soon_threadsafe(self._news.set)

        end = rows.listen(wake)
        versions = dict.fromkeys(rows.sent, 0)
        try:
            while True:
                # Cleared first: the next round sends later changes.
                self._news.clear()
                pings, self._pings = self._pings, 0
                for store, version in versions.items():
                    versions[store], message = store.since(version)
                    if message is not None:
                        await self.connection.writer.send(message)
                for _ in range(pings):
                    await self.connection.writer.send(PONG)
                if all(store.version == at for store, at in versions.items()):
                    await self._news.wait()
        finally:
            end()
