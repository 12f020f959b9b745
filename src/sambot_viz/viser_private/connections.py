"""The connections of browsers, and what viser writes on the terminal."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import (
    Callable,
    Generator,
)
from typing import Any, cast

import rich
import viser
from websockets.asyncio.server import ServerConnection


def on_connection(
    server: viser.ViserServer, prepare: Callable[[int, ServerConnection], object]
) -> None:
    """Call `prepare` with the number and connection of every browser to come.

    viser does so before it reads from the connection or sends anything to it.
    """
    websocket = cast(Any, server)._websock_server

    def connected(browser: Any) -> None:
        prepare(browser.client_id, websocket._live_connections[browser.client_id])

    websocket.on_client_connect(connected)


def connection_of(server: viser.ViserServer, client_id: int) -> ServerConnection:
    """The connection of a browser.

    Raises:
        KeyError: it has ended.
    """
    return cast(Any, server)._websock_server._live_connections[client_id]


@contextlib.contextmanager
def larger_messages(client: viser.ClientHandle, most: int) -> Generator[None]:
    """Let a browser send longer messages for a while, for a picture.

    Args:
        client: the browser.
        most: length of a message [bytes].
    """
    server: Any = cast(Any, client)._viser_server
    connection = server._websock_server._live_connections.get(client.client_id)
    before = None if connection is None else connection.protocol.max_message_size
    if connection is not None:
        connection.protocol.max_message_size = most
    try:
        yield
    finally:
        if connection is not None:
            connection.protocol.max_message_size = before


def allow_late_messages(client: viser.ClientHandle) -> None:
    """Let viser drop messages to a browser that has left without a warning.

    A browser may leave at any moment, also while its session is drawn.
    """
    buffer = cast(Any, client)._websock_connection.get_message_buffer()
    buffer._warned_push_after_done = True


@contextlib.contextmanager
def without_banner() -> Generator[None]:
    """Keep viser's own lines off the terminal while it starts or stops.

    They are not made either: what rich imports to print a table costs as much as a
    tenth of viser.
    """
    before = rich.print
    rich.print = _print_nothing
    try:
        yield
    finally:
        rich.print = before


def _print_nothing(*_: object, **__: object) -> None:
    """Stand in for `rich.print`."""


def quiet_websockets() -> None:
    """Keep the tracebacks of half-open connections off the terminal.

    Browsers open connections on speculation and drop them; the websockets library
    logs each as an error with a traceback. A dropped connection does no harm here.
    """
    logging.getLogger("websockets.server").setLevel(logging.CRITICAL)
