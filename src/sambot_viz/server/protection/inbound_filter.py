"""The inbound filter: checks messages against a short list before viser sees them.

viser itself takes any message from anyone: any attribute of a widget, uploads of any
size, values that cannot be sent to the other browsers. Here a client may report its
camera, set a script's visible and enabled widget to a value of the widget's type,
click or draw a rectangle with the current tool, and send the picture that the server
has requested. The filter drops everything else: clicks on nodes, drags, transform
controls, held buttons, command keys, forms, uploads. It accepts no other message from a
browser before the first camera, because viser runs no callback, and so none of our
checks, before that. Messages about our rows come through the page's own channel
(`server.channel`).

Each message has a size limit, and each browser a rate limit: the server slows down a
browser that sends more, by reading less from its connection. It disconnects a browser
that does not read its messages.
"""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable, Sequence
from typing import Any, Protocol, cast

import viser
from websockets.protocol import State

from sambot_viz import limits, viser_private
from sambot_viz.outlet import logger
from sambot_viz.panels.rows.row_store import ClientRows
from sambot_viz.server.connections.connection import Connection
from sambot_viz.server.connections.rate_limit import InFlightLimit
from sambot_viz.server.protection.client_messages import (
    CameraMoved,
    CameraReport,
    ClientMessage,
    Point,
    SetValue,
    decode,
)

CLOSE_TIME = 1.0
"""Longest wait, at the program's end, for a browser to close its connection [s]."""
LOG_PERIOD = 10.0
"""Shortest time between two reports of refused messages [s]."""
_LARGEST_INT = 2**53
"""Integers beyond this one are not exact in a browser."""

_log = logger(__name__)


class ClientHandler(Protocol):
    """Handles messages that pass the filter; numbers identify the clients."""

    def take_edit(self, client_id: int, edit: object) -> None:
        """Handle an edit of a row, on the event loop, after a check of permissions."""
        ...

    def take_camera(self, client_id: int, report: CameraReport) -> None:
        """Handle a page's report of its camera, on the event loop."""
        ...

    def may_edit(self, client_id: int) -> bool:
        """Return whether a client may set a program's widgets, which all see."""
        ...

    def behind(self, client_id: int, action: Callable[[], None]) -> None:
        """Run an action, in any thread, after all effects of a client so far."""
        ...

    def rows_of(self, client_id: int) -> ClientRows | None:
        """Return the rows of a client; None before it has any."""
        ...


class NoSessions:
    """Handles clients while there is no session: drops their edits."""

    def take_edit(self, client_id: int, edit: object) -> None:
        """Drop an edit."""

    def take_camera(self, client_id: int, report: CameraReport) -> None:
        """Drop a report."""

    def may_edit(self, client_id: int) -> bool:
        """Return that a client may set widgets."""
        return True

    def behind(self, client_id: int, action: Callable[[], None]) -> None:
        """Run an action."""
        action()

    def rows_of(self, client_id: int) -> ClientRows | None:
        """Return that there are no rows."""
        return None


class InboundFilter:
    """Checks the messages of one client.

    Args:
        server: the server.
        handler: returns the current receiver of edits.
        client_id: the client's number.
        connection: the client's connection.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        handler: Callable[[], ClientHandler],
        client_id: int,
        connection: Connection,
    ) -> None:
        self._server = server
        self._handler = handler
        self._client_id = client_id
        self._connection = connection
        self._known = False
        self._in_flight = InFlightLimit(self._behind)

    async def read(self) -> bytes:
        """Return the next message that may be handled."""
        while True:
            raw = await self._connection.receive()
            pause = self._connection.rate.take()
            if pause > 0.0:
                if self._connection.state is not State.OPEN:
                    # The client left during a flood; its messages can be dropped.
                    continue
                await asyncio.sleep(pause)
            await self._in_flight.wait()
            message = decode(raw) if isinstance(raw, bytes) else None
            reason = self._reason_against(message)
            if reason is not None:
                report(self._client_id, reason)
            else:
                return cast(bytes, raw)

    def _behind(self, action: Callable[[], None]) -> None:
        self._handler().behind(self._client_id, action)

    def _reason_against(self, message: ClientMessage | None) -> str | None:
        """Return why a message must be refused; None when it may be handled."""
        if message is None:
            return "not one of the messages that a page of this server sends"
        if isinstance(message, CameraMoved):
            if not message.shows_a_direction():
                return "a camera without a direction"
            self._known = True
            return None
        if not self._known:
            return "a message before the first camera"
        if isinstance(message, SetValue):
            return self._reason_against_value(message)
        if isinstance(message, Point):
            return _reason_against_gesture(message)
        expected = viser_private.awaits_picture(self._server, self._client_id)
        return None if expected else "a picture that was not asked for"

    def _reason_against_value(self, message: SetValue) -> str | None:
        if set(message.updates) != {"value"}:
            return "an attribute of a widget other than its value"
        handle = self._usable(message.uuid)
        if handle is None:
            return "a value for a widget that is not there, hidden or disabled"
        if not self._may_set(message.uuid):
            viser_private.send_value(self._server, self._client_id, handle)
            return "a value from a viewer"
        value = message.updates["value"]
        options: Sequence[str] | None = getattr(handle, "options", None)
        if fits(handle.value, value) and (options is None or value in options):
            return None
        # The page shows its user's input; send it the value that the server keeps.
        viser_private.send_value(self._server, self._client_id, handle)
        return "a value that is not of its widget's type"

    def _may_set(self, uuid: str) -> bool:
        """Return whether a client may set a widget, its own or a common one."""
        shared = viser_private.is_for_all(self._server, uuid)
        return not shared or self._handler().may_edit(self._client_id)

    def _usable(self, uuid: str) -> viser.GuiInputHandle[Any] | None:
        """Return the widget, if this client's user can see and use it."""
        handle = viser_private.input_handle(self._server, self._client_id, uuid)
        usable = handle is not None and handle.visible and not handle.disabled
        return handle if usable else None


def fits(held: object, value: object) -> bool:
    """Return whether a value has the type of a widget's value."""
    if isinstance(held, bool):
        return isinstance(value, bool)
    if isinstance(held, int | float):
        if isinstance(value, bool) or not isinstance(value, int | float):
            return False
        largest = _LARGEST_INT if isinstance(held, int) else math.inf
        return math.isfinite(value) and abs(value) <= largest
    if isinstance(held, str):
        return isinstance(value, str) and len(value) <= limits.PAGE_TEXT.value
    if isinstance(held, tuple) and isinstance(value, list):
        pair = cast(tuple[object, ...], held), cast(list[object], value)
        return len(pair[0]) == len(pair[1]) and all(map(fits, *pair))
    return False


def _reason_against_gesture(message: Point) -> str | None:
    if message.event_type == "rect-select":
        complete = len(message.screen_pos) == 2
    else:
        complete = message.ray_origin is not None and message.ray_direction is not None
    return None if complete else "half a click"


_next_report = 0.0


def report(client_id: int | None, reason: str) -> None:
    """Log a dropped message; rarely, because there may be many."""
    global _next_report
    if (now := time.monotonic()) >= _next_report:
        _next_report = now + LOG_PERIOD
        _log.warning("client %s: dropped %s", client_id, reason)
