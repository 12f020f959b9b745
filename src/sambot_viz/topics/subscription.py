"""The messages of some topics, waiting for the display that asked for them."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Collection, Sequence
from typing import TYPE_CHECKING, Any

from sambot_viz.sources.message import Recorded
from sambot_viz.sources.subscriber import newest_until
from sambot_viz.topics.heard import Heard

# A page without a recording does without what opens one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

_NS = 1_000_000_000


class Subscription:
    """Keeps messages until they are drawn; above a limit only the newest.

    Messages come in the thread of the source or in the worker, and are taken in the
    worker. Nothing is decoded before it is drawn.

    Args:
        topics: the names of the topics.
        decode: returns a message as an object with its fields, or raises DecodeError.
        came: called in the worker when messages wait, and when a jump has made the
            drawn ones outdated.
        depth_s: how far back messages count after a jump [s].
        size: maximum number of waiting messages.
        base: the topic of full messages, to which others are updates: after a jump all
            messages since the last one count; "" without one.
        minds_older: whether to find out if there are older messages than those that
            count after a jump.
        holding: finds the messages that count after a jump, by the log time [ns]; None
            for those of the depth.

    Attributes:
        topics: as given.
        decode: as given.
        came: as given.
        base: as given.
        waits: whether taken messages wait for a transform; set by the display.
        is_outdated: whether the drawn messages are of another time, after a jump.
        heard: topic → its received messages.
        has_older: whether there are older messages than those that count after a jump.
        is_asleep: whether no page is open, so that no messages come.
        given_way: number of messages that were replaced by newer ones while waiting.
    """

    always: Collection[str] = ()

    def __init__(
        self,
        topics: tuple[str, ...],
        decode: Callable[[Recorded], Any],
        came: Callable[[], None],
        *,
        depth_s: float,
        size: int,
        base: str = "",
        minds_older: bool = False,
        holding: Callable[[int], Sequence[Recorded]] | None = None,
    ) -> None:
        self.topics = topics
        self.decode = decode
        self.came = came
        self.base = base
        self.depth_ns = round(depth_s * _NS)
        self.waits = False
        self.is_outdated = False
        self.heard = {topic: Heard() for topic in topics}
        self.has_older = False
        self.is_asleep = False
        self.given_way = 0
        self._minds_older = minds_older
        self._holding = holding
        self._waiting: deque[Recorded] = deque(maxlen=size)
        self._begin_ns: int | None = None
        # The thread of a source adds, the worker takes.
        self._lock = threading.Lock()

    @property
    def has_news(self) -> bool:
        """Whether something is to be drawn, or waits for a transform."""
        return self.waits or self.is_outdated or bool(self._waiting)

    def take(self, message: Recorded) -> None:
        """Keep a message; above the limit drop the oldest one that waits."""
        with self._lock:
            heard = self.heard[message.topic]
            last = heard.last
            if last is not None and _is_same(last, message):
                # A latched message comes once for that, and once as the last one.
                return
            if self._begin_ns is None:
                self._begin_ns = message.log_ns
            heard.take(message)
            if self._waiting.maxlen == len(self._waiting):
                self.given_way += 1
                if self.base:
                    # The oldest of the changes goes, not what they are made to.
                    del self._waiting[1]
            self._waiting.append(message)

    def until(self, recording: Bag, at_ns: int) -> Sequence[Recorded]:
        """Return the messages of the display's depth, or the last one of a topic."""
        if self._holding is not None:
            return self._holding(at_ns)
        found = newest_until(recording, self.topics, at_ns, self.depth_ns, self.base)
        if self._minds_older:
            self.has_older = _is_any_older(recording, found)
        return found

    def clear(self) -> None:
        """Forget all messages: the time has jumped."""
        with self._lock:
            self._waiting.clear()
            self._begin_ns = None
            self.heard = {topic: Heard() for topic in self.topics}
            self.has_older = False
            self.is_outdated = True

    def drain(self) -> list[Recorded]:
        """Return the messages that wait, the oldest first; they wait no longer."""
        with self._lock:
            self.is_outdated = False
            drained = list(self._waiting)
            self._waiting.clear()
        return drained

    def rate(self, topic: str, now_ns: int) -> float:
        """Return how many messages of a topic have come in a second since the first.

        Args:
            topic: its name.
            now_ns: the time of the source [ns].
        """
        if self._begin_ns is None or now_ns <= self._begin_ns:
            return 0.0
        return self.heard[topic].count * _NS / (now_ns - self._begin_ns)


def _is_any_older(recording: Bag, found: Sequence[Recorded]) -> bool:
    """Return whether a recording has older messages of a topic than those found."""
    first: dict[str, int] = {}
    for message in found:
        first.setdefault(message.topic, message.log_ns)
    for topic, time in first.items():
        if recording.last(topic, time - 1) is not None:
            return True
        times = [message.log_ns for message in found if message.topic == topic]
        of_time = recording.messages(time, time, (topic,))
        if sum(1 for _ in of_time) > times.count(time):
            return True
    return False


def _is_same(one: Recorded, other: Recorded) -> bool:
    return one is other or (
        one.log_ns == other.log_ns
        and len(one.payload) == len(other.payload)
        and one.payload == other.payload
    )
