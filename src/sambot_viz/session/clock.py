"""The time of a session: the computer's now; that of a recording or of ROS later."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """Gives the time to all parts of a session that ask for it."""

    def now(self) -> float:
        """Return the time [s]; differences count, the start may be anything."""
        ...


class WallClock:
    """The time of the computer, which never goes back."""

    def now(self) -> float:
        """Return the time since some start [s]."""
        return time.monotonic()
