"""What goes out to all clients of a server, counted."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol


class Sending(Protocol):
    """A client that something is sent to."""

    def waits(self) -> float:
        """Return for how long it has not taken what is sent to it [s]."""
        ...


@dataclass(eq=False, slots=True)
class Traffic:
    """Counts what is sent; on the event loop of the server.

    Attributes:
        frames: messages that were given to clients, also to those that have left.
        sent: the same [bytes].
        clients: those that are connected.
    """

    frames: int = 0
    sent: int = 0
    clients: set[Sending] = field(default_factory=set[Sending])

    def slowest(self) -> float:
        """Return for how long the slowest client has not taken a message [s]."""
        return max((client.waits() for client in self.clients), default=0.0)
