"""What goes out to a browser: the messages it has not had yet, in batches.

viser numbers its messages and keeps the newest of each kind and node. Its own loop asks
for every number since the server started, on the event loop and for every page that is
opened: a second in which nobody gets anything, for each ten million messages. This one
asks only for messages that are there. A mesh goes alone, so that it is packed once for
all browsers that are opened at the same time.
"""

from __future__ import annotations

import asyncio
import math
import threading
from collections.abc import AsyncGenerator, Callable, Sequence
from contextlib import suppress
from typing import Any, Protocol

import viser
from websockets.asyncio.server import ServerConnection

from sambot_viz import viser_private
from sambot_viz.server.parcels import HEAVY, Batch, Parcels, weight


class Message(Protocol):
    """What is read from a message of viser.

    Attributes:
        excluded_self_client: the number of a browser that does not get it.
    """

    excluded_self_client: int | None


class Buffer(Protocol):
    """What is used of viser's buffer of messages.

    Attributes:
        event_loop: that of the server.
        persistent_messages: whether messages stay for browsers that come later.
        message_event: set when there is something new.
        flush_event: set when what there is shall go out at once.
        message_counter: the number of the next message.
        message_from_id: the messages by number, in this order.
        buffer_lock: for changes of `message_from_id`.
        max_window_size: messages that go out together at most.
        window_duration_sec: how long messages are collected [s].
        done: whether the server or the browser has ended.
        atomic_counter: above 0 nothing goes out.
        generator_cursors: the number of the last message that each browser had.
    """

    event_loop: asyncio.AbstractEventLoop
    persistent_messages: bool
    message_event: asyncio.Event
    flush_event: asyncio.Event
    message_counter: int
    message_from_id: dict[int, Any]
    buffer_lock: threading.Lock
    max_window_size: int
    window_duration_sec: float
    done: bool
    atomic_counter: int
    generator_cursors: dict[int, int]

    def pop_message_locked(self, message_id: int) -> Any:
        """Take a message out; the caller holds `buffer_lock`."""


def prepare(server: viser.ViserServer) -> None:
    """Have what goes out to all browsers of a server go out from here."""
    _replace(server, viser_private.broadcast_buffer(server))


def prepare_own(server: viser.ViserServer, client_id: int) -> None:
    """Have what goes out to one browser go out from here."""
    _replace(server, viser_private.own_buffer(server, client_id))


def keep_apart(server: viser.ViserServer, apart: Callable[[int], bool]) -> None:
    """Send some browsers only what goes out to all until now: they have a scene alone.

    Args:
        server: the server.
        apart: whether the browser of a number is one of them.
    """
    buffer = viser_private.broadcast_buffer(server)
    end = buffer.message_counter - 1
    _replace(server, buffer, lambda client_id: end if apart(client_id) else math.inf)


def _replace(
    server: viser.ViserServer,
    buffer: Buffer,
    last_for: Callable[[int], float] = lambda _: math.inf,
) -> None:
    parcels = Parcels()
    if not isinstance(buffer.message_event, News):
        buffer.message_event = News(buffer.event_loop)

    def loop(client_id: int, backlog_end: int, marker: Any) -> Sender:
        connection = viser_private.connection_of(server, client_id)
        last = last_for(client_id)
        return Sender(
            connection, parcels, batches(buffer, client_id, backlog_end, marker, last)
        )

    viser_private.replace_window_loop(buffer, loop)


