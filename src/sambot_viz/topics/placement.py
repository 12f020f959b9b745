"""Why the frame of a message has no place, and what brings it one.

Displays ask it for the messages that wait, and the list of topics for those that no
display draws: both say the same.
"""

from __future__ import annotations

from collections.abc import Callable

from sambot_viz.errors import DecodeError
from sambot_viz.frames import LookupRefused
from sambot_viz.frames.history import DURATION
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.sources.message import Recorded
from sambot_viz.topics import reasons
from sambot_viz.topics.described_links import DescribedLinks
from sambot_viz.topics.name_spaces import space_of
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.robot_topics import top_frame
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.transforms import TransformTopics, problems_of_parents

SOON = 1_000_000_000
"""A last transform older than a message by up to this may have a successor [ns]."""
AT_END = 200_000_000
"""Many recordings end with messages this much newer than the last transform [ns]."""
_HOUR = 3_600_000_000_000
"""Stamps that are farther from all of /tf are of another clock [ns]."""
_DAY = 24 * _HOUR


class Placement:
    """Says why frames have no place in the transforms of a source.

    Args:
        robot: has the topics of the transforms.
        transforms: what they have told.
    """

    def __init__(self, robot: SourceRobot, transforms: TransformTopics) -> None:
        self._robot = robot
        self._transforms = transforms
        self._read: tuple[object, int | None, tuple[int, int] | None] | None = None

    def reason(
        self, topic: str, refused: LookupRefused, at_ns: int | None
    ) -> TopicReason | None:
        """Return why a frame has no place; None where the next transforms bring it.

        Args:
            topic: of the message.
            refused: tf2's answer.
            at_ns: the log time that is looked at [ns]; None for any.
        """
        clocks = self.other_clock(topic, (refused.times or (None,))[0])
        if clocks is not None:
            return clocks
        remedy = self._remedy(refused, at_ns)
        if not remedy:
            return None
        text = f"{refused.rviz_text}. {remedy[0].upper()}{remedy[1:]}"
        return TopicReason("no-transform", text)

    def other_clock(self, topic: str, stamp: int | None) -> TopicReason | None:
        """Say that a stamp [ns] is far from those of all transforms."""
        if stamp is None or self._stamps is None:
            return None
        first, last = self._stamps
        if first - _HOUR <= stamp <= last + _HOUR:
            return None
        days = (stamp - last if stamp > last else first - stamp) // _DAY
        way = "after" if stamp > last else "before"
        by = f"{days:,} days" if days > 1 else "hours"
        return TopicReason(
            "two-clocks",
            f"{topic} is stamped {by} {way} /tf: one of the two nodes has the wrong "
            "use_sim_time",
        )

    def of_robot(self, name: str) -> TopicReason | None:
        """Return the fault of transforms or a robot, or what hides them."""
        topics = self._robot.topics
        if name in topics.descriptions:
            return self._hidden_robot(name)
        taken = (*topics.moving, *topics.static)
        if name in taken:
            if doubt := self._unfit(name):
                return doubt
            for found, of_topics in problems_of_parents(self._transforms):
                if name in of_topics:
                    return TopicReason(found.code, f"{found.message}; {found.hint}")
            return None
        known = self._robot.source.topics().get(name)
        kind = "" if known is None else self._robot.decoder(known).type_name
        if not taken or meaning_of(kind) is not Meaning.TRANSFORMS:
            return None
        return TopicReason(
            "topic-hidden",
            f"its frames are hidden by those of {taken[0]}: with "
            f"{space_of(name)}/robot_description both robots are shown apart",
        )

    def _unfit(self, name: str) -> TopicReason | None:
        """Return the reason if tf2's listeners get nothing of a live topic."""
        known = self._robot.source.topics().get(name)
        if known is None or self._robot.has_recorded(name):
            return None
        is_static = name in self._robot.topics.static
        return reasons.transforms_qos(known.qos, is_static=is_static)

    def _hidden_robot(self, name: str) -> TopicReason | None:
        """Return which robot has the frames of that of a topic."""
        topics = self._robot.topics.descriptions
        for other in topics[: topics.index(name)]:
            space = space_of(name) or space_of(other)
            shared = self._links(name).held & self._links(other).held
            if space_of(name) == space_of(other) or not shared:
                continue
            return TopicReason(
                "topic-hidden",
                f"its frames, such as {min(shared)}, are those of {other} too, and "
                "both robots are drawn at one place: publish the transforms of one on "
                f"{space}/tf, or with a frame_prefix",
            )
        return None

    def unplaced_robot(
        self, name: str, fault_of: Callable[[str], LookupRefused | None]
    ) -> TopicReason | None:
        """Return why a further robot has no place; None for other topics.

        Args:
            name: of the topic of its description.
            fault_of: returns why a frame has no place.
        """
        root = self._links(name).root if name in self._robot.topics.others else ""
        refused = fault_of(root) if root else None
        # It is drawn where its frames were last, whatever their times.
        if refused is None or refused.times is not None:
            return None
        return self.reason(name, refused, None)

    def _links(self, name: str) -> DescribedLinks:
        return self._robot.links_in_frames(name, self._transforms.pairs())

    def _remedy(self, refused: LookupRefused, at_ns: int | None) -> str:
        """Return what to do; empty where the next transforms bring the place."""
        if refused.times is None:
            return self._begin(at_ns, is_later=True) or self._unconnected(refused)
        stamp, nearest = refused.times
        first, last = self._stamps or (0, 0)
        seconds = abs(stamp - nearest) * 1e-9
        if refused.reason == "extrapolation-future":
            is_last = nearest >= last
            if stamp - nearest <= (AT_END if is_last else SOON):
                return ""
            return _behind(seconds, is_last)
        if refused.reason == "extrapolation-past" and nearest - first > SOON:
            return (
                f"tf2 keeps {DURATION:.0f} s, and the message is {seconds:.1f} s "
                "older: what publishes it is too slow, or stamps it with another clock"
            )
        return self._begin(at_ns) or (
            "the transforms on the way have no time in common: one of their nodes had "
            "stopped before another began, or their clocks differ"
        )

    def _unconnected(self, refused: LookupRefused) -> str:
        """Return what to do about frames that no transform connects."""
        if refused.reason == "empty-name":
            return "let what publishes it name the frame of its header"
        if refused.unknown and refused.unknown == refused.target:
            return "choose another Fixed Frame"
        problems = [problem for problem, _ in problems_of_parents(self._transforms)]
        # What parts the frames says itself what to do.
        parts = ("tf-loop",) if refused.reason == "ring" else ("two-parents",)
        hints = [p.hint for p in problems if p.code in parts and p.hint]
        if hints:
            return "; ".join(hints)
        topics = self._robot.topics
        recorded = self._robot.recording is not None and not topics.spaces
        if topics.moving and not topics.static and recorded:
            return self._without_static()
        top = top_frame(refused.source, self._transforms.pairs())
        words = f"0 0 0 0 0 0 {refused.target} {top}"
        return (
            f'add it: --static-transform "{words}", or ros2 run tf2_ros '
            f"static_transform_publisher {words}"
        )

    def _without_static(self) -> str:
        """Return what to do where the frames that do not move are missing."""
        published = self._robot.published
        if published is None:
            return (
                "/tf_static is not in this recording: record it too (ros2 bag record "
                "-a, or name it)"
            )
        if "/tf_static" in published:
            return reasons.latched_but_silent("/tf_static")
        return (
            "nothing publishes /tf_static: start robot_state_publisher, or what else "
            "tells the frames that do not move"
        )

    def _begin(self, at_ns: int | None, *, is_later: bool = False) -> str:
        """Say when the transforms of a recording begin.

        Args:
            at_ns: the log time that is looked at [ns]; None says nothing.
            is_later: only say so if that is still to come.
        """
        recording, first = self._robot.recording, self._begin_ns
        if at_ns is None or recording is None or first is None:
            return ""
        seconds = (first - (recording.start_ns or 0)) * 1e-9
        if first > at_ns:
            there = f"go there with the time bar or --at {seconds:.1f}"
            return f"transforms begin at {seconds:.1f} s: {there}"
        if is_later:
            return ""
        before = "this message is from before: go on to the next one"
        return f"transforms begin at {seconds:.1f} s, and {before}"

    @property
    def _begin_ns(self) -> int | None:
        """The log time of the first transform of a recording [ns]."""
        return self._known()[0]

    @property
    def _stamps(self) -> tuple[int, int] | None:
        """The first and the last stamp of what moves [ns]; None without."""
        newest = self._transforms.newest_ns
        recorded = self._known()[1]
        return recorded or ((newest, newest) if newest else None)

    def _known(self) -> tuple[int | None, tuple[int, int] | None]:
        """Read the first and the last transforms of a recording, once."""
        topics, recording = self._robot.topics, self._robot.recording
        if recording is None:
            return None, None
        if self._read is None or self._read[0] is not topics:
            start, end = recording.start_ns or 0, recording.end_ns or 0
            firsts = [recording.next(name, start - 1) for name in topics.moving]
            lasts = [recording.last(name, end) for name in topics.moving]
            found = [one for one in (*firsts, *lasts) if one is not None]
            stamps = [stamp for one in found for stamp in self._stamps_of(one)]
            begin = min((one.log_ns for one in found), default=None)
            of_all = (min(stamps), max(stamps)) if stamps else None
            self._read = topics, begin, of_all
        return self._read[1:]

    def _stamps_of(self, message: Recorded) -> list[int]:
        try:
            found = self._robot.transform_decoder()(message)
        except DecodeError:
            return []
        return [stamp for stamp, _, _ in found]


def _behind(seconds: float, is_last: bool) -> str:
    """Say what to do about a message after the last transform.

    Args:
        seconds: by how much [s].
        is_last: no transform comes after that.
    """
    if is_last:
        return (
            f"the last transform is {seconds:.1f} s older than the message: what "
            "publishes it had stopped, go back in time"
        )
    return (
        f"the newest transform is {seconds:.1f} s older than the message: what "
        "publishes it is late, or the clocks of the two nodes differ"
    )
