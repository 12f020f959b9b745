"""What the request for a page's connection says of its user: who, and which robot."""

from __future__ import annotations

import weakref
from dataclasses import dataclass

from websockets.asyncio.server import ServerConnection

COPY = "/copy"
"""Below this path, a page shows a copy of the shared robot that is its user's own."""


@dataclass(frozen=True, slots=True)
class Visitor:
    """The user of one connection.

    Attributes:
        presenter: whether it was opened by the presenter's link.
        copy: whether it is to show a copy of the shared session.
    """

    presenter: bool = False
    copy: bool = False


_visitors: weakref.WeakKeyDictionary[ServerConnection, Visitor] = (
    weakref.WeakKeyDictionary()
)


def note(connection: ServerConnection, visitor: Visitor) -> None:
    """Remember what the request for a connection has said."""
    _visitors[connection] = visitor


def visitor_of(connection: ServerConnection) -> Visitor:
    """Who has opened a connection."""
    return _visitors.get(connection, Visitor())


def without_copy(path: str) -> tuple[str, bool]:
    """The path of a request without `COPY`, and whether that was in it."""
    where, mark, query = path.partition("?")
    if where != COPY and not where.startswith(f"{COPY}/"):
        return path, False
    return f"{where[len(COPY) :] or '/'}{mark}{query}", True
