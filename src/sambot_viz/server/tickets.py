"""Joins the two connections of each page, viser's and the page's own, by a ticket.

A page makes a ticket when it loads and puts it in the addresses of both connections
(``?ticket=``), so the server knows that they belong to one client. The server refuses a
ticket in use: two pages with one ticket do not mix, and a viewer gains nothing with
the presenter's ticket.
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
"""The holder of a ticket is gone if it does not answer within this time [s]."""
WAIT_FOR_CLIENT = 30.0
"""The server closes a channel whose page has no connection to viser by then [s]."""
CLIENT_LEFT = 4001
"""The server closes the channel because the connection to viser has ended."""
PAGE_LEFT = 4002
"""The page closes its channel and will not return."""
REMOVED = 4003
"""The presenter has closed the page, which must not reconnect by itself."""
_ANY_CLIENT = -1
"""Takes the place of a client's number where all clients have the same rows."""
SERVER_STOPS = 1012
"""The server stops and may start again; RFC 6455 defines this code."""
_MOST_REMOVED = 1000
"""Maximum number of removed pages remembered."""


class Channels:
    """Joins the two connections of each page by their tickets.

    Attributes:
        handler: provides the rows, and receives the edits.
        serve_viser: serves a connection to viser until it ends.
        rows_of_all: rows that every page gets, whichever server its connection to viser
            belongs to; None where each page has the rows of its client.
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
        """Give a new connection its ticket; return a refusal if it is in use."""
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
        """Give a ticket to a page whose connection was lost without notice.

        After a change of networks, the server may take the old connection for alive
        for a minute.
        """
        alive = await holder.answers(ANSWER_TIME)
        holders, ticket = self._holders(connection), connection.context.ticket
        # Another page may have taken the ticket meanwhile, or this page may have left,
        # and then no event would release the ticket.
        taken = holders.get(ticket, holder) is not holder
        if alive or taken or connection.state is State.CLOSED:
            return _in_use()
        holder.transport.abort()
        self._hold(connection)
        return None

    def _is_of_another(self, channel: Connection) -> bool:
        """Return whether the client with a channel's ticket has another role."""
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
            # viser's part of the page would reconnect at once.
            self._removed.append(client.context.ticket)
        channel = self._channels.get(client.context.ticket)
        # A channel that waits for the next connection of its page continues to wait.
        if channel is not None and channel.client is client:
            code = REMOVED if client.removed else CLIENT_LEFT
            closing = channel.close(code, "the connection to viser has ended")
            # The loop itself holds no reference to a task.
            task = asyncio.get_running_loop().create_task(closing)
            self._closing.add(task)
            task.add_done_callback(self._closing.discard)

    async def tell_stop(self) -> None:
        """Notify all pages that the server stops: they hold back edits from then on."""
        closing = [
            channel.close(SERVER_STOPS, "the server stops")
            for channel in self._channels.values()
        ]
        await asyncio.gather(*closing, return_exceptions=True)

    def tell_joined(self) -> None:
        """Wake channels to check whether their clients have rows; on the loop."""
        # `set` alone wakes the waiters; a waiter without rows waits again.
        self._changed.set()
        self._changed.clear()

    async def joined(self) -> None:
        """Wait until more clients may have rows; on the loop."""
        await self._changed.wait()

    async def serve(self, connection: Connection) -> None:
        """Serve the channel of a page until it ends."""
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
        """Write to a channel once its client has rows."""
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
                # The channel came before this client, too early for a refusal.
                raise TimeoutError
            client = self._clients.get(ticket)
            rows = None
            if client is not None and client.client_id is not None:
                rows = self.handler.rows_of(client.client_id)
            if client is not None and rows is not None:
                # A returning page may have lost both connections.
                if first and not await client.answers(ANSWER_TIME):
                    client.transport.abort()
                    client.on_lost()
                elif self._clients.get(ticket) is client:
                    # Set now: from here on the channel ends when its client leaves.
                    connection.client, connection.rate = client, client.rate
                    return client, rows
                # Another client may have joined while this one answered.
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
