"""What goes out to browsers: its buffers, and how it is packed."""

from __future__ import annotations

from collections.abc import (
    Awaitable,
    Callable,
    Coroutine,
    Generator,
    Sequence,
)
from typing import Any, Protocol, cast

import viser
from viser.infra import (
    _infra,  # pyright: ignore[reportPrivateUsage]
)


def broadcast_buffer(server: viser.ViserServer) -> Any:
    """The messages for all browsers of a server."""
    return cast(Any, server)._websock_server._broadcast_buffer


def own_buffer(server: viser.ViserServer, client_id: int) -> Any:
    """The messages for one browser of a server."""
    return (
        cast(Any, server)
        ._websock_server._client_state_from_id[client_id]
        .message_buffer
    )


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
