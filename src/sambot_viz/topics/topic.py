"""A topic: what is known of it, its last message, and how often they come.

No clock is asked here. Times are those of the source, which may be of a simulation, be
paused, and go back.
"""

from __future__ import annotations

from collections import deque

from sambot_viz.messages import Schema
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.qos import Qos

WINDOW_NS = 5_000_000_000
"""The rate is that of the last seconds [ns]."""
_MOST_TIMES = 512
"""So many of the last messages count at most: half a second at 1 kHz."""
_SILENCE = 3
"""So many periods without a message, and a topic is slower than it was."""


class Topic:
    """A topic of a source.

    Attributes:
        name: as the source writes it.
        schema: the definition of its messages.
        message_encoding: "cdr", "ros1", "json", … or "" when it is not known.
        qos: what its publishers offer, None when it is not known.
        is_latched: its messages hold for those who come late.
        publishers: their names, how many they are, or None when it is not known.
        count: so many messages have come, or are in the recording.
        last: the newest message, None before the first one.
    """

    def __init__(
        self,
        name: str,
        schema: Schema,
        message_encoding: str,
        *,
        qos: Qos | None = None,
        is_latched: bool = False,
        publishers: tuple[str, ...] | int | None = None,
        count: int = 0,
    ) -> None:
        self.name = name
        self.schema = schema
        self.message_encoding = message_encoding
        self.qos = qos
        self.is_latched = is_latched
        self.publishers = publishers
        self.count = count
        self.last: Recorded | None = None
        self._times: deque[int] = deque(maxlen=_MOST_TIMES)

    def take(self, message: Recorded) -> None:
        """Take a message that has come; one that is older begins a new run."""
        if self._times and message.log_ns < self._times[-1]:
            self._times.clear()
        self._times.append(message.log_ns)
        self.keep(message)

    def keep(self, message: Recorded) -> None:
        """Take a message that came before anybody listened: it has no part in rates."""
        self.count += 1
        self.last = message

    @property
    def period(self) -> float | None:
        """The mean time between the last messages [s]; None with less than two."""
        if len(self._times) < 2:
            return None
        return (self._times[-1] - self._times[0]) / (len(self._times) - 1) / 1e9

    def clear(self) -> None:
        """Forget the messages: the time has jumped. Their number stays."""
        self._times.clear()
        self.last = None

    def age(self, now_ns: int) -> float | None:
        """Return how long ago the last message came [s]; None before the first.

        Args:
            now_ns: the time of the source [ns].
        """
        if self.last is None:
            return None
        # Clocks that are told from time to time are a little behind their messages.
        return max(0, now_ns - self.last.log_ns) / 1e9

    def rate(self, now_ns: int) -> float | None:
        """Return how many messages come in a second.

        Args:
            now_ns: the time of the source [ns].

        Returns:
            The rate in the last seconds [1/s], 0.0 when there was silence, None when
            fewer than two messages have come at different times.
        """
        if len(self._times) < 2 or self._times[0] == self._times[-1]:
            return None
        recent = [time for time in self._times if now_ns - time <= WINDOW_NS]
        if not recent:
            return 0.0
        # The last message before the window bounds the first period.
        before = len(self._times) - len(recent) - 1
        first = self._times[before] if before >= 0 else recent[0]
        periods = len(recent) - (before < 0)
        period = (recent[-1] - first) / periods if periods else 0.0
        end = recent[-1]
        if now_ns - end > _SILENCE * period:
            end = now_ns
        return periods * 1e9 / (end - first) if end > first else None
