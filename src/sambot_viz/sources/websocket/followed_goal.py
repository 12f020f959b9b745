"""A goal that is followed as long as the connection lasts over which it was sent."""

from __future__ import annotations

from typing import Protocol


class FollowedGoal(Protocol):
    """A goal that was sent to an action."""

    def lost(self) -> None:
        """The connection has ended: say so, and follow it no further."""
        ...
