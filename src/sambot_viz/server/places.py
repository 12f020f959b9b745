"""Where sessions live: a thread for the one of all clients, or one for each client."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

from sambot_viz.panels.window import Window
from sambot_viz.session import Session
from sambot_viz.session.worker import Worker


@dataclass(eq=False)
class SessionPlace:
    """A thread, the session that lives in it, and its window, as they come."""

    worker: Worker
    session: Session | None = None
    window: Window | None = None


class SessionPlaces:
    """The places of a server: that of all clients, and those of single ones.

    Args:
        make_worker: starts a thread.

    Attributes:
        lock: held while places change, and what a session that opens begins with.
        closed: set at the end; nothing opens after it.
    """

    def __init__(self, make_worker: Callable[[], Worker]) -> None:
        self._make_worker = make_worker
        self._by_client: dict[int | None, SessionPlace] = {}
        self.lock = threading.RLock()
        self.closed = False

    def add(self, client_id: int | None) -> SessionPlace:
        """Make the place of a client; None for that of all."""
        place = SessionPlace(self._make_worker())
        with self.lock:
            self._by_client[client_id] = place
        return place

    def remove(self, client_id: int) -> None:
        """Forget the place of a client."""
        with self.lock:
            del self._by_client[client_id]

    @property
    def of_all(self) -> SessionPlace | None:
        """The place of all clients; None when each has its own."""
        return self._by_client.get(None)

    @property
    def shared(self) -> Session | None:
        """The session of all clients; None when each has its own."""
        place = self.of_all
        return None if place is None else place.session

    @property
    def copies(self) -> int:
        """The number of places of single clients that have a session."""
        with self.lock:
            places = list(self._by_client.items())
        return sum(n is not None and p.session is not None for n, p in places)

    def own(self, client_id: int) -> SessionPlace | None:
        """Return the place that a client has to itself; None when it has none."""
        return self._by_client.get(client_id)

    def of(self, client_id: int) -> SessionPlace | None:
        """Return the place where a client is."""
        return self.own(client_id) or self.of_all

    def all(self) -> list[SessionPlace]:
        """Return all places there are at the moment."""
        with self.lock:
            return list(self._by_client.values())
