"""Stretches of a recording, and which of them have the messages of some time.

Every format is read through these: a block is a chunk of the file, or a few thousand
messages that stand by themselves.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass
from itertools import accumulate
from typing import Any

import numpy as np
import numpy.typing as npt

Times = npt.NDArray[np.uint64]
Places = npt.NDArray[np.int64]
Numbers = npt.NDArray[Any]

LAST_TIME = 2**64 - 1
"""No log time is later [ns]."""


@dataclass(slots=True, eq=False)
class Block:
    """A stretch of a recording.

    Attributes:
        number: which it is in the file; messages of one time keep this order.
        start: log time of its first message [ns].
        end: log time of its last message [ns].
        channels: numbers of the channels that have messages in it.
    """

    number: int
    start: int
    end: int
    channels: frozenset[int]


@dataclass(frozen=True, slots=True, eq=False)
class Entries:
    """Where the messages of a block are, by log time; in the file's order for one time.

    Attributes:
        times: log times [ns].
        channels: their channels' numbers.
        places: where the messages are, in `raw` or in the file.
        raw: the decompressed chunk, or None.
        large: channel, log time [ns] and size [bytes] of messages that are too large,
            and are not among the others.
    """

    times: Times
    channels: Numbers
    places: Places
    raw: bytes | memoryview | None = None
    large: Sequence[tuple[int, int, int]] = ()

    @property
    def size(self) -> int:
        """Memory that it takes [bytes]."""
        return 20 * len(self.times) + (len(self.raw) if self.raw is not None else 0)


def sorted_entries(
    times: Times,
    channels: Numbers,
    places: Places,
    raw: bytes | memoryview | None,
    large: Sequence[tuple[int, int, int]] = (),
) -> Entries:
    """Sort messages by log time; at one time they keep the order of the file."""
    if len(times) > 1 and not bool(np.all(times[:-1] <= times[1:])):
        order = np.argsort(times, kind="stable")
        times, channels, places = times[order], channels[order], places[order]
    return Entries(times, channels, places, raw, large)


def position(times: Times, time: int, *, right: bool) -> int:
    """Return how many of some sorted times are before a time, or not after it."""
    if time < 0:
        return 0
    if time > LAST_TIME:
        return len(times)
    side = "right" if right else "left"
    return int(np.searchsorted(times, np.uint64(time), side))


class TimeIndex:
    """Finds the blocks that have messages of some time.

    Attributes:
        count: how many blocks it knows.
    """

    def __init__(self, blocks: Sequence[Block]) -> None:
        self.count = len(blocks)
        self._blocks = sorted(blocks, key=lambda block: (block.start, block.number))
        self._starts = [block.start for block in self._blocks]
        # The latest end up to each of them: blocks may lie over each other.
        self._ends = list(accumulate((block.end for block in self._blocks), max))

    def overlapping(self, start: int, end: int, channels: Set[int]) -> list[Block]:
        """Return the blocks with these channels and times, by their start."""
        first = bisect_left(self._ends, start)
        last = bisect_right(self._starts, end)
        return [
            block
            for block in self._blocks[first:last]
            if block.end >= start and not channels.isdisjoint(block.channels)
        ]

    def backwards(self, time: int, channels: Set[int]) -> Iterator[tuple[Block, int]]:
        """Yield the blocks that begin at a time or before, the newest first.

        Yields:
            a block, and the latest time that it or any of those after it can have.
        """
        for number in range(bisect_right(self._starts, time) - 1, -1, -1):
            block = self._blocks[number]
            if not channels.isdisjoint(block.channels):
                yield block, self._ends[number]

    def forwards(self, time: int, channels: Set[int]) -> Iterator[Block]:
        """Yield the blocks that end at a time or after it, by their start."""
        for block in self._blocks[bisect_left(self._ends, time) :]:
            if block.end >= time and not channels.isdisjoint(block.channels):
                yield block
