"""Read the first messages of all topics: enough to find their faults.

A recording of any length costs the same: the number of messages that are read, and that
of decoded ones of each topic, are limited.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress

from sambot_viz import limits
from sambot_viz.errors import FrameError
from sambot_viz.frames import FrameHistory, FrameTree, LookupRefused
from sambot_viz.frames.transform import Transform
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.described_links import DescribedLinks
from sambot_viz.topics.looked import Looked
from sambot_viz.topics.robot_topics import top_frame
from sambot_viz.topics.source_robot import SourceRobot


class Survey:
    """Looks at the first messages of a recording, a few at a time.

    Args:
        recorded: the recording, and which topics of it are transforms.

    Attributes:
        recording: its messages.
        topics: what was seen, by name.
        transforms: what /tf and /tf_static told.
        is_all: every message was met.
        is_complete: nothing more is looked at.
    """

    def __init__(self, recorded: SourceRobot) -> None:
        self.recorded = recorded
        assert recorded.recording is not None, "messages are looked at by their times"
        self.recording = recorded.recording
        self.topics: dict[str, Looked] = {}
        self.is_all = False
        self.is_complete = False
        self._moving = frozenset(recorded.topics.moving)
        # The frames of robots with name spaces have the names of the page.
        self.transforms = recorded.transforms(FrameHistory())
        self._steps = self._run()
        self._tree: tuple[FrameTree, str] | None = None

    def step(self) -> bool:
        """Look at one more message; False when there is nothing more to look at."""
        return next(self._steps, None) is not None

    def finish(self) -> None:
        """Look at all that is to be looked at."""
        while self.step():
            pass

    def of(self, topic: str) -> Looked:
        """Return what was seen of a topic."""
        return self.topics.get(topic) or Looked()

    def lookup_fault(self, frame: str) -> LookupRefused | None:
        """Return why a frame has no place; None when it has one, or nothing has."""
        tree, fixed_frame = self._looked_up()
        if not fixed_frame:
            return None
        try:
            tree.lookup(fixed_frame, frame)
        except LookupRefused as refused:
            return refused
        return None

    @property
    def fixed_frame(self) -> str:
        """The frame at the top of the robot's tree; empty when there are no frames."""
        return self._looked_up()[1]

    # Looking

    def _run(self) -> Iterator[bool]:
        recording = self.recording
        latched = [m for m in recording.latched() if m.topic in self.transforms.always]
        for message in latched:
            self.transforms.take(message)
        size = number = 0
        for message in recording.messages():
            self._look(message)
            number, size = number + 1, size + len(message.payload)
            yield True
            if number >= limits.SURVEYED.value or size >= limits.SURVEYED_BYTES.value:
                break
        else:
            self.is_all = True
        if not self.is_all:
            yield from self._look_later()
        self.is_complete = True

    def _look_later(self) -> Iterator[bool]:
        """Look at the first messages of topics that begin later."""
        recording = self.recording
        start = recording.start_ns or 0
        waiting = [n for n, t in recording.topics.items() if t.count != 0]
        late = [name for name in waiting if name not in self.topics]
        for name in late[: limits.SURVEYED_LATE.value]:
            message = recording.next(name, start - 1)
            if message is not None:
                self._look(message)
            yield True

    def _look(self, message: Recorded) -> None:
        looked = self.topics.setdefault(message.topic, Looked())
        looked.seen += 1
        looked.last_ns = message.log_ns
        if looked.first_ns is None:
            looked.first_ns = message.log_ns
        if message.topic in self._moving:
            before = self.transforms.undecoded[message.topic]
            self.transforms.take(message)
            failed = self.transforms.undecoded[message.topic] - before
            looked.decoded += 1
            looked.undecoded += failed
        elif looked.decoded < limits.SURVEYED_DECODED.value:
            looked.decode(message, self.recorded.decode)

    # Frames

    def _looked_up(self) -> tuple[FrameTree, str]:
        if self._tree is None:
            self._tree = self._frames()
        return self._tree

    def _frames(self) -> tuple[FrameTree, str]:
        """Return all frames, and the one at the top of the robot's tree."""
        tree = FrameTree(self.transforms.history)
        pairs = list(self.transforms.pairs())
        robots = self._robots(pairs)
        _hang(tree, robots, pairs)
        root = robots[0].root if robots else ""
        first = root or next((parent for parent, _ in pairs), "")
        joints = [joint for robot in robots for joint in robot.joints]
        return tree, top_frame(first, (*joints, *pairs))

    def _robots(self, pairs: Sequence[tuple[str, str]]) -> list[DescribedLinks]:
        """Return the links of all robots, by the names of their frames."""
        recorded = self.recorded
        return [
            recorded.links_in_frames(topic, pairs)
            for topic in recorded.topics.descriptions
        ]

    def with_joints(self, tree: FrameTree) -> FrameTree:
        """Hang the links in a tree where messages do not say where they are."""
        pairs = list(self.transforms.pairs())
        _hang(tree, self._robots(pairs), pairs)
        return tree


def _hang(
    tree: FrameTree,
    robots: Iterable[DescribedLinks],
    pairs: Sequence[tuple[str, str]],
) -> None:
    for robot in robots:
        if set(robot.joints).isdisjoint(pairs):
            for parent, child in robot.joints:
                with suppress(FrameError):
                    tree.set_static(parent, child, Transform.identity())
