"""The facts about the topics of a recording, from its index and some messages."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from sambot_viz.errors import DecodeError
from sambot_viz.frames import FrameHistory, FrameTree, LookupRefused
from sambot_viz.messages import Decoder
from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.subscriber import jump
from sambot_viz.topics import reasons
from sambot_viz.topics.account import Account, DrawingOf, account_of
from sambot_viz.topics.decoding import frame_and_stamp
from sambot_viz.topics.looked import Looked
from sambot_viz.topics.placement import Placement
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.survey import Survey

SOON_NS = 1_000_000_000
"""What begins so soon after a recording was there when it began [ns]."""

AT_ONCE_NS = 1_000_000
"""Messages that are no further apart than this count as simultaneous [ns]."""


class TopicReport:
    """Knows each topic of a recording (see `Evidence`).

    Args:
        survey: of its messages; what it has not met yet is not known.
        tree: the frames of a session at the time that is looked at; without it those
            of any time are read.
        fixed_frame: returns that of the session; without it, it is the frame at the
            top of the robot's tree.

    Attributes:
        survey: as given.
        at_ns: the log time to look at [ns]; None for the beginning of the recording.
    """

    def __init__(
        self,
        survey: Survey,
        tree: FrameTree | None = None,
        fixed_frame: Callable[[], str] | None = None,
    ) -> None:
        self.at_ns: int | None = None
        self.survey = survey
        self._recorded, self._recording = survey.recorded, survey.recording
        self._tree = tree
        self._fixed_frame = fixed_frame or (lambda: survey.fixed_frame)
        self._placement = Placement(survey.recorded, survey.transforms)
        self._made: tuple[int, FrameTree] | None = None
        self._topics = self._recording.topics

    def refresh(self) -> None:
        """Know the topics that were found since a recording was opened."""
        self._topics = self._recording.topics

    def accounts(self) -> Iterator[Account]:
        """Yield the account of each topic, in the order of the recording."""
        return (self.account(name) for name in self._topics)

    def account(self, name: str, drawing_of: DrawingOf | None = None) -> Account:
        """Return the account of a topic.

        Args:
            name: the topic.
            drawing_of: returns what displays do with it; None without displays.
        """
        type_name = self.decoder(name).type_name
        drawing = None if drawing_of is None else drawing_of(name, type_name)
        count, rate = self._topics[name].count, self.rate(name)
        return account_of(self, name, count, rate, drawing)

    def first_ns(self, name: str) -> int | None:
        """Return the log time of the first message of a topic, once it was met [ns]."""
        return self.survey.of(name).first_ns

    def last_ns(self, name: str, at_ns: int) -> int | None:
        """Return the log time of the last message of a topic up to a time [ns]."""
        looked, count = self.survey.of(name), self._topics[name].count
        if looked.seen == count and looked.last_ns <= at_ns:
            return looked.last_ns or None
        last = self._recording.last(name, at_ns)
        return None if last is None else last.log_ns

    def rate(self, name: str) -> float | None:
        """Return the rate of a topic between its first and its last message [Hz].

        Latched messages come with a subscription: they have no rate. While the last
        message is unknown, the end of the recording counts. Simultaneous messages were
        kept by their publisher.
        """
        count, looked = self._topics[name].count, self.survey.of(name)
        first, last = looked.first_ns, looked.last_ns
        if count is None or count > looked.seen:
            last = self._recording.end_ns or 0
        if self._topics[name].is_latched:
            return None
        if first is None or not count or count < 2 or last <= first + AT_ONCE_NS:
            return None
        return (count - 1) / ((last - first) * 1e-9)

    # The evidence

    def topic(self, name: str) -> SourceTopic:
        """Return what the recording says of a topic."""
        return self._topics[name]

    def decoder(self, name: str) -> Decoder:
        """Return the decoder of its messages, or the reason why there is none."""
        return self._recorded.decoder(self._topics[name])

    def looked(self, name: str) -> Looked:
        """Return what was seen of its first messages."""
        return self.survey.of(name)

    def unreceived(self, name: str) -> TopicReason | None:
        """Return why nothing of it was recorded."""
        return reasons.unreceived(self._topics[name])

    def of_robot(self, name: str) -> TopicReason | None:
        """Return the fault of its transforms or its robot, or what hides them."""
        return self._placement.of_robot(name)

    def to_come(self, name: str) -> TopicReason | None:
        """Return that it begins later than the time that is looked at."""
        first, start = self.first_ns(name), self._recording.start_ns
        if first is None or start is None:
            return None
        if first <= max(start + SOON_NS, self.at_ns or 0):
            return None
        latched = self._topics[name].is_latched
        return reasons.not_here_yet((first - start) * 1e-9, latched)

    def unplaced(self, name: str) -> TopicReason | None:
        """Return why the frame of its messages has no place, where they have one."""
        looked = self.survey.of(name)
        if name in self._recorded.topics.descriptions:
            return self._placement.unplaced_robot(name, self._fault_of)
        if not looked.frame or name in self._recorded.topics.all:
            return None
        if looked.stamps is not None:
            clocks = self._placement.other_clock(name, looked.stamps[0])
            if clocks is not None:
                return clocks
        if self._tree is None:
            refused = self.survey.lookup_fault(looked.frame)
            if refused is not None:
                return self._placement.reason(name, refused, None)
        return None if self.at_ns is None else self._unplaced_at(name, self.at_ns)

    def _fault_of(self, frame: str) -> LookupRefused | None:
        """Return why a frame has no place in the picture; None when it has one."""
        fixed = self._fixed_frame()
        if self._tree is None or fixed not in self._tree:
            return self.survey.lookup_fault(frame)
        try:
            self._tree.drawn(fixed, frame)
        except LookupRefused as refused:
            return refused
        return None

    def silent(self, name: str) -> TopicReason | None:
        """Return that its last message came long before the time that is looked at."""
        rate, recording, now = self.rate(name), self._recording, self.at_ns
        last = None if now is None or rate is None else self.last_ns(name, now)
        if now is None or rate is None or last is None:
            return None
        if reasons.stale((now - last) * 1e-9, 1 / rate) is None:
            return None
        start, coming = recording.start_ns or 0, recording.next(name, now)
        seconds = None if coming is None else (coming.log_ns - start) * 1e-9
        has_ended = (recording.ends_at(name) or 0) < now
        return reasons.over((last - start) * 1e-9, seconds, has_ended)

    def _unplaced_at(self, name: str, at_ns: int) -> TopicReason | None:
        """Return why the last message up to a time has no place then."""
        message, fixed = self._recording.last(name, at_ns), self._fixed_frame()
        # Without any transform nothing has a place: no fault of a single topic.
        if message is None or not fixed or not self.survey.fixed_frame:
            return None
        try:
            frame, stamp_ns = frame_and_stamp(self._recorded.decode(message))
            if frame:
                self._tree_at(at_ns).lookup(fixed, frame, stamp_ns)
        except DecodeError:
            return None
        except LookupRefused as refused:
            return self._placement.reason(name, refused, at_ns)
        return None

    def _tree_at(self, at_ns: int) -> FrameTree:
        if self._tree is not None:
            return self._tree
        if self._made is None or self._made[0] != at_ns:
            history = FrameHistory()
            transforms = self._recorded.transforms(history)
            jump(self._recording, at_ns, (transforms,))
            self._made = at_ns, self.survey.with_joints(FrameTree(history))
        return self._made[1]
