"""Widgets of a program, and pictures that a browser is asked for."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import (
    Mapping,
)
from typing import Any, cast

import viser
from viser import (
    _messages,  # pyright: ignore[reportPrivateUsage]
)

from sambot_viz.viser_private.connections import larger_messages


def _client(server: viser.ViserServer, client_id: int) -> Any:
    """The handle of a browser that has reported its camera, or None."""
    return cast(Any, server)._connected_clients.get(client_id)


def input_handle(server: viser.ViserServer, client_id: int, uuid: str) -> Any:
    """The widget of this id in a browser's page, common or its own; None: no such."""
    client = _client(server, client_id)
    for gui in (server.gui, *(() if client is None else (client.gui,))):
        handle = cast(Any, gui)._gui_input_handle_from_uuid.get(uuid)
        if handle is not None:
            return handle
    return None


def is_for_all(server: viser.ViserServer, uuid: str) -> bool:
    """Whether the widget of this id is common to all browsers."""
    return uuid in cast(Any, server.gui)._gui_input_handle_from_uuid


def send_value(server: viser.ViserServer, client_id: int, handle: Any) -> None:
    """Send a widget's present value to one browser, which shows another one."""
    client = _client(server, client_id)
    if client is not None:
        client._websock_connection.queue_message(
            _messages.GuiUpdateMessage(handle._impl.uuid, {"value": handle.value})
        )


def awaits_picture(server: viser.ViserServer, client_id: int) -> bool:
    """Whether a browser was asked for a picture that has not come yet."""
    client = _client(server, client_id)
    if client is None:
        return False
    handlers = client._websock_connection._incoming_handlers
    return bool(handlers.get(_messages.GetRenderResponseMessage))


async def drawn_by(
    client: viser.ClientHandle,
    width: int,
    height: int,
    camera: Mapping[str, Any],
    timeout: float,
) -> bytes:
    """Have a browser draw its view; viser's own way holds a thread while it waits.

    Args:
        client: the browser.
        width: of the picture [pixels].
        height: of the picture [pixels].
        camera: its pose and angle: position, wxyz and fov.
        timeout: the browser gets this long [s].

    Returns:
        What the browser sent, which should be a PNG file.

    Raises:
        TimeoutError: it sent nothing in time.
    """
    connection = cast(Any, client)._websock_connection
    number = secrets.token_hex(8)
    arrived: asyncio.Future[bytes] = asyncio.get_running_loop().create_future()

    def take(_: int, message: Any) -> None:
        if message.render_uuid == number and not arrived.done():
            arrived.set_result(message.payload)

    answer = _messages.GetRenderResponseMessage
    connection.register_handler(answer, take)
    try:
        # Four bytes for each pixel, if the browser compresses nothing.
        with larger_messages(client, 5 * width * height + 2**16):
            cast(Any, client)._viser_server.flush()
            connection.queue_message(
                _messages.GetRenderRequestMessage(
                    "image/png", height, width, 80, render_uuid=number, **camera
                )
            )
            client.flush()
            try:
                return await asyncio.wait_for(arrived, timeout)
            except asyncio.TimeoutError:
                raise TimeoutError from None
    finally:
        connection.unregister_handler(answer, take)
