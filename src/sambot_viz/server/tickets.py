"""Joins the two connections of each page, viser's and the page's own, by a ticket.

A page makes a ticket when it is loaded and names it in the addresses of both
(``?ticket=``); so the two are known to be one client. A ticket that is in use is
refused: two pages with one ticket do not mix, and a viewer gets nothing by that of the
presenter.
"""

from __future__ import annotations

import asyncio
import http
from collections import deque
from collections.abc import Awaitable, Callable

from websockets.exceptions import ConnectionClosed
from websockets.http11 import Response
from websockets.protocol import State

from sambot_viz.panels.rows.row_store import ClientRows
from sambot_viz.server.channel import Channel
from sambot_viz.server.connections.connection import Connection
from sambot_viz.server.connections.page_files import plain_page
from sambot_viz.server.protection.inbound_filter import (
    CLOSE_TIME,
    ClientHandler,
    NoSessions,
)

ANSWER_TIME = 2.0
"""Who has a ticket, and does not answer for so long, is gone [s]."""
WAIT_FOR_CLIENT = 30.0
"""A channel whose page has no connection to viser is closed after so long [s]."""
CLIENT_LEFT = 4001
"""The channel is closed because the page's connection to viser has ended."""
PAGE_LEFT = 4002
"""The page closes its channel for good: it is not shown any more."""
REMOVED = 4003
"""The presenter has closed the page, which is not to come back by itself."""
_ANY_CLIENT = -1
"""Stands for the number of a client where all have the same rows."""
SERVER_STOPS = 1012
"""The server stops, perhaps to be started again; the code of RFC 6455 for that."""
_MOST_REMOVED = 1000
"""Maximum number of removed pages remembered."""


