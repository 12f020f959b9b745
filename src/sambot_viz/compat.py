"""Every use of a private name of viser, each with its reason and a test.

viser is pinned to a minor version (pyproject.toml); tests/test_compat.py fails when
one of these names has moved.
"""

from __future__ import annotations

import contextlib
import inspect
import logging
from collections.abc import Iterator
from typing import Any

import rich
import viser
from viser import _messages  # pyright: ignore[reportPrivateUsage]


def drop_share_handlers(server: viser.ViserServer) -> None:
    """Take away the messages with which any browser could open a public tunnel.

    Hiding the button only hides the button (spec/viser.md §4, "Share").
    """
    connection = server._websock_server  # pyright: ignore[reportPrivateUsage]
    handlers = connection._incoming_handlers  # pyright: ignore[reportPrivateUsage]
    handlers.pop(_messages.ShareUrlRequest, None)
    handlers.pop(_messages.ShareUrlDisconnect, None)


def guard_gui_updates(server: viser.ViserServer) -> None:
    """Let browsers set the value of a widget and nothing else of it.

    viser would take any attribute of the handle's state: one message with
    ``{"update_cb": []}`` takes all callbacks away for everybody.
    """
    connection = server._websock_server  # pyright: ignore[reportPrivateUsage]
    handlers = connection._incoming_handlers  # pyright: ignore[reportPrivateUsage]
    inner = list(handlers.get(_messages.GuiUpdateMessage, ()))

    async def only_values(client_id: int, message: Any) -> None:
        if set(message.updates) == {"value"}:
            for handler in inner:
                result = handler(client_id, message)
                if inspect.isawaitable(result):
                    await result

    handlers[_messages.GuiUpdateMessage] = [only_values]


@contextlib.contextmanager
def without_banner() -> Iterator[None]:
    """Keep viser's own lines off the terminal while it starts or stops."""
    console = rich.get_console()
    before = console.quiet
    console.quiet = True
    try:
        yield
    finally:
        console.quiet = before


def quiet_websockets() -> None:
    """Keep the tracebacks of half-open connections off the terminal.

    Browsers open connections on speculation and drop them; the websockets library
    logs each as an error with a traceback. A dropped connection harms nobody here.
    """
    logging.getLogger("websockets.server").setLevel(logging.CRITICAL)
