"""A clock that a test moves by hand, where the session has the computer's."""

from __future__ import annotations

import threading


class HandClock:
    """A time that goes on when a test says so, and wakes whoever waits for it."""

    def __init__(self) -> None:
        self._time = 1000.0
        self._waiting: set[threading.Condition] = set()

    def now(self) -> float:
        return self._time

    def wait(self, changed: threading.Condition, until: float | None) -> None:
        # First it is known to `advance`, and then it looks: none of the two is missed.
        self._waiting.add(changed)
        if until is None or self._time < until:
            changed.wait()

    def advance(self, seconds: float) -> None:
        """Let the time go on [s]."""
        self._time += seconds
        for changed in tuple(self._waiting):
            with changed:
                changed.notify_all()
