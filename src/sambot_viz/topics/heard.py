"""Messages of a topic since the subscription: their number, rate and content.

No clock is read here. Times are those of the source, which may be simulated, may pause,
and may go back.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from sambot_viz.sources.message import Recorded
from sambot_viz.topics.looked import Looked

WINDOW_NS = 5_000_000_000
"""The rate is that of the last seconds [ns]."""
_MOST_TIMES = 512
"""Maximum number of recent messages that count: half a second at 1 kHz."""
_SILENCE = 3
"""Number of periods without a message after which a topic has slowed down."""


class Heard:
    """Counts the messages of a topic, and keeps the last one.

    Args:
        since: time of the subscription, by the clock of the session [s].

    Attributes:
        since: as given.
        count: number of received messages.
        last: the newest message, None before the first one.
    """

    def __init__(self, since: float = 0.0) -> None:
        self.since = since
        self.count = 0
        self.last: Recorded | None = None
        self._looked_at: Recorded | None = None
        self._looked = Looked()
        self._times: deque[int] = deque(maxlen=_MOST_TIMES)
        # The thread of the source adds messages.
        self._lock = threading.Lock()

    def take(self, message: Recorded) -> None:
        """Count a received message; an older one begins a new run."""
        with self._lock:
            if self._times and message.log_ns < self._times[-1]:
                self._times.clear()
            self._times.append(message.log_ns)
        self.keep(message)

    def keep(self, message: Recorded) -> None:
        """Take a message that came before anybody listened: it has no part in rates."""
        self.count += 1
        self.last = message

    def look(self, decode: Callable[[Recorded], Any]) -> Looked:
        """Return the content of the last message."""
        message = self.last
        if message is not None and message is not self._looked_at:
            self._looked_at, self._looked = message, Looked()
            self._looked.decode(message, decode)
        return self._looked

    @property
    def period(self) -> float | None:
        """The mean time between the last messages [s]; None with less than two."""
        times = self._known()
        if len(times) < 2:
            return None
        return (times[-1] - times[0]) / (len(times) - 1) / 1e9

    def age(self, now_ns: int) -> float | None:
        """Return how long ago the last message came [s]; None before the first.

        Args:
            now_ns: the time of the source [ns].
        """
        if self.last is None:
            return None
        # A clock that is published now and then is a little later than its messages.
        return max(0, now_ns - self.last.log_ns) / 1e9

    def rate(self, now_ns: int) -> float | None:
        """Return how many messages come in a second.

        Args:
            now_ns: the time of the source [ns].

        Returns:
            The rate in the last seconds [1/s], 0.0 when there was silence, None when
            fewer than two messages have come at different times.
        """
        times = self._known()
        if len(times) < 2 or times[0] == times[-1]:
            return None
        recent = [time for time in times if now_ns - time <= WINDOW_NS]
        if not recent:
            return 0.0
        # The last message before the window bounds the first period.
        before = len(times) - len(recent) - 1
        first = times[before] if before >= 0 else recent[0]
        periods = len(recent) - (before < 0)
        period = (recent[-1] - first) / periods if periods else 0.0
        end = recent[-1]
        if now_ns - end > _SILENCE * period:
            end = now_ns
        return periods * 1e9 / (end - first) if end > first else None

    def _known(self) -> list[int]:
        with self._lock:
            return list(self._times)