class News(asyncio.Event):
    """That there is something new; it is set on the event loop only.

    viser sets it in the thread that adds a message, and on the loop after that. The
    first goes through those who wait while others come and go, which raises an error in
    that thread every now and then, and wakes all of them twice.

    Args:
        loop: the event loop.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__()
        self._home = loop

    def set(self) -> None:
        """Wake those who wait; in another thread that does nothing."""
        with suppress(RuntimeError):
            if asyncio.get_running_loop() is self._home:
                super().set()


class Sender:
    """Sends batches by itself: viser, which asks it for them, would pack them again.

    Args:
        connection: of the browser.
        parcels: packs them.
        batches: for this browser.
    """

    def __init__(
        self,
        connection: ServerConnection,
        parcels: Parcels,
        batches: AsyncGenerator[Batch, None],
    ) -> None:
        self._connection = connection
        self._parcels = parcels
        self._batches = batches

    async def __anext__(self) -> Sequence[Any]:
        """Send everything, until the server or the browser ends.

        Raises:
            ConnectionClosed: the browser has left.
        """
        async for batch in self._batches:
            # It is there for other browsers as long as this one holds it.
            parcel = await self._parcels.parcel(batch)
            await self._connection.send(parcel.content)
            del parcel
        raise StopAsyncIteration

    async def aclose(self) -> None:
        """The browser has left."""
        await self._batches.aclose()


async def batches(
    buffer: Buffer,
    client_id: int,
    backlog_end: int,
    marker: Message | None,
    last: float = math.inf,
) -> AsyncGenerator[Batch, None]:
    """The messages for one browser, several at a time, as they come.

    Args:
        buffer: where they are.
        client_id: the number of the browser.
        backlog_end: number of the last message that was there when it came.
        marker: a message that goes out right behind that one.
        last: number of the last message that is for this browser.
    """
    walk = Walk(buffer, client_id)
    flush = buffer.event_loop.create_task(buffer.flush_event.wait())
    buffer.generator_cursors[client_id] = walk.last
    try:
        while not buffer.done:
            newest = int(min(buffer.message_counter - 1, last))
            batch = walk.next(newest if marker is None else min(newest, backlog_end))
            # viser forgets a removal when every browser has had it.
            done = walk.last if walk.last < last else buffer.message_counter - 1
            buffer.generator_cursors[client_id] = done
            replayed = walk.last >= min(backlog_end, last)
            if marker is not None and replayed and not walk.held:
                batch = batch.with_marker(marker)
                marker = None
            if batch.messages:
                yield batch
            else:
                await buffer.message_event.wait()
                buffer.message_event.clear()
            if not batch.messages or walk.last >= min(buffer.message_counter - 1, last):
                await asyncio.wait([flush], timeout=buffer.window_duration_sec)
                if flush.done() and not buffer.done:
                    buffer.flush_event.clear()
                    flush = buffer.event_loop.create_task(buffer.flush_event.wait())
    finally:
        buffer.generator_cursors.pop(client_id, None)
        flush.cancel()
        await asyncio.gather(flush, return_exceptions=True)


class Walk:
    """The way of one browser through the messages.

    Args:
        buffer: where they are.
        client_id: the number of the browser.

    Attributes:
        last: the number of the last message that it had, or that is not for it.
    """

    def __init__(self, buffer: Buffer, client_id: int) -> None:
        self.last = -1
        self._buffer = buffer
        self._client_id = client_id
        self._ahead: Sequence[int] = ()
        self._place = 0

    @property
    def held(self) -> bool:
        """Whether nothing may go out for now."""
        return self._buffer.atomic_counter != 0

    def next(self, end: int) -> Batch:
        """The next messages; none when there are none, or when they are held.

        Args:
            end: number of the last message that may be among them; never a smaller
                one than before.
        """
        found: list[tuple[int, Message]] = []
        most, heavy = self._buffer.max_window_size, 0
        while self.last < end and len(found) < most and heavy < HEAVY and not self.held:
            if self._place == len(self._ahead):
                self._ahead, self._place = self._numbers(end), 0
            number = self._ahead[self._place]
            message = self._buffer.message_from_id.get(number)
            if message is not None and message.excluded_self_client != self._client_id:
                more = weight(message)
                if found and more >= HEAVY:
                    break
                heavy += more
                found.append((number, message))
            self._place += 1
            self.last = number
            self._forget(number)
        numbers, messages = tuple(n for n, _ in found), [m for _, m in found]
        return Batch(numbers, messages, heavy)

    def _numbers(self, end: int) -> Sequence[int]:
        """The numbers to ask for, up to `end`, which is the last of them."""
        messages = self._buffer.message_from_id
        if end - self.last <= len(messages):
            return range(self.last + 1, end + 1)
        # Another thread may add a message at any moment.
        with self._buffer.buffer_lock:
            there = [number for number in messages if self.last < number < end]
        return [*there, end]

    def _forget(self, number: int) -> None:
        if not self._buffer.persistent_messages:
            with self._buffer.buffer_lock:
                self._buffer.pop_message_locked(number)
