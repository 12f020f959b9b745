"""What is to be said about the topics of a recording."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sambot_viz.frames import FrameTree
from sambot_viz.topics import reasons
from sambot_viz.topics.at_a_time import PlaceInTime
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.survey import Survey
from sambot_viz.topics.transforms import problems_of_transforms

SOON_NS = 1_000_000_000
"""What begins so soon after a recording was there when it began [ns]."""


@dataclass(frozen=True, slots=True)
class TopicStatus:
    """A row of the list of topics.

    Attributes:
        name: of the topic.
        type_name: of its messages; empty when the file does not say it.
        count: of its messages; None while that is not known.
        rate: of its messages [Hz]; None when there are less than two.
        readable: messages of this type and encoding can be decoded.
        reason: why nothing of it is seen; None when there is nothing to say.
    """

    name: str
    type_name: str
    count: int | None
    rate: float | None
    readable: bool
    reason: TopicReason | None


class TopicReport:
    """Says of each topic of a recording what it has, and why nothing of it is seen.

    Args:
        survey: of its messages; what it has not met yet is not said.
        tree: the frames of a session at the time that is looked at; without it those
            of any time are read.
        is_live: the messages are those of a robot, and were not recorded.
    """

    def __init__(
        self, survey: Survey, tree: FrameTree | None = None, *, is_live: bool = False
    ) -> None:
        self._is_live = is_live
        self._survey = survey
        self._place = PlaceInTime(survey, tree)
        self._recorded: SourceRobot = survey.recorded
        self._topics = survey.recording.topics

    def refresh(self) -> None:
        """Know the topics that were found since a recording was opened."""
        self._topics = self._survey.recording.topics

    def statuses(self, at_ns: int | None = None) -> Iterator[TopicStatus]:
        """Yield a row for each topic, in the order of the recording."""
        return (self.status(name, at_ns) for name in self._topics)

    def status(
        self, name: str, at_ns: int | None = None, *, ages: bool = True
    ) -> TopicStatus:
        """Return the row of a topic.

        Args:
            name: of the topic.
            at_ns: the log time to look at [ns]; None for the begin of the recording.
            ages: whether the last message before is looked for, to say "stale".
        """
        topic = self._topics[name]
        decoder = self._recorded.decoder(topic)
        rate, reason = self.rate(name), self._reason(name, at_ns)
        if reason is None and ages:
            reason = self._stale(name, at_ns)
        readable = decoder.reason is None
        return TopicStatus(name, decoder.type_name, topic.count, rate, readable, reason)

    def first_ns(self, name: str) -> int | None:
        """Return the log time of the first message of a topic, once it was met [ns]."""
        return self._survey.of(name).first_ns

    def rate(self, name: str) -> float | None:
        """Return how often messages of a topic come, between its first and last [Hz].

        Latched messages come when somebody asks for them: they have none. As long as
        its last message was not met, the end of the recording counts.
        """
        recording = self._survey.recording
        count, looked = self._topics[name].count, self._survey.of(name)
        first, last = looked.first_ns, looked.last_ns
        if count is None or count > looked.seen:
            last = recording.end_ns or 0
        if self._topics[name].is_latched:
            return None
        if first is None or not count or count < 2 or last <= first:
            return None
        return (count - 1) / ((last - first) * 1e-9)

    def _reason(self, name: str, at_ns: int | None) -> TopicReason | None:
        """Return the first reason that holds.

        What makes a topic unreadable at any time comes before when it begins.
        """
        topic, looked = self._topics[name], self._survey.of(name)
        decoder = self._recorded.decoder(topic)
        if topic.left_out:
            return reasons.left_out(topic.left_out)
        if topic.count == 0:
            return reasons.no_message(name)
        if decoder.reason is not None:
            return TopicReason(decoder.reason.code, decoder.reason.text)
        if looked.undecoded:
            is_all = topic.count is not None and looked.decoded >= topic.count
            cause = looked.cause or "they are no transforms"
            return reasons.not_decodable(
                looked.undecoded,
                looked.decoded,
                cause,
                is_all,
                is_live=self._is_live,
            )
        late = self._not_here_yet(name, at_ns)
        if late is not None:
            # What is not drawn at all is not worth waiting for.
            return self._of_display(name, decoder.type_name) or late
        if decoder.note is not None:
            return TopicReason(decoder.note.code, decoder.note.text)
        nothing = looked.nothing
        # What is not drawn in any frame needs no transform.
        if nothing is not None and nothing.code == "not-drawn":
            return nothing
        return (
            self._of_frame(name, at_ns)
            or nothing
            or self._of_display(name, decoder.type_name)
        )

    def _not_here_yet(self, name: str, at_ns: int | None) -> TopicReason | None:
        first, start = self.first_ns(name), self._survey.recording.start_ns
        if first is None or start is None:
            return None
        if first <= max(start + SOON_NS, at_ns or 0):
            return None
        latched = self._topics[name].is_latched
        return reasons.not_here_yet((first - start) * 1e-9, latched)

    def _of_frame(self, name: str, at_ns: int | None) -> TopicReason | None:
        """Say why the frame of the messages has no place, where they are placed."""
        survey, looked = self._survey, self._survey.of(name)
        if not looked.frame or name in self._recorded.topics.all:
            return None
        if looked.stamps is not None and survey.stamps is not None:
            first, last = (time * 1e-9 for time in survey.stamps)
            stamp = looked.stamps[0] * 1e-9
            if reasons.are_two_clocks(stamp, (first, last)):
                return reasons.two_clocks(name, stamp, (first, last))
        refused = survey.lookup_fault(looked.frame)
        if refused is None:
            return None if at_ns is None else self._place.fault(name, at_ns)
        fixed, lacks = survey.fixed_frame, survey.lacks_static
        # What parts the frames says itself what to do.
        found = problems_of_transforms(survey.transforms, "")
        parted = [p.hint for p in found if p.code == "two-parents" and p.hint]
        remedy = "; ".join(parted)
        return reasons.no_transform(
            looked.frame, fixed, refused, lacks_static=lacks, remedy=remedy
        )

    def _of_display(self, name: str, type_name: str) -> TopicReason | None:
        if reasons.drawn_by(name, type_name) is not None:
            return None
        return reasons.no_display(type_name, self._survey.of(name).fields)

    def last_ns(self, name: str, at_ns: int) -> int | None:
        """Return the log time of the last message of a topic up to a time [ns]."""
        looked, count = self._survey.of(name), self._topics[name].count
        if looked.seen == count and looked.last_ns <= at_ns:
            return looked.last_ns or None
        last = self._survey.recording.last(name, at_ns)
        return None if last is None else last.log_ns

    def _stale(self, name: str, at_ns: int | None) -> TopicReason | None:
        if at_ns is None or self._topics[name].is_latched:
            return None
        period = 1 / (self.rate(name) or 1e-9)
        longest = round(max(reasons.STALE, 3 * period) * 1e9)
        last = self.last_ns(name, at_ns)
        if last is None or at_ns - last <= longest:
            return None
        return reasons.stale((at_ns - last) * 1e-9)
