"""The transforms that messages bring, kept as tf2's listeners keep them."""

from __future__ import annotations

from collections import Counter
from collections.abc import (
    Callable,
    Collection,
    Container,
    Iterable,
    Iterator,
    Mapping,
    Sequence,
)
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from sambot_viz import limits
from sambot_viz.errors import DecodeError, Problem
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.history import FrameHistory
from sambot_viz.frames.samples import (
    FramePair,
    Poses,
    Sample,
    name_fault,
    number_faults,
)
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.subscriber import latched_until
from sambot_viz.topics.frame_limit import (
    FrameLimit,
    Transforms,
    too_many_frames,
)
from sambot_viz.topics.name_spaces import NameSpaces
from sambot_viz.topics.transform_index import (
    TURNED_BACK,
    HoldingMessages,
    TransformIndex,
    taken_children,
)

# A page without a recording does without what opens one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

Decode = Callable[[Recorded], Transforms]


@dataclass(slots=True)
class _Publication:
    """The frames that a publisher sends together, and their newest stamp [ns]."""

    edges: tuple[FramePair, ...]
    children: tuple[str, ...]
    newest: int
    topic: str


class TransformTopics:
    """Takes the messages of /tf and /tf_static into a history of frames.

    Args:
        history: where they are kept.
        moving: the topics whose transforms hold at their stamps.
        static: the topics whose transforms hold at all times.
        decode: the transforms of a message; raises DecodeError.
        index: of the recording whose messages they are; None for a live robot.
        spaces: name the frames of robots with name spaces.
        source_of: returns which live source has a topic, None for a recording: a jump
            in the time of one makes what another says no older.

    Attributes:
        history: as given.
        topics: all of them.
        always: the static ones: they hold for ever.
        faults: topic and tf2's name of a fault → how often a transform was ignored.
        undecoded: topic → how many messages could not be decoded.
        parents: child → its parents, and the topic that names each; the last one told
            of is the last.
        first: child → its first sample in the messages that were expected, stamped
            with the log time [ns].
        turned_back_by: by how much the stamps went back the last time [ns]; 0: never.
        limit: which frames are taken.
        renamed: how often frames got other names, and what was known was forgotten.
    """

    def __init__(
        self,
        history: FrameHistory,
        moving: Collection[str],
        static: Collection[str],
        decode: Decode,
        index: TransformIndex | None = None,
        spaces: NameSpaces | None = None,
        source_of: Callable[[str], str | None] = lambda topic: None,
    ) -> None:
        self.history = history
        self.renamed = 0
        self._spaces = NameSpaces() if spaces is None else spaces
        self._named = self._spaces.version
        # The last one of each group of frames, to be taken again by other names; its
        # frames are kept, so that no others get their id.
        self._last: dict[int, tuple[tuple[FramePair, ...], Recorded]] = {}
        self.topics = (*moving, *static)
        self.always = frozenset(static)
        self.faults: Counter[tuple[str, str]] = Counter()
        self.undecoded: Counter[str] = Counter()
        self.parents: dict[str, dict[str, str]] = {}
        self.first: dict[str, Sample] = {}
        self.turned_back_by = 0
        self.limit = FrameLimit()
        self._decode = decode
        self._index = index
        self._source_of = source_of
        self._holding = HoldingMessages()
        # All that has ever moved, and what has a place since the last jump.
        self._moving: dict[str, None] = {}
        self._placed: set[str] = set()
        # By id: a decoder gives the same tuple for the messages of one publisher, and
        # to hash 300 names costs as much as to keep their poses.
        self._groups: dict[int, _Publication] = {}
        self._changed_groups: dict[int, _Publication] = {}
        self._changed: dict[str, None] = {}

    def set_topics(
        self,
        moving: Collection[str],
        static: Collection[str],
        published: Container[str],
        *,
        are_taken: bool = True,
    ) -> None:
        """Take the messages of these topics, and forget what others tell.

        Args:
            moving: as of the class.
            static: as of the class.
            published: all topics of the source. What one has told stays that is gone
                from there: its node may be starting again.
            are_taken: whether their messages are taken, and not only expected.
        """
        before = self.topics
        self.topics, self.always = (*moving, *static), frozenset(static)
        is_renamed = self._named != self._spaces.version
        left = set(before).difference(self.topics)
        if is_renamed or any(topic in published for topic in left):
            # A robot at rest may publish nothing new.
            self._take_again(self.take if are_taken else self._expect)

    def take(self, message: Recorded) -> None:
        """Take the transforms of a message, as tf2's listener does."""
        is_static = message.topic in self.always
        for stamp, edges, poses in self._transforms_of(message, self.take):
            self._keep(message, edges)
            if is_static:
                self._take_static(message, edges, poses)
            else:
                self._take_moving(message.topic, stamp, edges, poses)

    def until(self, recording: Bag, at_ns: int) -> Sequence[Recorded]:
        """Return the messages that hold at a log time [ns], in their order.

        Taken one after the other, they leave the frames as all messages up to that
        time do.
        """
        fixed = latched_until(recording, self.always, at_ns)
        last = {
            child: message.log_ns
            for message in fixed
            for _, edges, poses in self._read(message)
            for child in taken_children(edges, poses)
        }
        index, topics = self._index, [n for n in self.topics if n not in self.always]
        if index is not None:
            self._holding = index.holding(at_ns, last, self._moving)
        moving = [
            message
            for begin, end in self._holding.spans
            for message in recording.messages(begin, end, topics)
        ]
        return sorted((*fixed, *moving), key=lambda message: message.log_ns)

    @property
    def unfound(self) -> Collection[str]:
        """The frames that the last jump did not look for in all messages of before."""
        return [one for one in self._holding.unfound if one not in self._placed]

    @property
    def newest_ns(self) -> int:
        """The newest stamp of what moves [ns]; 0 without any."""
        return max((group.newest for group in self._groups.values()), default=0)

    def go_back(self, by_ns: int) -> None:
        """Forget what moves by live sources: their time has gone back [ns]."""
        self.turned_back_by = by_ns
        self._forget(lambda source: source is not None)

    def clear(self) -> None:
        """Forget what moves by the recording; static transforms stay."""
        self._forget(lambda source: source is None)

    def _forget(self, is_outdated: Callable[[str | None], bool]) -> None:
        for key, (_, message) in [*self._last.items()]:
            if message.topic not in self.always:
                if is_outdated(self._source_of(message.topic)):
                    del self._last[key]
        groups = self._groups.items()
        gone = {k: g for k, g in groups if is_outdated(self._source_of(g.topic))}
        if len(gone) == len(self._groups):
            self.history.clear()
            self._groups.clear()
            self._placed.clear()
            return
        for key, group in gone.items():
            self.history.forget(group.children)
            self._placed.difference_update(group.children)
            del self._groups[key]

    def expect(self, messages: Iterable[Recorded]) -> None:
        """Learn from messages, without taking them, which frames there will be."""
        for message in messages:
            self._expect(message)

    def _expect(self, message: Recorded) -> None:
        for _, edges, poses in self._transforms_of(message, self._expect):
            for parent, child in edges:
                self._note_parent(message.topic, parent, child)
            self._note_first(message.log_ns, edges, poses)
            self._keep(message, edges)
            if message.topic not in self.always:
                self._moving.update((plain_name(c), None) for _, c in edges)

    def expect_as(self, other: TransformTopics) -> None:
        """Know what another has learnt to expect, and take the same frames."""
        self.limit.follow(other.limit)
        for child, parents in other.parents.items():
            self.parents.setdefault(child, {}).update(parents)
        self._moving.update(other._moving)
        self.first.update(other.first)

    def to_come(self, time_ns: int) -> dict[str, Sample]:
        """Return the first samples that are later than a log time [ns]."""
        return {c: one for c, one in self.first.items() if one.stamp > time_ns}

    def pairs(self) -> Iterator[tuple[str, str]]:
        """Yield (parent, child) of all transforms that were told of."""
        for child, parents in self.parents.items():
            for parent in parents:
                yield parent, child

    def changed(self) -> Collection[str]:
        """Return the frames that were told of since the last call."""
        changed, self._changed = self._changed, {}
        groups, self._changed_groups = self._changed_groups, {}
        for group in groups.values():
            changed.update(dict.fromkeys(group.children))
        return changed.keys()

    def _transforms_of(
        self, message: Recorded, again: Callable[[Recorded], object]
    ) -> Transforms:
        """Return the transforms of a message.

        Args:
            message: of one of the topics.
            again: takes the last messages once more, if frames have other names by now.
        """
        try:
            found = self._decode(message)
            if self._named != self._spaces.version:
                self._take_again(again)
                found = self._decode(message)
            return self.limit.through(found)
        except DecodeError:
            self.undecoded[message.topic] += 1
            return ()

    def _keep(self, message: Recorded, edges: tuple[FramePair, ...]) -> None:
        if id(edges) in self._last or len(self._last) < limits.FRAMES.value:
            self._last[id(edges)] = edges, message

    def _take_again(self, again: Callable[[Recorded], object]) -> None:
        """Take what was known of frames that have other names by now."""
        self._named = self._spaces.version
        self.renamed += 1
        last, self._last = self._last, {}
        self.history.forget_all()
        self._forget(lambda source: True)
        self.limit = FrameLimit()
        self.parents.clear()
        self.first.clear()
        self._moving.clear()
        self._changed.clear()
        self._changed_groups.clear()
        for _, message in last.values():
            if message.topic in self.topics:
                again(message)

    def _read(self, message: Recorded) -> Transforms:
        """Return the transforms of a message that is not taken, and not counted."""
        try:
            return self._decode(message)
        except DecodeError:
            return ()

    def _take_static(
        self, message: Recorded, edges: Sequence[FramePair], poses: Poses
    ) -> None:
        topic, holding = message.topic, self._holding
        is_before = message.log_ns < holding.begin_ns
        is_before = is_before and self._source_of(topic) is None
        for (parent, child), row in zip(edges, poses.tolist(), strict=True):
            if is_before and plain_name(child) in holding.were_moving:
                continue
            x, y, z, qx, qy, qz, qw = row
            pose = ((x, y, z), (qx, qy, qz, qw))
            fault = self.history.add_static(parent, child, pose)
            if fault is None:
                self._note_parent(topic, parent, child)
                self._changed[plain_name(child)] = None
            else:
                self.faults[topic, fault] += 1

    def _take_moving(
        self, topic: str, stamp: int, edges: tuple[FramePair, ...], poses: Poses
    ) -> None:
        group = self._groups.get(id(edges))
        if group is not None and stamp < group.newest - TURNED_BACK:
            # A simulation was reset: the robot would stand still until the old stamps
            # are passed.
            self.turned_back_by = group.newest - stamp
            turned = self._source_of(topic)
            self._forget(lambda source: source == turned)
            group = None
        is_new = group is None
        if group is None:
            children = tuple(plain_name(child) for _, child in edges)
            group = self._groups[id(edges)] = _Publication(
                edges, children, stamp, topic
            )
        group.newest = max(group.newest, stamp)
        is_new = is_new or not self._placed.issuperset(group.children)
        faults = self.history.add(stamp, edges, poses)
        for fault in faults.values():
            self.faults[topic, fault] += 1
        if is_new:
            taken = [edge for row, edge in enumerate(edges) if row not in faults]
            for parent, child in taken:
                self._note_parent(topic, parent, child)
            names = dict.fromkeys(plain_name(child) for _, child in taken)
            self._moving.update(names)
            self._placed.update(names)
        self._changed_groups[id(edges)] = group

    def _note_first(
        self, log_ns: int, edges: Sequence[FramePair], poses: Poses
    ) -> None:
        for row, (parent, child) in enumerate(edges):
            name = plain_name(child)
            known = self.first.get(name)
            if known is not None and known.stamp <= log_ns:
                continue
            pose = np.array([poses[row]], dtype=np.float64)
            if name_fault(plain_name(parent), name) or number_faults(pose):
                continue
            x, y, z, qx, qy, qz, qw = pose[0].tolist()
            at = ((x, y, z), (qx, qy, qz, qw))
            self.first[name] = Sample(log_ns, plain_name(parent), at)

    def _note_parent(self, topic: str, parent: str, child: str) -> None:
        parents = self.parents.setdefault(plain_name(child), {})
        parent = plain_name(parent)
        # The topic that named it first stays.
        parents[parent] = parents.pop(parent, topic)


