"""Find the messages of a recording that place its frames at a time.

tf2 keeps the transforms of a frame that are at most ten seconds older than its newest
one. Which messages these are depends on all messages before: a frame may have been
published once, an hour ago. So a recording is read once (see `Seconds`), and a few
numbers are kept for each second.
"""

from __future__ import annotations

import threading
from array import array
from collections.abc import (
    Callable,
    Collection,
    Iterable,
    Iterator,
    Mapping,
    Sequence,
)
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.history import DURATION
from sambot_viz.frames.samples import FramePair, Poses, name_fault, number_faults
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.frame_limit import Transforms
from sambot_viz.topics.seconds import BLOCK, Seconds

# A page without a recording does without what opens one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

TURNED_BACK = 1_000_000_000
"""A stamp that is older than the newest of its frames by more is of a new time [ns]."""
DEPTH = round(DURATION * 1e9)
"""How long a transform is kept after the newest of its frame [ns]."""

Span = tuple[int, int]
"""The first and the last log time [ns]."""


@dataclass(frozen=True, slots=True)
class HoldingMessages:
    """Which messages hold at a time.

    Attributes:
        spans: when they were written. Played in their order, and none between them,
            they leave what moves as all messages up to that time do.
        begin_ns: the log time at which the clock last went back; all that moved was
            forgotten then [ns].
        were_moving: frames with a static transform of before which had moved after it,
            and before that time: they have no place.
        unfound: frames that were looked for, and not in all messages of before.
    """

    spans: Sequence[Span] = ()
    begin_ns: int = 0
    were_moving: frozenset[str] = frozenset()
    unfound: Collection[str] = ()


@dataclass(slots=True)
class _Block:
    """The transforms of a second: which group of frames came when, with which stamp.

    Attributes:
        logs: the log times [ns], ascending.
        groups: the number of the frames that came together.
        stamps: of these [ns].
        lows: group → its oldest stamp.
        highs: group → its newest stamp.
        turns: whether the time goes back between messages of the block.
    """

    logs: array[int] = field(default_factory=lambda: array("q"))
    groups: array[int] = field(default_factory=lambda: array("q"))
    stamps: array[int] = field(default_factory=lambda: array("q"))
    lows: dict[int, int] = field(default_factory=dict[int, int])
    highs: dict[int, int] = field(default_factory=dict[int, int])
    turns: bool = False

    def add(self, log: int, group: int, stamp: int) -> None:
        self.logs.append(log)
        self.groups.append(group)
        self.stamps.append(stamp)
        high = self.highs.get(group, stamp)
        self.turns = self.turns or stamp < high - TURNED_BACK
        self.highs[group] = max(high, stamp)
        self.lows[group] = min(self.lows.get(group, stamp), stamp)

    def events(self) -> Iterator[tuple[int, int, int]]:
        """Yield log time, group and stamp in the order of the log."""
        return zip(self.logs, self.groups, self.stamps, strict=True)

    def until(self, at_ns: int) -> _Block:
        """Return what there is of it up to a log time."""
        if not self.logs or self.logs[-1] <= at_ns:
            return self
        return _Block.of(event for event in self.events() if event[0] <= at_ns)

    def since(self, begin_ns: int) -> _Block:
        """Return what there is of it from a log time on."""
        if not self.logs or self.logs[0] >= begin_ns:
            return self
        return _Block.of(event for event in self.events() if event[0] >= begin_ns)

    @classmethod
    def of(cls, events: Iterable[tuple[int, int, int]]) -> _Block:
        block = cls()
        for event in events:
            block.add(*event)
        return block


