"""Send each client the messages that it lacks, in batches.

viser numbers its messages and keeps the newest of each kind and node. For every page
that opens, its loop asks on the event loop for every number since the server started:
a second without messages to anyone for each ten million numbers. This module asks only
for messages that exist. A mesh goes alone, so that one packed copy serves all clients
that open at the same time.
"""

from __future__ import annotations

import math
from collections.abc import AsyncGenerator, Callable, Sequence
from typing import Any, cast

import viser

from sambot_viz import viser_private
from sambot_viz.server.connections.connection import Connection
from sambot_viz.server.outgoing.frame_cache import MORE, Batch, FrameCache
from sambot_viz.server.outgoing.message_cursor import MessageCursor, SharedBatch
from sambot_viz.server.outgoing.news import News

_NO_CLIENT = -1
"""Takes the place of a client's number where all clients get the same."""


def prepare(server: viser.ViserServer) -> None:
    """Let this module send the messages for all clients of a server."""
    _replace(server, viser_private.broadcast_buffer(server))


def prepare_own(server: viser.ViserServer, client_id: int) -> None:
    """Let this module send the messages for one client."""
    _replace(server, viser_private.own_buffer(server, client_id))


def keep_apart(server: viser.ViserServer, apart: Callable[[int], bool]) -> Outbox:
    """Stop sending common messages to some clients, which have a separate scene.

    Args:
        server: the server.
        apart: returns whether the client with a number is one of them.

    Returns:
        The outbox of the other clients.
    """
    buffer = viser_private.broadcast_buffer(server)
    end = buffer.message_counter - 1
    return _replace(
        server, buffer, lambda client_id: end if apart(client_id) else math.inf
    )


def _replace(
    server: viser.ViserServer,
    buffer: viser_private.MessageBuffer,
    last_for: Callable[[int], float] = lambda _: math.inf,
) -> Outbox:
    outgoing = Outbox(buffer)

    def loop(client_id: int, backlog_end: int, marker: Any) -> Sender:
        connection = cast(Connection, viser_private.connection_of(server, client_id))
        last = last_for(client_id)
        return outgoing.sender(connection, client_id, backlog_end, marker, last)

    viser_private.replace_window_loop(buffer, loop)
    return outgoing


class Outbox:
    """Messages from one buffer, packed once for all clients that get them.

    Args:
        buffer: the buffer; from now on this object handles viser's requests for it.
    """

    def __init__(self, buffer: viser_private.MessageBuffer) -> None:
        self._buffer = buffer
        self._cache, self._shared = FrameCache(), SharedBatch()
        self._news = News.of(buffer)
        self._live: MessageCursor | None = None

    def sender(
        self,
        connection: Connection,
        client_id: int,
        backlog_end: int,
        marker: Any,
        last: float,
    ) -> Sender:
        """Return the sender of one client's messages; see `batches`."""
        cursor = MessageCursor(self._buffer, client_id, self._shared)
        parts = batches(self._news, cursor, marker, backlog_end, last)
        return Sender(connection, self._cache, parts)

    async def frames(self) -> AsyncGenerator[bytes, None]:
        """Yield the frames that go out from now on, as clients get them."""
        self._news.join()
        cursor = self._live = MessageCursor(self._buffer, _NO_CLIENT, self._shared)
        cursor.last = self._news.end
        async for batch in batches(self._news, cursor, None, -1):
            yield (await self._cache.packed(batch)).content

    async def backlog(self) -> list[bytes]:
        """Return all that `frames` has yielded or omitted so far, as it is now."""
        end = self._news.end if self._live is None else self._live.last
        cursor = MessageCursor(self._buffer, _NO_CLIENT, self._shared)
        found: list[bytes] = []
        while cursor.last < end and not self._buffer.done:
            batch = cursor.next(end)
            if batch.messages:
                found.append((await self._cache.packed(batch)).content)
            elif cursor.last < end and not self._news.may_go_on(True):
                await self._news.wait()
        return found


class Sender:
    """Sends batches itself: viser, which asks for them, would pack them again.

    Args:
        connection: connection of the client.
        cache: packs the batches, once for all clients.
        batches: batches of this client.
    """

    def __init__(
        self,
        connection: Connection,
        cache: FrameCache,
        batches: AsyncGenerator[Batch, None],
    ) -> None:
        self._connection = connection
        self._cache = cache
        self._batches = batches

    async def __anext__(self) -> Sequence[Any]:
        """Send everything, until the server or the client ends.

        Raises:
            ConnectionClosed: the client has left.
        """
        async for batch in self._batches:
            # Keep a reference so that other clients can reuse the packed bytes, but
            # only while they go out: a mesh is large.
            frame = await self._cache.packed(batch)
            await self._connection.writer.send(frame.content)
            del frame
        raise StopAsyncIteration

    async def aclose(self) -> None:
        """End the batches of a client that has left."""
        await self._batches.aclose()


async def batches(
    news: News,
    cursor: MessageCursor,
    marker: viser_private.Message | None,
    backlog_end: int,
    last: float = math.inf,
) -> AsyncGenerator[Batch, None]:
    """Yield the messages for one client as they come, several at a time.

    Args:
        news: announces how many may go out.
        cursor: position of the client.
        marker: message that goes out right after the backlog.
        backlog_end: number of the last message that existed when the client came.
        last: number of the last message for this client.
    """
    buffer, client_id = news.buffer, cursor.client_id
    buffer.generator_cursors[client_id] = cursor.last
    news.join()
    try:
        while not buffer.done:
            due = backlog_end if marker is not None else max(news.end, backlog_end)
            end = int(min(due, last))
            batch = cursor.next(end)
            # viser forgets a removal when every client has had it.
            done = cursor.last if cursor.last < last else buffer.message_counter - 1
            buffer.generator_cursors[client_id] = done
            is_behind = cursor.last < end
            if marker is not None and not is_behind and not cursor.held:
                batch = batch.with_marker(marker)
                marker = None
            elif is_behind and batch.messages and cursor.last > backlog_end:
                # All messages of a change belong in one picture.
                batch = batch.with_marker(viser_private.more_follows(), MORE)
            if batch.messages:
                yield batch
            elif not news.may_go_on(is_behind or marker is not None):
                await news.wait()
    finally:
        buffer.generator_cursors.pop(client_id, None)
