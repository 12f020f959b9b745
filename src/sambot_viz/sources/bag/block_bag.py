"""A file of a recording that is read block by block, whatever its format.

A format locates its blocks and reads the content of one; everything else about a
recording follows from that. Each reader decompresses one block at a time, and the last
few are cached.
"""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections import Counter, OrderedDict, deque
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from sambot_viz import limits
from sambot_viz.errors import Problem
from sambot_viz.messages import Schema
from sambot_viz.sources.bag.blocks import (
    LAST_TIME,
    Block,
    Entries,
    TimeIndex,
    position,
)
from sambot_viz.sources.bag.compression import BrokenPieceError, TooLargeError
from sambot_viz.sources.bag.damage import Damage
from sambot_viz.sources.bag.file_bytes import FileBytes
from sambot_viz.sources.bag.latched import LatchedMessages
from sambot_viz.sources.bag.left_out import LeftOut
from sambot_viz.sources.bag.merge import merged
from sambot_viz.sources.bag.refusals import unreadable
from sambot_viz.sources.message import Recorded, SourceTopic, TopicChannel

if TYPE_CHECKING:
    from typing_extensions import Self

OPENING = 500_000
"""Work that is done at opening: records, or kilobytes that are decompressed."""

STEP = 300_000
"""Work that one call of `index_more` does."""

_KEPT = 24 * 2**20
"""Memory for blocks that were read last [bytes]; the newest stays."""


