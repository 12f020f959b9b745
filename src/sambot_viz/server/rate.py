"""How often something may happen."""

from __future__ import annotations

import time


class Rate:
    """Lets so many events pass in a second, after a burst, and holds back the rest.

    Args:
        per_second: events in the long run [1/s].
        burst: events that may come at once.
    """

    def __init__(self, per_second: float, burst: float) -> None:
        self._per_second = per_second
        self._burst = self._left = burst
        self._at = time.monotonic()

    def take(self) -> float:
        """Count one event; returns how long it has to wait [s]."""
        now = time.monotonic()
        self._left += (now - self._at) * self._per_second
        self._left = min(self._left, self._burst) - 1.0
        self._at = now
        return max(0.0, -self._left / self._per_second)
