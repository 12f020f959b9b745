"""Limit the number of open pages and connections.

Every page costs memory, and every connection a file descriptor. A page too many says
so, and reloads by itself after another one has closed. A connection too many gets one
answer: probes of the server's state get theirs, pages come again later.

One weakness remains: a user of the server can take all its places. Limits per address
would not help, because all users behind one proxy, or in one school, share an address.
"""

from __future__ import annotations

import http

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Response

from sambot_viz import limits
from sambot_viz.server.connections.page_files import plain_page

_OWN_FILES = 400
"""File descriptors that stay free: for files, and for connections that the event loop
accepts, 100 at a time, before this limit counts them."""
_ANSWERED = 50
"""Connections too many that stay open until they are answered; the one that has not
asked for longest gives way to the next."""
_AGAIN = 10
"""Time after which a page that found no place reloads [s]."""


class ConnectionLimiter:
    """Count the connections of one server, and refuse those that are too many."""

    def __init__(self) -> None:
        least, free = _OWN_FILES // 4, _file_numbers() - _OWN_FILES
        self._most = min(limits.CONNECTIONS.value, max(least, free))
        self._open: set[ServerConnection] = set()
        self._surplus: dict[ServerConnection, None] = {}

    def admit(self, connection: ServerConnection) -> None:
        """Count a new connection; one too many may end another one."""
        if len(self._open) < self._most:
            self._open.add(connection)
            return
        self._surplus[connection] = None
        if len(self._surplus) > _ANSWERED:
            next(iter(self._surplus)).transport.abort()

    def may_stay(self, connection: ServerConnection) -> bool:
        """Return whether a connection may be more than one answer."""
        if connection in self._surplus and len(self._open) < self._most:
            del self._surplus[connection]
            self._open.add(connection)
        return connection in self._open

    def lost(self, connection: ServerConnection) -> None:
        """Forget a connection that has ended."""
        self._open.discard(connection)
        self._surplus.pop(connection, None)

    def is_full(self, pages: int) -> bool:
        """Return whether one more page would exceed the limit."""
        return pages >= limits.PAGES.value

    def refusal(self) -> Response:
        """Return the answer to a page too many."""
        return _later(
            "Too many pages are open",
            f"This robot is shown in {limits.PAGES.value} pages already. This page "
            "loads again by itself, until one is closed.",
        )

    def surplus(self) -> Response:
        """Return the answer to a connection too many."""
        return _later(
            "Too many connections are open",
            f"This server has {self._most} connections already. This page loads again "
            "by itself.",
        )


def _later(title: str, text: str) -> Response:
    status = http.HTTPStatus.SERVICE_UNAVAILABLE
    again = {"Retry-After": str(_AGAIN), "Refresh": str(_AGAIN)}
    return plain_page(status, title, text, again)


def _file_numbers() -> int:
    """Return how many files and connections the system allows this program."""
    try:
        import resource
    except ImportError:
        return 10 * limits.CONNECTIONS.value
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return 10 * limits.CONNECTIONS.value if soft == resource.RLIM_INFINITY else soft
