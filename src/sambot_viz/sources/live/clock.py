"""The time at the peer, and how far what comes from it lags behind.

Ages and time-outs of displays run on the robot's clock, which may be simulated, or
wrong by minutes. A peer that does not publish its time still gives the log time of each
message: the fastest message shows the difference of the two clocks, and later ones how
much longer they took.
"""

from __future__ import annotations

import time
from collections.abc import Callable

_SAME_TIME = 3_600_000_000_000
"""Clocks that differ by more than an hour do not tell the same time [ns]."""
_WINDOW = 10_000_000_000
"""The fastest message counts for so long [ns]: clocks drift, and are set."""
_SET_BACK = 1_000_000_000
"""A log time this much before the last one means that the clock was set back [ns]: late
messages differ by less."""
_QUIET = 3_000_000_000
"""What came before this time says nothing about the lag now [ns]."""


class _Fastest:
    """Keeps the largest log time minus receive time of some seconds."""

    def __init__(self) -> None:
        # That of this window and of the last one [ns].
        self._offset: int | None = None
        self._last_offset: int | None = None
        self._window_end = 0

    def note(self, now: int, offset: int) -> None:
        """Note the offset of a message that came now [ns]."""
        if now > self._window_end:
            self._last_offset, self._offset = self._offset, offset
            self._window_end = now + _WINDOW
        elif self._offset is None or offset > self._offset:
            self._offset = offset

    @property
    def offset(self) -> int | None:
        """The largest one [ns]; None before the first message."""
        known = [one for one in (self._offset, self._last_offset) if one is not None]
        return max(known) if known else None


class SourceClock:
    """Computes the time at the peer from its messages.

    One thread writes, any thread may read.

    Args:
        wall_ns: returns the time of this computer [ns].
    """

    def __init__(self, wall_ns: Callable[[], int] = time.time_ns) -> None:
        self._wall_ns = wall_ns
        self.reset()

    def reset(self) -> None:
        """Forget what was noted: another server, or another connection."""
        self._server_ns: int | None = None
        self._fastest = _Fastest()
        # The reference of lags: it starts again when the peer's clock is set.
        self._undelayed = _Fastest()
        self._newest: tuple[int, int] | None = None
        self._last_ns = 0
        self._apart: int | None = None

    @property
    def is_told(self) -> bool:
        """Whether the peer publishes its time."""
        return self._server_ns is not None

    def now_ns(self) -> int:
        """Return the time at the peer [ns]; this computer's if nothing is known."""
        if self._server_ns is not None:
            return self._server_ns
        return self._wall_ns() + (self._fastest.offset or 0)

    def note_time(self, server_ns: int) -> None:
        """Note the time that the peer has told [ns]; it counts from now on."""
        self._server_ns = server_ns

    def note_message(self, log_ns: int) -> None:
        """Note when the peer has logged a message that has just come [ns]."""
        now = self._wall_ns()
        offset = log_ns - now
        self._apart = offset if abs(offset) > _SAME_TIME else None
        if self._apart is not None:
            return
        if log_ns < self._last_ns - _SET_BACK:
            self._undelayed = _Fastest()
        self._last_ns = log_ns
        for one in (self._fastest, self._undelayed):
            one.note(now, offset)
        self._newest = (now, offset)

    @property
    def apart_s(self) -> float | None:
        """How far the peer's clock is ahead of this one [s]; None for the same time."""
        return None if self._apart is None else self._apart / 1e9

    def lag_s(self) -> float | None:
        """Return how much longer than at best the newest message took [s]."""
        best = self._undelayed.offset
        if self._server_ns is not None or best is None or self._newest is None:
            return None
        now, offset = self._newest
        return None if self._wall_ns() - now > _QUIET else (best - offset) / 1e9
