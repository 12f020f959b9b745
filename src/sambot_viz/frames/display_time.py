"""When frames are drawn: now, or at the times of a display's messages.

These are the modes of RViz's Time panel, computed as its frame manager does.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum

from sambot_viz.frames.history import FrameHistory

_KEPT = 0.7
"""This much of the delay is as in the picture before."""


class SyncMode(IntEnum):
    """What the latest time means, by its number in a .rviz file."""

    OFF = 0
    EXACT = 1
    """The stamp of the last message of the source."""
    APPROXIMATE = 2
    """As long ago as messages of the source are old when they come, smoothed."""


class DisplayTime:
    """Keeps the time at which a history of frames is drawn.

    Args:
        history: of the frames; its `shown_at` is set.
        now_ns: the time of the messages [ns].

    Attributes:
        mode: what the latest time means.
        source: the name of the display whose messages count.
    """

    def __init__(self, history: FrameHistory, now_ns: Callable[[], int]) -> None:
        self.mode = SyncMode.OFF
        self.source = ""
        self._history = history
        self._now_ns = now_ns
        self._stamps: dict[str, int] = {}
        self._begin()

    @property
    def behind_s(self) -> float:
        """How long ago that is which is drawn [s]; 0 where it is the latest."""
        at = self._history.shown_at
        return 0.0 if at is None else max(0, self._now_ns() - at) * 1e-9

    def synchronize(self, mode: SyncMode, source: str) -> None:
        """Take another mode or source; its last message counts at once."""
        if (mode, source) != (self.mode, self.source):
            self.mode, self.source = mode, source
            self._begin()
            if (stamp := self._stamps.get(source)) is not None:
                self._take(stamp)

    def is_told_by(self, name: str) -> bool:
        """Return whether the messages of a display count."""
        return self.mode is not SyncMode.OFF and name == self.source

    def told(self, name: str, stamp_ns: int) -> None:
        """Record the stamp of the message that a display has drawn [ns]."""
        self._stamps[name] = stamp_ns
        if self.is_told_by(name):
            self._take(stamp_ns)

    def forget(self) -> None:
        """Know no message: the time has jumped."""
        self._stamps.clear()
        self._begin()

    def step(self) -> None:
        """Go on to the time of the next picture."""
        if self.mode is SyncMode.APPROXIMATE and self._delay is not None:
            self._smoothed = _KEPT * self._smoothed + (1 - _KEPT) * self._delay
            self._history.shown_at = self._now_ns() - round(self._smoothed)

    def _begin(self) -> None:
        self._history.shown_at = None
        self._delay: float | None = None
        self._smoothed = 0.0

    def _take(self, stamp_ns: int) -> None:
        if self.mode is SyncMode.EXACT:
            self._history.shown_at = stamp_ns
        elif self.mode is SyncMode.APPROXIMATE:
            delay = self._now_ns() - stamp_ns
            if delay < 0:
                self._begin()
            else:
                self._delay = float(delay)
