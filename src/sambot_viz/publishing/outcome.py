"""What became of a goal, as the status of Nav2's action says it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from sambot_viz.errors import DecodeError
from sambot_viz.sources.action_names import (
    cancel_service,
    feedback_topic,
    result_service,
    status_topic,
)
from sambot_viz.sources.message import Recorded

GIVEN_UP = "not reached: the robot has given it up"
_ENDS = {4: "reached", 5: "cancelled", 6: GIVEN_UP}
_EXECUTES, _BETWEEN_LOOKS = 2, 0.5
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
    """Follows the first goal that a robot reports after `begin`.

    A goal that is sent as a message has no id by which it could be recognised.
    """

    def __init__(self) -> None:
        self._known: frozenset[bytes] | None = None
        self._goal: bytes | None = None
        self._waits = False
        self._last = 0
        self._left = ""
        self._next_look = 0.0

    @property
    def goal(self) -> bytes:
        """The id of the goal; empty while it is not known."""
        return self._goal or b""

    def begin(self) -> None:
        """Follow the next new goal: all that were told of until now are others."""
        self.forget()
        self._waits = True

    def forget(self) -> None:
        """Follow no goal."""
        self._goal, self._last, self._waits = None, 0, False

    def take(
        self, message: Recorded, decode: Callable[[Recorded], Any]
    ) -> Outcome | None:
        """Accept a GoalStatusArray; return the news about the goal.

        Args:
            message: its bytes; malformed ones are ignored.
            decode: decodes them; raises DecodeError.
        """
        try:
            statuses = decode(message).status_list
        except (DecodeError, AttributeError):
            return None
        told = {_id_of(one): int(one.status) for one in statuses}
        if self._known is None:
            # A latched message may come after `begin`: the ended goals in it are older.
            self._known = frozenset(goal for goal in told if told[goal] in _ENDS)
        known = self._known
        new = next((goal for goal in told if goal not in known), None)
        self._known = frozenset(told)
        if self._waits and new is not None:
            self._goal, self._waits = new, False
        return self.take_status(told.get(self._goal or b"", self._last))

    def take_status(self, status: int) -> Outcome | None:
        """Accept a number of GoalStatus; return the news about the goal."""
        if status == self._last:
            return None
        self._last = status
        return _outcome(status)

    def take_feedback(
        self, message: Recorded, decode: Callable[[Recorded], Any]
    ) -> Outcome | None:
        """Accept a NavigateToPose_FeedbackMessage; return the news about the goal.

        Nav2 sends a hundred in a second; two are read.
        """
        if not self.wants_distance():
            return None
        try:
            told = decode(message)
            if bytes(told.goal_id.uuid) != self._goal:
                return None
        except (DecodeError, AttributeError, TypeError):
            return None
        return self.take_distance(told)

    def wants_distance(self) -> bool:
        """Return whether it is time to look how far the goal is."""
        now = time.monotonic()
        if now < self._next_look or self._last != _EXECUTES:
            return False
        self._next_look = now + _BETWEEN_LOOKS
        return True

    def take_distance(self, message: Any) -> Outcome | None:
        """Accept a feedback message of the goal; return the news about it."""
        try:
            metres = float(message.feedback.distance_remaining)
            left = message.feedback.estimated_time_remaining
            seconds = float(left.sec) + float(left.nanosec) * 1e-9
        except (AttributeError, TypeError, ValueError):
            return None
        words = f"{metres:.1f} m"
        # Until it knows its speed, Nav2 says 0.
        if seconds >= 1.0:
            words += f", about {seconds:.0f} s"
        if not math.isfinite(metres) or words == self._left:
            return None
        self._left = words
        return Outcome(f"{_ON_THE_WAY[_EXECUTES]}: {words} left", False, True)


def navigator_of(topic: str) -> str:
    """Return the action of Nav2 that does what the goals of a topic ask for."""
    return f"{topic.rpartition('/')[0]}/navigate_to_pose"


def cancel_of(topic: str) -> str:
    """Return the service that cancels the goals of a topic; hidden in ROS."""
    return cancel_service(navigator_of(topic))


def result_of(topic: str) -> str:
    """Return the service that says why a goal of a topic has ended; hidden in ROS."""
    return result_service(navigator_of(topic))


def feedback_of(topic: str) -> str:
    """Return where Nav2 says how far the goals of a topic are; hidden in ROS."""
    return feedback_topic(navigator_of(topic))


def status_of(topic: str) -> str:
    """Return where Nav2 says what becomes of the goals of a topic; hidden in ROS."""
    return status_topic(navigator_of(topic))


def given_up(why: str) -> Outcome:
    """Return the end of a goal that the robot has given up, with its reason."""
    return Outcome(f"not reached: {why}" if why else GIVEN_UP, True, False)


def _outcome(status: int) -> Outcome | None:
    if status in _ENDS:
        return Outcome(_ENDS[status], True, status == 4)
    if status in _ON_THE_WAY:
        return Outcome(_ON_THE_WAY[status], False, True)
    return None


def _id_of(status: Any) -> bytes:
    return bytes(status.goal_info.goal_id.uuid)