class TransformIndex:
    """Finds the messages that hold at a time. Threads may share it.

    Args:
        recording: its messages.
        topics: the topics whose transforms hold at their stamps.
        decode: the transforms of a message; raises DecodeError.
    """

    def __init__(
        self,
        recording: Bag,
        topics: Collection[str],
        decode: Callable[[Recorded], Transforms],
    ) -> None:
        self._recording = recording
        self._topics = tuple(name for name in topics if name in recording.topics)
        self._decode = decode
        self._seconds = Seconds(recording, self._look, DEPTH // BLOCK + 1)
        self._numbers: dict[tuple[tuple[FramePair, ...], tuple[str, ...]], int] = {}
        self._children: list[tuple[str, ...]] = []
        self._lock = threading.Lock()

    def holding(
        self, at_ns: int, fixed: Mapping[str, int], expected: Collection[str]
    ) -> HoldingMessages:
        """Return which messages hold at a log time [ns].

        Args:
            at_ns: the log time.
            fixed: frame → the log time of its last static transform, which makes all
                before it forgotten.
            expected: frames for which it is looked further back.
        """
        if self._recording.start_ns is None or not self._topics:
            return HoldingMessages()
        with self._lock:
            known, unfound = self._known_until(at_ns, expected)
            begin, _ = _turn(known)
            blocks = [part for block in known if (part := block.since(begin)).logs]
            spans = _joined(self._needed(blocks, fixed))
            moved = self._moved(known, fixed, begin)
            return HoldingMessages(spans, begin, moved, unfound)

    # Looking through the recording

    def _known_until(
        self, at_ns: int, expected: Collection[str]
    ) -> tuple[list[_Block], Collection[str]]:
        """Return blocks up to a time, all after the first known, and what they lack."""
        missing, found = set(expected), list[_Block]()
        for block in self._seconds.back_from(at_ns, lambda: bool(missing)):
            found.append(block if found else block.until(at_ns))
            if missing:
                missing.difference_update(*(self._children[g] for g in found[-1].highs))
        found.reverse()
        return found, missing if self._seconds.gave_up else ()

    def look_on(self) -> bool:
        """Look at one more second from the start on; False when enough was seen.

        So a first jump finds what it needs.
        """
        with self._lock:
            return bool(self._topics) and self._seconds.look_on()

    @property
    def turned_back_by(self) -> int:
        """By how much the time last went back in what `look_on` has seen [ns]."""
        with self._lock:
            return _turn(self._seconds.from_start())[1]

    def _look(self, begin: int, end: int) -> tuple[_Block, int]:
        block = _Block()
        found: list[tuple[int, int, tuple[FramePair, ...], Poses]] = []
        for message in self._recording.messages(begin, end, self._topics):
            try:
                transforms = self._decode(message)
            except DecodeError:
                continue
            for stamp, edges, poses in transforms:
                found.append((message.log_ns, stamp, edges, poses))
        # All numbers at once: one by one they cost as much as to decode them.
        numbers = [poses for _, _, _, poses in found]
        is_good = not number_faults(np.concatenate(numbers)) if numbers else True
        # By id, which a decoder gives again for the same frames: to hash them is slow.
        known: dict[int, int | None] = {}
        for log, stamp, edges, poses in found:
            group = known.get(id(edges), -1) if is_good else -1
            if group == -1:
                group = self._group(edges, taken_children(edges, poses))
                known[id(edges)] = group
            if group is not None:
                block.add(log, group, stamp)
        return block, len(block.logs)

    def _group(
        self, edges: tuple[FramePair, ...], names: tuple[str, ...]
    ) -> int | None:
        """Return the number of frames that come together; None for one too many."""
        key = edges, names
        number = self._numbers.get(key)
        if number is None and len(self._numbers) < limits.FRAMES.value:
            number = self._numbers[key] = len(self._children)
            self._children.append(names)
        return number

    # What of it holds

    def _needed(
        self, blocks: Sequence[_Block], fixed: Mapping[str, int]
    ) -> Iterator[Span]:
        """Yield the times of the blocks that have what tf2 would still keep."""
        newest = self._newest(blocks, fixed)
        oldest: dict[int, int] = {}
        for group, names in enumerate(self._children):
            stamps = [newest[name] for name in names if name in newest]
            if stamps:
                oldest[group] = min(stamps) - DEPTH
        for block in blocks:
            if any(
                high >= oldest.get(group, high + 1)
                for group, high in block.highs.items()
            ):
                yield block.logs[0], block.logs[-1]

    def _moved(
        self, blocks: Sequence[_Block], fixed: Mapping[str, int], begin: int
    ) -> frozenset[str]:
        """Return what moved after its static transform, and before a time [ns]."""
        return frozenset(
            name
            for block in blocks
            for log, group, _ in block.events()
            if log < begin and fixed
            for name in self._children[group]
            if fixed.get(name, begin) < log
        )

    def _newest(
        self, blocks: Sequence[_Block], fixed: Mapping[str, int]
    ) -> dict[str, int]:
        """Return the newest stamp of each frame since its last static transform."""
        newest: dict[str, int] = {}
        for block in blocks:
            for group, high in block.highs.items():
                for name in self._children[group]:
                    if block.logs[-1] >= fixed.get(name, 0):
                        newest[name] = max(newest.get(name, high), high)
        return newest


def taken_children(edges: Sequence[FramePair], poses: Poses) -> tuple[str, ...]:
    """Return the children of transforms that tf2 does not ignore."""
    bad = number_faults(np.array(poses, dtype=np.float64))
    return tuple(
        plain_name(child)
        for row, (parent, child) in enumerate(edges)
        if row not in bad and not name_fault(plain_name(parent), plain_name(child))
    )


def _joined(spans: Iterator[Span]) -> list[Span]:
    """Return spans with those that follow each other within a block made one."""
    joined: list[Span] = []
    for begin, end in spans:
        if joined and begin - joined[-1][1] <= BLOCK:
            joined[-1] = joined[-1][0], end
        else:
            joined.append((begin, end))
    return joined


def _turn(blocks: Iterable[_Block]) -> tuple[int, int]:
    """Return when the time last went back, and by how much; 0 for never [ns]."""
    turn, by = 0, 0
    newest: dict[int, int] = {}
    for block in blocks:
        goes_on = all(
            low >= newest.get(group, low) - TURNED_BACK
            for group, low in block.lows.items()
        )
        if goes_on and not block.turns:
            for group, high in block.highs.items():
                newest[group] = max(newest.get(group, high), high)
            continue
        for log, group, stamp in block.events():
            if stamp < newest.get(group, stamp) - TURNED_BACK:
                turn, by = log, newest[group] - stamp
                newest.clear()
            newest[group] = max(newest.get(group, stamp), stamp)
    return turn, by
