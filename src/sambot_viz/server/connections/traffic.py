"""Counts of the messages to all clients of a server."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol


class Sending(Protocol):
    """A client that receives messages."""

    def waits(self) -> float:
        """Return how long a message has been waiting for the client [s]."""
        ...


@dataclass(eq=False, slots=True)
class Traffic:
    """Counts outgoing messages, on the event loop of the server.

    Attributes:
        frames: number of messages to clients, including clients that have left.
        sent: their size [bytes].
        clients: connected clients.
    """

    frames: int = 0
    sent: int = 0
    clients: set[Sending] = field(default_factory=set[Sending])

    def slowest(self) -> float:
        """Return how long the slowest client has kept a message waiting [s]."""
        return max((client.waits() for client in self.clients), default=0.0)
