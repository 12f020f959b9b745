"""What goes out to clients: the buffers of messages, and how these are packed."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import (
    Awaitable,
    Callable,
    Coroutine,
    Generator,
    Sequence,
)
from typing import Any, Protocol, cast

import viser
from viser import _messages  # pyright: ignore[reportPrivateUsage]
from viser.infra import (
    _infra,  # pyright: ignore[reportPrivateUsage]
)

from sambot_viz.viser_private.moving_poses import MovingPoses


class Message(Protocol):
    """The fields of a message of viser that are read.

    Attributes:
        excluded_self_client: the number of a client that does not get it.
    """

    excluded_self_client: int | None


class MessageBuffer(Protocol):
    """The fields of viser's buffer of messages that `server.outgoing` uses.

    Attributes:
        event_loop: that of the server.
        persistent_messages: whether messages stay for clients that come later.
        message_event: set when there is something new.
        flush_event: set when what there is shall go out at once.
        message_counter: the number of the next message.
        message_from_id: the messages by number, in this order.
        buffer_lock: for changes of `message_from_id`.
        max_window_size: messages that go out together at most.
        window_duration_sec: how long messages are collected [s].
        done: whether the server or the client has ended.
        atomic_counter: above 0 nothing goes out.
        generator_cursors: the number of the last message that each client had.
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


def broadcast_buffer(server: viser.ViserServer) -> Any:
    """Return the buffer of the messages for all clients of a server."""
    return cast(Any, server)._websock_server._broadcast_buffer


def own_buffer(server: viser.ViserServer, client_id: int) -> Any:
    """Return the buffer of the messages for one client of a server."""
    return (
        cast(Any, server)
        ._websock_server._client_state_from_id[client_id]
        .message_buffer
    )


MORE_FOLLOWS = "~more"
"""The name in that message. To viser it is that of a node that is not there."""


def more_follows() -> Any:
    """Return what says that the next messages belong to those before it.

    The page takes it out (messages.js).
    """
    return _messages.SetPositionMessage(MORE_FOLLOWS, (0.0, 0.0, 0.0))


class WindowLoop(Protocol):
    """What viser asks for the messages of a browser."""

    async def __anext__(self) -> Sequence[Any]:
        """The next messages; they are packed, and sent as one."""
        ...

    async def aclose(self) -> None:
        """The browser has left."""


def replace_window_loop(
    buffer: Any, loop: Callable[[int, int, Any], WindowLoop]
) -> None:
    """Have viser ask another loop for what goes out to a browser.

    Args:
        buffer: one of viser's buffers of messages.
        loop: is called with a browser's number, the number of the last message there
            was when it came, and a message to send behind that one.
    """
    vars(buffer)["_window_loop"] = loop


def replace_flush(
    buffer: Any, change_ended: Callable[[], None], flush: Callable[[], None]
) -> None:
    """Have a buffer call others when what it has shall go out at once.

    Args:
        buffer: one of viser's buffers of messages.
        change_ended: is called when no change is being made any more (`atomic`).
        flush: is called in place of the buffer's own flush.
    """
    poses = MovingPoses.of(buffer)

    def atomic_end() -> None:
        with buffer.buffer_lock:
            buffer.atomic_counter -= 1
            is_last = buffer.atomic_counter == 0
            if is_last:
                poses.change_ended()
        if is_last:
            change_ended()

    buffer.atomic_end, buffer.flush = atomic_end, flush


class Packer:
    """Packs messages as viser does, by the function of viser that sends them.

    That function gets its messages from here, and sends what it has packed to here.
    """

    done = False

    def __init__(self) -> None:
        self._packed = b""
        self._start()

    def _start(self) -> None:
        self._producer: Coroutine[Any, Any, None] = cast(Any, _infra)._message_producer(
            self, self, 0
        )
        self._producer.send(None)

    def pack(self, messages: Sequence[Any]) -> bytes:
        """What goes over the wire for these messages.

        Raises:
            Exception: of viser, for a message that cannot be packed.
        """
        try:
            self._producer.send(messages)
        except BaseException:
            self._start()
            raise
        packed, self._packed = self._packed, b""
        return packed

    def window_generator(self, *_: Any, **__: Any) -> Packer:
        """For viser: where it gets its messages."""
        return self

    def __anext__(self) -> Awaitable[Sequence[Any]]:
        """For viser: the next messages."""
        return _NextCall()

    async def aclose(self) -> None:
        """For viser: it wants no more."""

    async def send(self, data: bytes) -> None:
        """For viser: what it has packed."""
        self._packed = data


class _NextCall:
    """Waits for the next call of `Packer.pack`, and is what that was given."""

    def __await__(self) -> Generator[None, Sequence[Any], Sequence[Any]]:
        return (yield)
