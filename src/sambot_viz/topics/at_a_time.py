"""Why the last message of a topic has no place at the time that is looked at."""

from __future__ import annotations

from sambot_viz.errors import DecodeError
from sambot_viz.frames import FrameHistory, FrameTree, LookupRefused
from sambot_viz.frames.history import DURATION
from sambot_viz.sources.subscriber import jump
from sambot_viz.topics import reasons
from sambot_viz.topics.decoding import frame_and_stamp
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.survey import Survey

SOON = 1_000_000_000
"""A transform that is so much older than a message is still to come [ns]."""
AT_END = 200_000_000
"""So much newer than the last transform is the last message of many recordings [ns]."""


class PlaceInTime:
    """Looks up the frames of messages at their stamps, in what tf2 would have by then.

    Args:
        survey: of the recording; its fixed frame is the one that is looked up in.
        tree: the frames of a session at its time; None reads those of any time.
    """

    def __init__(self, survey: Survey, tree: FrameTree | None) -> None:
        self._survey = survey
        self._tree = tree
        self._made: tuple[int, FrameTree] | None = None

    def fault(self, name: str, at_ns: int) -> TopicReason | None:
        """Return why the last message of a topic has no place; None if it has one.

        Args:
            name: of the topic.
            at_ns: the log time to look at [ns].
        """
        frame, stamp = self._newest(name, at_ns)
        fixed = self._survey.fixed_frame
        if not frame or not stamp or not fixed:
            return None
        try:
            self._tree_at(at_ns).lookup(fixed, frame, stamp)
        except LookupRefused as refused:
            remedy = self._remedy(refused, at_ns)
            if remedy:
                return reasons.no_transform(frame, fixed, refused, remedy=remedy)
        return None

    def _newest(self, name: str, at_ns: int) -> tuple[str, int]:
        """Return frame and stamp [ns] of the last message; 0 where it has none."""
        recorded = self._survey.recorded
        message = self._survey.recording.last(name, at_ns)
        if message is None:
            return "", 0
        try:
            frame, stamp_ns = frame_and_stamp(recorded.decode(message))
        except DecodeError:
            return "", 0
        return frame, stamp_ns or 0

    def _tree_at(self, at_ns: int) -> FrameTree:
        if self._tree is not None:
            return self._tree
        if self._made is None or self._made[0] != at_ns:
            history = FrameHistory()
            transforms = self._survey.recorded.transforms(history)
            jump(self._survey.recording, at_ns, (transforms,))
            self._made = at_ns, self._survey.with_joints(FrameTree(history))
        return self._made[1]

    def _remedy(self, refused: LookupRefused, at_ns: int) -> str:
        """Return what to do; empty where the next transforms bring the place."""
        if refused.times is None:
            return self._begin(at_ns)
        stamp, nearest = refused.times
        if refused.reason == "extrapolation-future":
            last = (self._survey.stamps or (0, 0))[1]
            if stamp - nearest <= (SOON if nearest < last else AT_END):
                return ""
            return reasons.behind((stamp - nearest) * 1e-9, nearest >= last)
        if refused.reason == "extrapolation-past":
            if nearest - (self._survey.stamps or (0, 0))[0] > SOON:
                return reasons.older_than_buffer((nearest - stamp) * 1e-9, DURATION)
        return self._begin(at_ns)

    def _begin(self, at_ns: int) -> str:
        """Say when the transforms begin, if that is later."""
        survey, recorded = self._survey, self._survey.recorded
        firsts = (survey.of(topic).first_ns for topic in recorded.topics.moving)
        first = min((time for time in firsts if time is not None), default=None)
        start = survey.recording.start_ns
        if first is None or start is None:
            return ""
        return reasons.transforms_begin((first - start) * 1e-9, first > at_ns)