def problems_of_transforms(
    transforms: TransformTopics,
    name: str,
    *,
    is_live: bool = False,
    turned_back_by: int = 0,
) -> tuple[Problem, ...]:
    """Return the problems of the transforms of a source.

    Args:
        transforms: the transforms up to now.
        name: the name of the recording or the live robot.
        is_live: whether it is a live robot.
        turned_back_by: how much the stamps of waiting messages go back [ns].
    """
    found = [problem for problem, _ in problems_of_parents(transforms)]
    if transforms.limit.left_out:
        found.append(too_many_frames(transforms.limit.left_out, name))
    found += not_looked_further("frame", transforms.unfound, name)
    if back_ns := transforms.turned_back_by or turned_back_by:
        back = back_ns * 1e-9
        found.append(
            Problem(
                "warning",
                "clock-back",
                f"time went back by {back:.1f} s in {name} (was a simulation reset?): "
                "transforms from before were dropped",
                "nothing is to be done if it was reset; else set the clocks of the "
                "robot's computers to the same time"
                if is_live
                else "record again after the reset, or jump behind it with the time "
                "bar",
            )
        )
    return tuple(found)


def not_looked_further(
    kind: str, unfound: Collection[str], name: str
) -> Iterator[Problem]:
    """Return a note on frames or joints for which a jump did not read all messages.

    Args:
        kind: "frame" or "joint".
        unfound: their names.
        name: the name of the recording.
    """
    if unfound:
        rest = f" and {len(unfound) - 1:,} more" if len(unfound) > 1 else ""
        yield Problem(
            "info",
            "not-looked-further",
            f"the {kind} {min(unfound)}{rest}: {name} was searched "
            f"{limits.SEARCHED.value:,} messages back from this time, and not further",
            "play from an earlier time, or record what rarely comes as latched",
        )


