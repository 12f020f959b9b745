"""Messages of several blocks in the order of their log times."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence, Set
from heapq import heapify, heappop, heappush

import numpy as np

from sambot_viz.sources.bag.blocks import Block, Entries, position


class _Cursor:
    """The messages of one block that are wanted and not yet handed on."""

    def __init__(
        self, entries: Entries, first: int, last: int, channels: Set[int]
    ) -> None:
        self.entries = entries
        begin = position(entries.times, first, right=False)
        end = position(entries.times, last, right=True)
        here = np.isin(entries.channels[begin:end], list(channels))
        self._numbers = begin + np.flatnonzero(here)
        self._times = entries.times[self._numbers]
        self._done = 0

    @property
    def time(self) -> int | None:
        """Log time of the next message, or None."""
        if self._done < len(self._times):
            return int(self._times[self._done])
        return None

    def take(self, until: int | None, *, at_it: bool) -> list[int]:
        """Return the next messages up to a log time; None for all of them.

        Args:
            until: the log time [ns].
            at_it: also take those of that time.
        """
        begin, end = self._done, len(self._times)
        if until is not None:
            end = max(begin, position(self._times, until, right=at_it))
        self._done = end
        return self._numbers[begin:end].tolist()


def merged(
    blocks: Sequence[Block],
    read: Callable[[Block], Entries | None],
    first: int,
    last: int,
    channels: Set[int],
) -> Iterator[tuple[Entries, list[int]]]:
    """Yield runs of messages, each in one block, in the order of their log times.

    A block is read when its first log time is reached: as long as blocks do not overlap
    in time, only one is in memory.

    Args:
        blocks: the blocks with the messages.
        read: returns the content of a block, or None if it is broken.
        first: the first log time [ns].
        last: the last log time [ns].
        channels: the wanted channels.
    """
    # A block waits under the time at which it claims to begin, then under that of its
    # next message; at one time the order of the file decides.
    waiting: list[tuple[int, int, Block, _Cursor | None]] = [
        (max(first, block.start), block.number, block, None) for block in blocks
    ]
    heapify(waiting)
    while waiting:
        _, number, block, cursor = heappop(waiting)
        if cursor is None:
            entries = read(block)
            if entries is None:
                continue
            cursor = _Cursor(entries, first, last, channels)
        else:
            until, at_it = None, False
            if waiting:
                until, at_it = waiting[0][0], number < waiting[0][1]
            yield cursor.entries, cursor.take(until, at_it=at_it)
        if cursor.time is not None:
            heappush(waiting, (cursor.time, number, block, cursor))