class Channels:
    """Joins the two connections of each page by their tickets.

    Attributes:
        handler: has the rows, and takes the edits.
        serve_viser: serves a connection to viser until it ends.
        rows_of_all: what every page is sent, so that it does not matter with which
            server its connection to viser is; None where each page has rows of its
            client.
    """

    serve_viser: Callable[[Connection], Awaitable[None]]

    def __init__(self) -> None:
        self.handler: ClientHandler = NoSessions()
        self.rows_of_all: ClientRows | None = None
        self._clients: dict[str, Connection] = {}
        self._channels: dict[str, Connection] = {}
        self._removed: deque[str] = deque(maxlen=_MOST_REMOVED)
        self._changed = asyncio.Event()
        self._closing: set[asyncio.Task[None]] = set()

    def claim(
        self, connection: Connection
    ) -> Response | Awaitable[Response | None] | None:
        """Give a new connection its ticket; returns a refusal when it is in use."""
        context = connection.context
        if not context.ticket:
            return _in_use() if context.channel else None
        if context.ticket in self._removed:
            return _removed()
        if context.channel and self._is_of_another(connection):
            return _in_use()
        holder = self._holders(connection).get(context.ticket)
        if holder is not None:
            return self._take_over(connection, holder)
        self._hold(connection)
        return None

    async def _take_over(
        self, connection: Connection, holder: Connection
    ) -> Response | None:
        """Give a ticket to a page that has lost its connection without a word.

        After a change of networks, the server may believe for a minute that the old
        connection is there.
        """
        alive = await holder.answers(ANSWER_TIME)
        holders, ticket = self._holders(connection), connection.context.ticket
        # Another one may have taken it meanwhile, and this one may have left: nothing
        # would take the ticket from it.
        taken = holders.get(ticket, holder) is not holder
        if alive or taken or connection.state is State.CLOSED:
            return _in_use()
        holder.transport.abort()
        self._hold(connection)
        return None

    def _is_of_another(self, channel: Connection) -> bool:
        """Whether the client with the ticket of a channel has another role."""
        context, client = channel.context, self._clients.get(channel.context.ticket)
        return client is not None and (
            (client.context.presenter, client.context.copy)
            != (context.presenter, context.copy)
        )

    def _holders(self, connection: Connection) -> dict[str, Connection]:
        return self._channels if connection.context.channel else self._clients

    def _hold(self, connection: Connection) -> None:
        holders, ticket = self._holders(connection), connection.context.ticket

        def release() -> None:
            if holders.get(ticket) is connection:
                del holders[ticket]
            if not connection.context.channel:
                self._client_left(connection)

        holders[ticket] = connection
        connection.on_lost = release

    def _client_left(self, client: Connection) -> None:
        if client.removed:
            # viser's part of the page would come back at once.
            self._removed.append(client.context.ticket)
        channel = self._channels.get(client.context.ticket)
        # One that waits for the next connection of its page goes on waiting.
        if channel is not None and channel.client is client:
            code = REMOVED if client.removed else CLIENT_LEFT
            closing = channel.close(code, "the connection to viser has ended")
            # The loop itself keeps no reference to a task.
            task = asyncio.get_running_loop().create_task(closing)
            self._closing.add(task)
            task.add_done_callback(self._closing.discard)

    async def tell_stop(self) -> None:
        """Tell all pages that the server stops: they hold back edits from then on."""
        closing = [
            channel.close(SERVER_STOPS, "the server stops")
            for channel in self._channels.values()
        ]
        await asyncio.gather(*closing, return_exceptions=True)

    def tell_joined(self) -> None:
        """Let channels look again whether their clients have rows; on the loop."""
        # Who waits is woken by `set` alone, and waits again when it was not for him.
        self._changed.set()
        self._changed.clear()

    async def joined(self) -> None:
        """Wait until clients may have rows that had none; on the loop."""
        await self._changed.wait()

    async def serve(self, connection: Connection) -> None:
        """Serve the channel of one page, until it ends."""
        connection.writer.prepare()
        connection.close_timeout = CLOSE_TIME
        channel = Channel(connection, lambda: self.handler)
        reading = asyncio.ensure_future(channel.read())
        writing = asyncio.ensure_future(self._write(channel))
        try:
            await asyncio.wait([reading, writing], return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in (reading, writing):
                task.cancel()
            ends = await asyncio.gather(reading, writing, return_exceptions=True)
        for end in ends:
            expected = (ConnectionClosed, asyncio.CancelledError, asyncio.TimeoutError)
            if isinstance(end, BaseException) and not isinstance(end, expected):
                raise end
        if connection.close_code == PAGE_LEFT:
            client = self._clients.get(connection.context.ticket)
            if client is not None:
                await client.close()

    async def _write(self, channel: Channel) -> None:
        """Write to a channel, as soon as its client has rows."""
        connection = channel.connection
        if self.rows_of_all is not None:
            await channel.write(_ANY_CLIENT, self.rows_of_all)
            return
        client, rows = await asyncio.wait_for(
            self._client_of(connection), WAIT_FOR_CLIENT
        )
        assert client.client_id is not None
        await channel.write(client.client_id, rows)

    async def _client_of(self, connection: Connection) -> tuple[Connection, ClientRows]:
        """Wait for the client with the same ticket, and for its rows."""
        ticket, first = connection.context.ticket, True
        while True:
            if self._is_of_another(connection):
                # It was there before this client, too early to be refused.
                raise TimeoutError
            client = self._clients.get(ticket)
            rows = None
            if client is not None and client.client_id is not None:
                rows = self.handler.rows_of(client.client_id)
            if client is not None and rows is not None:
                # A page that comes again has perhaps lost both connections.
                if first and not await client.answers(ANSWER_TIME):
                    client.transport.abort()
                    client.on_lost()
                elif self._clients.get(ticket) is client:
                    # Not later: from here on the channel ends when its client leaves.
                    connection.client, connection.rate = client, client.rate
                    return client, rows
                # Another client may have joined while this one was asked.
                first = False
                continue
            first = False
            await self.joined()


def _in_use() -> Response:
    return plain_page(
        http.HTTPStatus.CONFLICT,
        "This page is open already",
        "Load the page again.",
    )


def _removed() -> Response:
    return plain_page(
        http.HTTPStatus.FORBIDDEN,
        "The presenter has removed this page",
        "Load the page again.",
    )