class BlockBag(ABC):
    """One file of a recording; see `Bag`.

    Attributes:
        damage: the damage that was found.
        left_out: the parts that are too large.
    """

    def __init__(self, file: FileBytes) -> None:
        self.damage = Damage(file.path)
        self.left_out = LeftOut()
        self._file = file
        self._blocks: list[Block] = []
        self._channels: dict[int, TopicChannel] = {}
        self._too_many: set[int] = set()
        # By topic, and of those that are latched: there may be 65,535 of them.
        self._numbers_of: dict[str, set[int]] = {}
        self._latched_channels: dict[int, TopicChannel] = {}
        # Grows with the accounts of topics.
        self._changes = 0
        self._counts: Counter[int] = Counter()
        # What the file itself says, when that is used in place of counting.
        self._stated: Counter[int] | None = None
        self._to_collect: deque[Block] = deque()
        self._met = 0
        self._broken: set[int] = set()
        self._latched = LatchedMessages()
        self._kept: OrderedDict[int, Entries] = OrderedDict()
        self._index: TimeIndex | None = None
        self._topics: tuple[object, dict[str, SourceTopic]] | None = None
        self._is_finding = True
        self._is_complete = False
        # Held for short steps on the fields above, never while a block is read.
        self._lock = threading.RLock()
        # Only one thread at a time goes on with finding blocks.
        self._finding = threading.Lock()
        self._work = self._find_all()

    # --- implemented by each format -------------------------------------------------

    @abstractmethod
    def _find(self) -> Iterator[int]:
        """Find all blocks, and yield how much work each step was."""

    @abstractmethod
    def _read(self, block: Block) -> Entries:
        """Read a block.

        Raises:
            BrokenPieceError: it is damaged.
        """

    @abstractmethod
    def _message(self, entries: Entries, number: int) -> Recorded | None:
        """Return a message of a block; None when it cannot be read after all."""

    def _place_of(self, block: Block) -> int:
        """Return where a block begins in the file [bytes]."""
        return 0

    def _counts_of(self, block: Block) -> Mapping[int, int]:
        """Return how many messages of a block were counted without reading it."""
        return {}

    # --- for the formats ------------------------------------------------------------

    def _number(self) -> int:
        """Return the number of the next block."""
        self._met += 1
        return self._met

    def _add_channel(self, number: int, channel: TopicChannel) -> None:
        with self._lock:
            if self._knows((number,)):
                return
            self._changes += 1
            if len(self._channels) >= limits.CHANNELS.value:
                self._too_many.add(number)
                self.left_out.add_topic(channel.topic)
            else:
                self._channels[number] = channel
                self._numbers_of.setdefault(channel.topic, set()).add(number)
                if channel.is_latched:
                    self._latched_channels[number] = channel

    def _knows(self, channels: Iterable[int]) -> bool:
        """Return whether all of some channels were met, also those too many."""
        return all(one in self._channels or one in self._too_many for one in channels)

    def _count(self, counts: Mapping[int, int]) -> None:
        """Count messages by channel."""
        with self._lock:
            self._counts.update(counts)
            self._changes += 1

    def _add_block(self, block: Block, entries: Entries | None) -> None:
        """Add a block that was found, with its messages if they were read."""
        with self._lock:
            self._blocks.append(block)
            if entries is not None:
                found, counts = np.unique(entries.channels, return_counts=True)
                self._count(dict(zip(found.tolist(), counts.tolist(), strict=True)))
        if entries is not None:
            self._collect(block, entries)
        else:
            self._to_collect.append(block)

    def _read_or_none(self, block: Block) -> Entries | None:
        """Read a block, or return the kept one; note it when it is broken."""
        with self._lock:
            if block.number in self._broken:
                return None
            if (kept := self._kept.get(block.number)) is not None:
                self._kept.move_to_end(block.number)
                return kept
        try:
            entries = self._read(block)
        except BrokenPieceError as error:
            self._note_broken(block, error)
            return None
        except (OSError, ValueError) as error:
            raise unreadable(self._file.path, error) from error
        self._note_large(block, entries)
        with self._lock:
            self._kept[block.number] = entries
            size = sum(each.size for each in self._kept.values())
            while size > _KEPT and len(self._kept) > 1:
                size -= self._kept.popitem(last=False)[1].size
        return entries

    def _taken(self, entries: Entries, number: int) -> Recorded | None:
        """Return a message of a block that was read."""
        try:
            return self._message(entries, number)
        except (OSError, ValueError) as error:
            raise unreadable(self._file.path, error) from error

    def _note_large(self, block: Block | None, entries: Entries) -> None:
        """Note the messages of a part that are too large, in a block or elsewhere."""
        if not entries.large:
            return
        counted = block is not None and bool(self._counts_of(block))
        with self._lock:
            for channel, time, size in entries.large:
                if self.left_out.add_message(channel, time, size) and counted:
                    self._said().subtract((channel,))
            self._changes += 1

    def _said(self) -> Counter[int]:
        """How many messages each channel has: as the file says, or as counted."""
        return self._counts if self._stated is None else self._stated

    def _note_broken(self, block: Block, why: BrokenPieceError) -> None:
        try:
            lost = self._counts_of(block)
        except (OSError, ValueError) as error:
            raise unreadable(self._file.path, error) from error
        with self._lock:
            if block.number not in self._broken:
                self._broken.add(block.number)
                self._changes += 1
                if not isinstance(why, TooLargeError):
                    self.damage.add_broken(block.start, block.end)
                self.left_out.add_chunk(self._place_of(block), why, block.channels)
                self._said().subtract(lost)

    # --- finding --------------------------------------------------------------------

    def _find_all(self) -> Iterator[int]:
        yield from self._find()
        self._is_finding = False
        while self._to_collect:
            block = self._to_collect.popleft()
            if self._wanted(block):
                entries = self._read_or_none(block)
                if entries is not None:
                    self._collect(block, entries)
                    yield entries.size // 1000 + len(entries.times)
            yield 1

    def _wanted(self, block: Block) -> list[int]:
        """Return the channels of a block that are latched and have room."""
        latched = self._latched_channels.keys() & block.channels
        topics = ((one, self._latched_channels[one].topic) for one in latched)
        return [one for one, topic in topics if self._latched.wants(topic)]

    def _collect(self, block: Block, entries: Entries) -> None:
        """Keep the messages of latched topics that are in a block."""
        latched = self._wanted(block)
        if latched:
            for number in np.flatnonzero(np.isin(entries.channels, latched)).tolist():
                message = self._taken(entries, number)
                if message is not None:
                    with self._lock:
                        self._latched.add(message)

    def index_more(self, work: int | None = None) -> bool:
        """Find more messages; see `Bag.index_more`."""
        work = STEP if work is None else work
        with self._finding:
            done = 0
            try:
                for cost in self._work:
                    done += cost
                    if done >= work:
                        return False
            except (OSError, ValueError) as error:
                raise unreadable(self._file.path, error) from error
            self._is_complete = True
            return True

    @property
    def is_complete(self) -> bool:
        """All messages are found."""
        return self._is_complete

    # --- the interface of a recording -----------------------------------------------

    @property
    def paths(self) -> Sequence[Path]:
        """The file."""
        return (self._file.path,)

    @property
    def size(self) -> int:
        """How long the file is [bytes]."""
        return self._file.size

    @property
    def is_remote(self) -> bool:
        """Whether the file is read over a network."""
        return self._file.is_remote

    @property
    def topics(self) -> Mapping[str, SourceTopic]:
        """The topics by name, in the order of the file."""
        with self._lock:
            known = (self._changes, self._is_complete)
            if self._topics is None or self._topics[0] != known:
                self._topics = (known, self._make_topics())
            return self._topics[1]

    def _make_topics(self) -> dict[str, SourceTopic]:
        first: dict[str, TopicChannel] = {}
        counts: Counter[str] = Counter()
        latched: set[str] = set()
        said = self._said()
        for number, channel in self._channels.items():
            first.setdefault(channel.topic, channel)
            counts[channel.topic] += max(0, said[number])
            if channel.is_latched:
                latched.add(channel.topic)
        known = self._is_complete or self._stated is not None
        return {
            topic: SourceTopic(
                topic,
                channel.schema,
                channel.message_encoding,
                channel.qos,
                is_latched=topic in latched,
                count=counts[topic] if known else None,
                left_out=self.left_out.of(self._numbers_of[topic], counts[topic]),
            )
            for topic, channel in first.items()
        }

    @property
    def start_ns(self) -> int | None:
        """Log time of the first message [ns]."""
        with self._lock:
            times = [b.start for b in self._blocks if b.number not in self._broken]
        return min(times, default=None)

    @property
    def end_ns(self) -> int | None:
        """Log time of the last message [ns]."""
        with self._lock:
            times = [b.end for b in self._blocks if b.number not in self._broken]
        return max(times, default=None)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The damage, and what to do."""
        with self._lock:
            names = {number: one.topic for number, one in self._channels.items()}
            large = self.left_out.problems(self._file.path, names)
            why = self.left_out.cause, self.left_out.remedy
            return (*self.damage.problems(self.start_ns, self.end_ns, *why), *large)

    def ends_at(self, topic: str) -> int | None:
        """Return the log time of the last message of all topics [ns]."""
        del topic
        return self.end_ns

    def latched(self) -> Sequence[Recorded]:
        """Return the messages of latched topics, by log time."""
        with self._lock:
            return self._latched.messages

    def messages(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        topics: Iterable[str] | None = None,
    ) -> Iterator[Recorded]:
        """Yield messages in the order of their log times; see `Bag.messages`."""
        first = 0 if start_ns is None else max(0, start_ns)
        last = LAST_TIME if end_ns is None else min(LAST_TIME, end_ns)
        channels = self._numbers(topics)
        blocks = self._blocks_by_time().overlapping(first, last, channels)
        for entries, numbers in merged(
            blocks, self._read_or_none, first, last, channels
        ):
            for number in numbers:
                message = self._taken(entries, number)
                if message is not None:
                    yield message

    def last(self, topic: str, at_ns: int) -> Recorded | None:
        """Return the newest message of a topic at a log time or before it."""
        channels = self._numbers((topic,))
        best: tuple[int, int] | None = None
        found: tuple[Entries, int] | None = None
        for block, latest in self._blocks_by_time().backwards(at_ns, channels):
            if best is not None and latest < best[0]:
                break
            entries = self._read_or_none(block)
            if entries is None:
                continue
            count = position(entries.times, at_ns, right=True)
            here = np.flatnonzero(np.isin(entries.channels[:count], list(channels)))
            if len(here):
                number = int(here[-1])
                key = (int(entries.times[number]), block.number)
                if best is None or key > best:
                    best, found = key, (entries, number)
        return None if found is None else self._taken(*found)

    def next(self, topic: str, after_ns: int) -> Recorded | None:
        """Return the first message of a topic after a log time."""
        channels = self._numbers((topic,))
        best: tuple[int, int] | None = None
        found: tuple[Entries, int] | None = None
        for block in self._blocks_by_time().forwards(after_ns + 1, channels):
            if best is not None and block.start > best[0]:
                break
            entries = self._read_or_none(block)
            if entries is None:
                continue
            first = position(entries.times, after_ns, right=True)
            here = np.flatnonzero(np.isin(entries.channels[first:], list(channels)))
            if len(here):
                number = first + int(here[0])
                key = (int(entries.times[number]), block.number)
                if best is None or key < best:
                    best, found = key, (entries, number)
        return None if found is None else self._taken(*found)

    def previous(self, topic: str, before_ns: int) -> Recorded | None:
        """Return the newest message of a topic before a log time."""
        return self.last(topic, before_ns - 1)

    def _numbers(self, topics: Iterable[str] | None) -> Set[int]:
        """Return the channels of some topics, or of all."""
        with self._lock:
            if topics is None:
                return frozenset(self._channels)
            found = (self._numbers_of.get(topic, ()) for topic in topics)
            return frozenset(number for some in found for number in some)

    def _blocks_by_time(self) -> TimeIndex:
        with self._lock:
            if self._index is None or self._index.count != len(self._blocks):
                self._index = TimeIndex(self._blocks)
            return self._index

    def close(self) -> None:
        """Close the file; may be called again."""
        self._file.close()
        with self._lock:
            self._kept.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()


NO_SCHEMA = Schema("", "", "")
"""Of a channel that has none."""
