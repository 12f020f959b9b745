"""What became of a goal, as the status of Nav2's action says it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

_ENDS = {4: "reached", 5: "cancelled", 6: "not reached: the robot has given it up"}
_ON_THE_WAY = {1: "accepted", 2: "on the way", 3: "being cancelled"}


@dataclass(frozen=True, slots=True)
class Outcome:
    """How far a goal is.

    Attributes:
        words: in words.
        is_over: nothing more becomes of it.
        is_good: it was not refused, cancelled or given up.
    """

    words: str
    is_over: bool
    is_good: bool


class GoalFollower:
    """Follows the first goal that a robot tells of after `begin`.

    A goal that is sent as a message has no name by which it could be known again.
    """

    def __init__(self) -> None:
        self._before: set[bytes] = set()
        self._has_begun = False
        self._goal: bytes | None = None
        self._last = 0

    def begin(self) -> None:
        """Know all goals that were told of until now as others."""
        self._has_begun = True

    def take(self, statuses: Iterable[Any]) -> Outcome | None:
        """Take the goals of a GoalStatusArray; return what is new of the goal."""
        for status in statuses:
            goal = _id_of(status)
            if not self._has_begun:
                self._before.add(goal)
            elif self._goal is None and goal not in self._before:
                self._goal = goal
            if goal == self._goal and int(status.status) != self._last:
                self._last = int(status.status)
                return _outcome(self._last)
        return None


def _outcome(status: int) -> Outcome | None:
    if status in _ENDS:
        return Outcome(_ENDS[status], True, status == 4)
    if status in _ON_THE_WAY:
        return Outcome(_ON_THE_WAY[status], False, True)
    return None


def _id_of(status: Any) -> bytes:
    return bytes(status.goal_info.goal_id.uuid)
