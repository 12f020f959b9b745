"""Which messages of a recording say where its joints are at a time.

Of each joint the last message that names it counts, however long ago it came, and each
publisher names other joints. So a recording is looked through once (see `Seconds`); of
each second it is kept which joints were named when.
"""

from __future__ import annotations

import threading
from array import array
from bisect import bisect_right
from collections.abc import Callable, Collection, Iterable
from typing import TYPE_CHECKING, TypeAlias

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.seconds import Seconds

# A page without a recording does without what opens one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

_Names = tuple[str, ...]
_Block: TypeAlias = "dict[_Names, array[int]]"
"""The joints that one message names → the log times of those, ascending [ns]."""


class JointIndex:
    """Finds the messages that hold at a time. Threads may share it.

    Args:
        recording: its messages.
        topics: those of joint states; some may not be in the recording.
        names_of: the joints that a message gives a position; raises DecodeError.
    """

    def __init__(
        self,
        recording: Bag,
        topics: Collection[str],
        names_of: Callable[[Recorded], _Names],
    ) -> None:
        self._recording = recording
        self._topics = tuple(name for name in topics if name in recording.topics)
        self._names_of = names_of
        self._seconds = Seconds(recording, self._look)
        self._lock = threading.Lock()

    def holding(self, at_ns: int) -> list[Recorded]:
        """Return the messages that hold at a log time [ns], in their order."""
        return self.holding_of((), at_ns)[0]

    def holding_of(
        self, expected: Iterable[str], at_ns: int
    ) -> tuple[list[Recorded], Collection[str]]:
        """Return the messages that hold at a log time, and what was not found.

        Taken one after the other, they leave the joints where all messages up to that
        time do. The last one of each topic is among them.

        Args:
            expected: joints for which it is looked further back.
            at_ns: the log time [ns].

        Returns:
            The messages in their order, and the joints that were looked for, and not in
            all messages of before.
        """
        recording, topics = self._recording, self._topics
        with self._lock:
            times, unfound = self._times(at_ns, set(expected))
        for topic in topics:
            last = recording.last(topic, at_ns)
            if last is not None:
                times.add(last.log_ns)
        found = [
            message
            for time in sorted(times)
            for message in recording.messages(time, time, topics)
        ]
        return found, unfound

    def _times(self, at_ns: int, missing: set[str]) -> tuple[set[int], Collection[str]]:
        """Return when each joint was named last [ns], and what was not found."""
        times, seen = set[int](), set[str]()
        if not self._topics:
            return times, ()
        for block in self._seconds.back_from(at_ns, lambda: bool(missing)):
            lasts = (
                (logs[position - 1], names)
                for names, logs in block.items()
                if (position := bisect_right(logs, at_ns))
            )
            for time, names in sorted(lasts, reverse=True):
                if not seen.issuperset(names):
                    seen.update(names)
                    times.add(time)
            missing.difference_update(seen)
        return times, missing if self._seconds.gave_up else ()

    def look_on(self) -> bool:
        """Look at one more second from the start on; False when enough was seen."""
        with self._lock:
            return bool(self._topics) and self._seconds.look_on()

    def _look(self, begin: int, end: int) -> tuple[_Block, int]:
        """Return what the messages of a time name, and how many there are."""
        block: _Block = {}
        count = 0
        for message in self._recording.messages(begin, end, self._topics):
            count += 1
            try:
                names = self._names_of(message)
            except DecodeError:
                continue
            if names in block or len(block) < limits.FRAMES.value:
                block.setdefault(names, array("q")).append(message.log_ns)
        return block, count