def problems_of_parents(
    transforms: TransformTopics,
) -> Iterator[tuple[Problem, Collection[str]]]:
    """Yield the faults of parents of frames, with the topics that publish them."""
    for child, parents in transforms.parents.items():
        if len(parents) > 1:
            problem = _two_parents(child, parents, transforms.always)
            yield problem, set(parents.values())
    if loop := _loop(transforms.parents):
        topics = {transforms.parents[child][parent] for parent, child in _edges(loop)}
        yield _of_loop(loop, transforms.parents), topics


def _loop(parents: Mapping[str, Mapping[str, str]]) -> list[str]:
    """Return the frames of a loop, each the parent of the next; empty without one."""
    above = {child: [*named][-1] for child, named in parents.items()}
    done: set[str] = set()
    for frame in above:
        way: dict[str, None] = {}
        while frame in above and frame not in done and frame not in way:
            way[frame] = None
            frame = above[frame]
        if frame in way:
            names = list(way)
            return names[names.index(frame) :][::-1]
        done.update(way)
    return []


def _edges(loop: Sequence[str]) -> Iterable[tuple[str, str]]:
    """Return parent and child of each transform of a loop."""
    return zip(loop, (*loop[1:], loop[0]), strict=True)


def _of_loop(loop: Sequence[str], parents: Mapping[str, Mapping[str, str]]) -> Problem:
    """Say which transforms form a loop, and which of them to stop."""
    arrows = " -> ".join((*loop, loop[0]))
    said = " and ".join(
        f"{parent} -> {child} on {parents[child][parent]}"
        for parent, child in _edges(loop)
    )
    return Problem(
        "warning",
        "tf-loop",
        f"the transforms form a loop, {arrows}: tf2 finds no way through it, and what "
        "is in it and below it has no place",
        f"stop one of those that publish {said}",
    )


def _two_parents(
    child: str, parents: Mapping[str, str], static: Collection[str]
) -> Problem:
    """Say who holds a frame at which parent; those that move it come first."""
    order = sorted(parents, key=lambda parent: parents[parent] in static)
    first, last = order[0], order[-1]
    named = [f"{parent} ({parents[parent]})" for parent in order]
    count = "two" if len(order) == 2 else f"{len(order)}"
    if parents[first] not in static and parents[last] in static:
        # The one that moves the robot names another frame than the root of its model.
        hint = f"publish {first} -> {last}, the root of the model"
    else:
        hint = f"stop all but one of those that publish {child}"
    return Problem(
        "warning",
        "two-parents",
        f"{child} has {count} parents: {', '.join(named[:-1])} and {named[-1]}; in tf2 "
        "a frame has one, and the others lose what is below it",
        hint,
    )
