"""What was seen of a recording, a second at a time.

A recording is looked through once: from a time that is asked for back to the start as
far as it is needed, or from the start on while nothing else is to be done.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Generic, TypeVar

from sambot_viz import limits

# A page without a recording does without what opens one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

BLOCK = 1_000_000_000
"""The length of a block of log time [ns]."""
FEW = 5_000
"""Minimum number of messages looked at, before the requested time."""
Seen = TypeVar("Seen")


class Seconds(Generic[Seen]):
    """Caches the facts of each second of a recording. Not thread-safe.

    Args:
        recording: the messages.
        look: returns the facts between two log times [ns], and the number of messages
            that it read.
        nearest: number of seconds that are always read.

    Attributes:
        gave_up: whether the last look back ended before the start, at the limit.
    """

    def __init__(
        self,
        recording: Bag,
        look: Callable[[int, int], tuple[Seen, int]],
        nearest: int = 0,
    ) -> None:
        self._recording = recording
        self._look = look
        self._nearest = nearest
        self.gave_up = False
        self._blocks: dict[int, Seen] = {}
        # Of the look from the start on.
        self._next = 0
        self._looked = 0

    def back_from(self, at_ns: int, lacks: Callable[[], bool]) -> Iterator[Seen]:
        """Yield what was seen up to a log time, the last second first.

        Args:
            at_ns: the log time [ns]; the second that it lies in is yielded whole.
            lacks: whether something is missing that must be there.
        """
        start, looked = self._recording.start_ns, 0
        last = -1 if start is None else (at_ns - start) // BLOCK
        self.gave_up = False
        for number in range(last, -1, -1):
            if number not in self._blocks:
                most = limits.SEARCHED.value if lacks() else FEW
                if number < last - self._nearest and looked >= most:
                    self.gave_up = True
                    return
                looked += self._take(number)
            yield self._blocks[number]

    def look_on(self) -> bool:
        """Look at one more second from the start on; False when enough was seen."""
        start, end = self._recording.start_ns, self._recording.end_ns
        if start is None or end is None or self._looked >= limits.SEARCHED.value:
            return False
        if start + self._next * BLOCK > end:
            return False
        if self._next not in self._blocks:
            self._looked += self._take(self._next)
        self._next += 1
        return True

    def from_start(self) -> Iterator[Seen]:
        """Yield all that `look_on` has passed."""
        for number in range(self._next):
            yield self._blocks[number]

    def _take(self, number: int) -> int:
        begin = (self._recording.start_ns or 0) + number * BLOCK
        self._blocks[number], count = self._look(begin, begin + BLOCK - 1)
        return count
