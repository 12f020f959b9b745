"""How many may be here at a time.

Every browser costs memory, every connection a file number of the system. Who comes when
the place is full reads so, and the page loads again by itself when someone has left.

What stays weak: whoever may use the server can also take all its places. Places are not
counted by address, because all who come through a proxy, or from one school, have the
same one.
"""

from __future__ import annotations

import asyncio
import http
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Response

from sambot_viz.server.frames import limit_frames
from sambot_viz.server.plain_page import plain_page

MOST_BROWSERS = 200
"""So many pages may be open."""
MOST_CONNECTIONS = 500
"""So many connections, also of those that have not asked for anything yet."""
_OWN_FILES = 400
"""Of the system's file numbers, so many are left: for files, and for connections that
the event loop accepts, 100 at a time, before they are counted."""
_AGAIN = 10
"""A page that found no place loads again after so long [s]."""


class Crowd:
    """Counts the connections of one server, and sends away those that are too many."""

    def __init__(self) -> None:
        most = min(MOST_CONNECTIONS, max(_OWN_FILES // 4, _file_numbers() - _OWN_FILES))
        here: set[ServerConnection] = set()

        class Counted(ServerConnection):
            """A connection that is closed at once when there are too many."""

            def __init__(self, *arguments: Any, **settings: Any) -> None:
                super().__init__(*arguments, **settings)
                limit_frames(self)

            def connection_made(self, transport: asyncio.BaseTransport) -> None:
                super().connection_made(transport)
                here.add(self)
                if len(here) > most:
                    self.transport.abort()

            def data_received(self, data: bytes) -> None:
                """Read on, but not for ever from one that was told to close."""
                end = self.close_deadline
                if end is not None and self.loop.time() > end:
                    self.transport.abort()
                else:
                    super().data_received(data)

            def connection_lost(self, exc: Exception | None) -> None:
                here.discard(self)
                super().connection_lost(exc)

        self.connection = Counted

    def is_full(self, connection: ServerConnection) -> bool:
        """Whether so many pages are open that this one has no place."""
        return len(connection.server.connections) >= MOST_BROWSERS

    def refusal(self) -> Response:
        """What is answered then."""
        return plain_page(
            http.HTTPStatus.SERVICE_UNAVAILABLE,
            "There is no place left at the moment",
            f"This robot is shown in {MOST_BROWSERS} pages already. This page loads "
            "again by itself, until someone leaves.",
            {"Retry-After": str(_AGAIN), "Refresh": str(_AGAIN)},
        )


def _file_numbers() -> int:
    """How many files and connections the system lets this program have."""
    try:
        import resource
    except ImportError:
        return 10 * MOST_CONNECTIONS
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return 10 * MOST_CONNECTIONS if soft == resource.RLIM_INFINITY else soft
