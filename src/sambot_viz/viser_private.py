"""Every use of a private name of viser, each with its reason and a test.

viser is pinned to a minor version (pyproject.toml); tests/test_viser_private.py fails
when one of these names has moved.
"""

from __future__ import annotations

import contextlib
import functools
import inspect
import logging
from collections.abc import Callable, Generator
from typing import Any, cast

import rich
import viser
from viser import (
    _assignable_props_api,  # pyright: ignore[reportPrivateUsage]
    _messages,  # pyright: ignore[reportPrivateUsage]
)

Handler = Callable[[Any, Any], Any]


def _handlers(server: viser.ViserServer) -> dict[type, list[Handler]]:
    """What the server does with each type of message from a browser."""
    connection = server._websock_server  # pyright: ignore[reportPrivateUsage]
    return cast(
        dict[type, list[Handler]],
        connection._incoming_handlers,  # pyright: ignore[reportPrivateUsage, reportUnknownMemberType]
    )


def drop_share_handlers(server: viser.ViserServer) -> None:
    """Take away the messages with which any browser could open a public tunnel.

    Hiding the button only hides the button (spec/viser.md §4, "Share").
    """
    handlers = _handlers(server)
    handlers.pop(_messages.ShareUrlRequest, None)
    handlers.pop(_messages.ShareUrlDisconnect, None)


def guard_gui_updates(server: viser.ViserServer) -> None:
    """Let browsers set the value of a widget and nothing else of it.

    viser would take any attribute of the handle's state: one message with
    ``{"update_cb": []}`` takes all callbacks away for everybody.
    """
    handlers = _handlers(server)
    inner = list(handlers.get(_messages.GuiUpdateMessage, ()))

    async def only_values(client_id: Any, message: Any) -> None:
        if set(message.updates) == {"value"}:
            for handler in inner:
                result = handler(client_id, message)
                if inspect.isawaitable(result):
                    await result

    handlers[_messages.GuiUpdateMessage] = [only_values]


def node_count(scene: viser.SceneApi) -> int:
    """How many nodes a scene has: a page that shows as many shows all of it."""
    return len(scene._handle_from_node_name)  # pyright: ignore[reportPrivateUsage]


def is_removed(handle: viser.SceneNodeHandle) -> bool:
    """Whether a node is gone, itself or with one above it; viser warns then."""
    return handle._impl.removed  # pyright: ignore[reportPrivateUsage]


def set_tab_label(tab: viser.GuiTabHandle, label: str) -> None:
    """Write something else on a tab; viser only changes its icon."""
    if tab._label != label:  # pyright: ignore[reportPrivateUsage]
        tab._label = label  # pyright: ignore[reportPrivateUsage]
        tab._parent._rebuild_tab_props()  # pyright: ignore[reportPrivateUsage]


def remember_prop_types() -> None:
    """Let viser find out the types of a kind of node once, not for every node.

    It is half of what a node costs: 0.5 ms, for each of the 900 nodes of a robot of
    300 links. The widgets of viser are remembered by viser itself.
    """
    module: Any = _assignable_props_api
    if not hasattr(module.get_type_hints, "cache_info"):
        module.get_type_hints = functools.cache(module.get_type_hints)


@contextlib.contextmanager
def without_banner() -> Generator[None]:
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
