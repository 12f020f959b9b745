"""Goals that are followed as long as the connection lasts over which they were sent."""

from __future__ import annotations

from typing import Protocol

FOLLOWED = 8
"""The newest goals that are followed; a robot may never answer about one."""
LOST = "the connection was lost"


class FollowedGoal(Protocol):
    """A goal that was sent to an action."""

    def leave(self, why: str) -> None:
        """Say why it is followed no further."""
        ...


class FollowedGoals:
    """The goals that were sent over a connection and have not ended."""

    def __init__(self) -> None:
        self._goals: dict[FollowedGoal, None] = {}

    def add(self, goal: FollowedGoal) -> None:
        """Follow one more, and the oldest no further where they are too many."""
        if len(self._goals) >= FOLLOWED:
            next(iter(self._goals)).leave("newer goals are followed")
        self._goals[goal] = None

    def discard(self, goal: FollowedGoal) -> None:
        """One has ended."""
        self._goals.pop(goal, None)

    def end(self) -> None:
        """The connection has ended."""
        for goal in tuple(self._goals):
            goal.leave(LOST)
