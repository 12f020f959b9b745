"""The robot of a source: its description, and what moves it."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from sambot_viz.errors import Problem, Severity
from sambot_viz.frames import FrameHistory, FrameTree
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.frame_prefix import frame_prefix, joints_of, other_prefix
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.robot_frames import hang_robot
from sambot_viz.joints import JointState
from sambot_viz.messages import Decoder, MessageTypes
from sambot_viz.robot.model import Robot
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.sources.source import Capability, Source
from sambot_viz.sources.subscriber import jump
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.described_links import DescribedLinks, described_links
from sambot_viz.topics.first_messages import FirstMessages
from sambot_viz.topics.first_topics import shown_at_first
from sambot_viz.topics.joint_index import JointIndex
from sambot_viz.topics.joint_states import JointNames, JointStateTopics
from sambot_viz.topics.name_spaces import NameSpaces, space_of
from sambot_viz.topics.reasons import latched_but_silent
from sambot_viz.topics.robot_topics import (
    STAND_IN_LINK,
    STAND_IN_NAME,
    RobotTopics,
    base_frame,
    is_description,
    robot_topics,
    stand_in_model,
    top_frame,
)
from sambot_viz.topics.transform_index import TransformIndex
from sambot_viz.topics.transforms import (
    Transforms,
    TransformTopics,
    problems_of_transforms,
)

# It is opened by who has one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag
    from sambot_viz.sources.given import GivenSource
    from sambot_viz.sources.recorder import RecordingPlace, SourceRecorder

FIRST_SECONDS = 2.0
"""The frames that move are learnt from the beginning of a recording [s]."""
ENOUGH = 300
"""Number of messages of a live robot after which its frames are known."""

_NAMED = 5
"""Number of topics named where one is missing."""


class Lease:
    """Keeps a source open while it is in use."""


class SourceRobot:
    """The robot of a source, for all sessions that show it.

    Its listeners are called in the thread of a live source, and must only post.

    Args:
        source: the messages.
        types: decodes them.
        name: its name; by default that of the source.
        at: the time to begin with [s from the first message of a recording]; None plays
            from the start.
        recordings: where recordings of a live robot go that users of the page start;
            None if they may not.
        published: the topics of a live robot, if the source holds its messages of some
            seconds; None for other sources.

    Attributes:
        source: as given.
        name: as given.
        published: as given.
        given: the words by which the user named it.
        spaces: names the frames of robots with name spaces.
        decoding: decodes its messages.
        at_ns: the log time to begin with [ns]; None as `at`.
        named: descriptions that a config names.
        topics: the topics of the robot, as far as known.
        description: the last URDF that was sent; None without one.
        refusal: why that cannot be shown; empty if it can.
        first_messages: the first messages of a recording.
        recorder: records a live source; None for a recording.
        on_description: called with the text of a robot, again when it changes.
        on_topics: called when the list of topics changes.
        on_status: called when the status of the source changes.
    """

    def __init__(
        self,
        source: Source,
        types: MessageTypes,
        name: str = "",
        at: float | None = None,
        recordings: RecordingPlace | None = None,
        *,
        published: Collection[str] | None = None,
    ) -> None:
        self.source = source
        self.published = published
        self.name = name or source.uri
        self.given: Sequence[GivenSource] = ()
        self._lease: Callable[[], Lease | None] = lambda: None
        self.spaces = NameSpaces()
        self.decoding = Decoding(types, self.spaces)
        self.named: Sequence[str] = ()
        self.topics = RobotTopics()
        self.description: str | None = None
        self.refusal = ""
        self.on_description: Callable[[str], object] = lambda text: None
        self.on_topics: list[Callable[[], object]] = []
        self.on_status: list[Callable[[], object]] = []
        self.at_ns: int | None = None
        self._framed = threading.Condition()
        self._seen = 0
        self._texts: dict[str, str] = {}
        self._links: dict[str, tuple[str, DescribedLinks]] = {}
        self._followed: set[str] = set()
        self._index: TransformIndex | None = None
        self._joint_indexes: dict[tuple[str, ...], JointIndex] = {}
        self.first_messages = FirstMessages(self.recording, self.decode)
        self._told = self._make_transforms(FrameHistory())
        source.on_topics = self._look
        source.on_status = self.tell_status
        self.recorder: SourceRecorder | None = None
        if source.live is not None:
            from sambot_viz.sources.recorder import SourceRecorder

            # The recorder learns of topics first, and calls the other listener.
            self.recorder = SourceRecorder(source.live, recordings, self.tell_status)
        if source.playback is not None:
            start = source.playback.recording.start_ns
            if at is not None and start is not None:
                self.at_ns = start + round(at * 1e9)
                source.playback.seek(self.at_ns)
            self._look()

    @property
    def hidden(self) -> tuple[Problem, ...]:
        """Which topics of a source are hidden by those of another one."""
        return self.source.hidden

    def close(self) -> None:
        """End the recording and the connection; a second call does nothing."""
        if self.recorder is not None:
            # What has come is still written.
            self.recorder.close()
        self.source.close()

    def lease(self) -> Lease:
        """Return what keeps the source open: after the last one is gone, it closes."""
        lease = self._lease()
        if lease is None:
            lease = Lease()
            self._lease = weakref.ref(lease)
            weakref.finalize(lease, self.close).atexit = False
        return lease

    def choose(self, named: Sequence[str]) -> None:
        """Take the robot of the first of some topics that is there.

        Args:
            named: descriptions that a config asks for.
        """
        self.named = named
        self._look()

    def can(self, capability: Capability) -> bool:
        """Return whether the source can do something."""
        return capability in self.source.capabilities

    @property
    def recording(self) -> Bag | None:
        """The messages by their times; None without the capability seek."""
        playback = self.source.playback
        return None if playback is None else playback.recording

    def has_recorded(self, topic: str) -> bool:
        """Return whether a topic is of a recording, and not of a live robot."""
        return self.recording is not None and topic in self.recording.topics

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The problems of the recording, and a note if it describes no robot."""
        recording = self.recording
        if recording is None:
            return ()
        of_frames = problems_of_transforms(self._told, self.name)
        found = (*recording.problems, *of_frames, *self._problems_of_time(recording))
        empty = recording.start_ns is None
        # A recording without messages says so itself, and no model would help.
        if self.description is not None or (empty and found):
            return found
        topics = sorted(recording.topics)
        more = ", …" if len(topics) > _NAMED else ""
        told = f"topics: {', '.join(topics[:_NAMED])}{more}" if topics else "no topic"
        frames = any(True for _ in self._told.pairs())
        shown = "showing frames only" if frames else "no transforms either"
        if shown_at_first(self.types):
            shown = "showing its data"
        silent = next(filter(is_description, self.published or ()), None)
        # Who wants to see frames or a sensor has not asked for a robot.
        severity: Severity = (
            "info" if frames or shown == "showing its data" else "warning"
        )
        missing = Problem(
            severity,
            "no-description",
            f"no robot model in {self.name} ({told}); {shown}",
            "add --model ROBOT.urdf.xacro"
            if silent is None
            else f"{latched_but_silent(silent)}; or add --model ROBOT.urdf.xacro",
        )
        return (*found, missing)

    def _problems_of_time(self, recording: Bag) -> Iterator[Problem]:
        """Yield that the time to look at is not in the recording."""
        start, end, at_ns = recording.start_ns, recording.end_ns, self.at_ns
        if at_ns is None or start is None or end is None or start <= at_ns <= end:
            return
        length, asked = (end - start) * 1e-9, (at_ns - start) * 1e-9
        nearest = "its end" if asked > 0 else "its beginning"
        hint = f"give a time from 0 to {length:.3f} with --at"
        if self.published is not None:
            hint = f"{hint}, or listen longer with --for"
        yield Problem(
            "warning",
            "at-outside",
            f"there is nothing at {asked:g} s of {self.name}, only from 0 to "
            f"{length:.3f} s; {nearest} is shown",
            hint,
        )

    @property
    def sentence(self) -> str:
        """How a live source is, and what of the robot is missing."""
        status = self.source.status
        if not status.is_connected or self.description is not None:
            return status.sentence
        if self.topics.description is None:
            return (
                f"{status.sentence}; no /robot_description is published: start "
                "robot_state_publisher, or give the robot with --model"
            )
        return f"{status.sentence}; waiting for {self.topics.description}"

    @property
    def model(self) -> str:
        """The XML text of the robot; of a single link while the source has none."""
        return self.stand_in if self.description is None else self.description

    @property
    def stand_in(self) -> str:
        """The XML text of a robot of a single link, at the top of the frames."""
        pairs = list(self._told.pairs())
        children = {child for _, child in pairs}
        roots = [parent for parent, _ in pairs if parent not in children]
        if not roots:
            # Frames that form a loop have no root, and data without transforms have
            # the frame of their messages: none is invented.
            of_data = self.first_messages.frames(self.types)
            roots = [parent for parent, _ in pairs] or [*of_data]
        return stand_in_model(roots[0] if roots else STAND_IN_LINK)

    @property
    def label(self) -> str:
        """What problems of the model name as its file."""
        return self.label_of(self.topics.description)

    def label_of(self, topic: str | None) -> str:
        """Return what problems of the robot of a topic name as its file."""
        if topic is None:
            return self.name
        return f"{self.name}{' ' if '://' in self.name else ':'}{topic}"

    def root_and_top(self, robot: Robot, timeout: float = 0.0) -> tuple[str, str]:
        """Return the frame of a robot's root link, and the one at the top of its tree.

        Args:
            robot: the robot; its root is the top when nothing is known to hold it. Of a
                stand-in it is the frame that the missing robot seems to have.
            timeout: how long to wait for transforms of a live robot that do [s].
        """

        def is_held() -> bool:
            root, top = self._root_and_top(robot)
            return root != top

        with self._framed:
            if not self.can("seek"):
                self._framed.wait_for(is_held, timeout)
            return self._root_and_top(robot)

    def top_of_frames(self) -> str:
        """Return the frame at the top of all that was told of; "" before that."""
        pairs = list(self._told.pairs())
        return top_frame(pairs[0][1], pairs) if pairs else ""

    def _root_and_top(self, robot: Robot) -> tuple[str, str]:
        pairs = list(self._told.pairs())
        base = base_frame(pairs) if robot.name == STAND_IN_NAME else None
        prefix = self.prefix_of(robot, pairs)
        root = base or prefix + plain_name(robot.root)
        return root, top_frame(root, pairs)

    def prefix_of(self, robot: Robot, pairs: Iterable[tuple[str, str]]) -> str:
        """Return the prefix of the links of the robot, such as "a/".

        Args:
            robot: the opened robot.
            pairs: (parent, child) of all known transforms.
        """
        links = DescribedLinks(plain_name(robot.root), tuple(joints_of(robot)))
        return self._prefix(self.topics.description or "", links, [*pairs])

    def _prefix(
        self, topic: str, links: DescribedLinks, pairs: Sequence[tuple[str, str]]
    ) -> str:
        space = space_of(topic).removeprefix("/")
        prefix = self.spaces.prefix_of(topic) or frame_prefix(
            links.joints, pairs, f"{space}/"
        )
        if prefix or not space:
            return prefix
        # The name space of its topic, where only its root is known.
        names = {link for joint in links.joints for link in joint} | {links.root}
        frames = {frame for pair in pairs for frame in pair}
        found = other_prefix(names, names, frames, space)
        return f"{space}/" if found == space else ""

    def links_in_frames(
        self, topic: str, pairs: Iterable[tuple[str, str]]
    ) -> DescribedLinks:
        """Return the links of the robot of a topic by the names of their frames.

        Args:
            topic: the topic of a description; none are returned before it has come.
            pairs: (parent, child) of all known transforms.
        """
        text = self.text_of(topic) or ""
        if self._links.get(topic, ("", None))[0] != text:
            self._links[topic] = text, described_links(text)
        known = self._links.get(topic)
        if known is None:
            return DescribedLinks()
        root, joints = known[1].root, known[1].joints
        if self.spaces.prefix_of(topic):
            name = partial(self.spaces.link_frame, topic)
        else:
            name = self._prefix(topic, known[1], [*pairs]).__add__
        return DescribedLinks(
            name(root) if root else "", tuple((name(a), name(b)) for a, b in joints)
        )

    def frames(self, robot: Robot, joints: JointState) -> FrameTree:
        """Return where all frames are at the time to look at, or else at the end.

        Args:
            robot: its joints hold the frames of which messages say nothing.
            joints: their positions, which messages change.
        """
        history = FrameHistory()
        tree = FrameTree(history)
        transforms, states = self.transforms(history), self.joint_states()
        recording = self.recording
        if recording is not None and recording.end_ns is not None:
            at_ns = recording.end_ns if self.at_ns is None else self.at_ns
            jump(recording, at_ns, (transforms, states))
        known = {n: q for n, q in states.changed().items() if n in joints.free}
        joints.set_all(known)
        frames = DataFrames(tree)
        frames.changed, frames.pairs = transforms.changed, transforms.pairs
        frames.prefix = lambda robot: self.prefix_of(robot, transforms.pairs())
        by_joints = not frames.places_links(robot)
        robot_joints = robot.joints.values() if by_joints else ()
        fixed = [joint.name for joint in robot_joints if joint.type != "floating"]
        kinematics, prefix = joints.kinematics, frames.prefix_of(robot)
        hang_robot(tree, robot, kinematics, joints.all_positions(), fixed, prefix)
        frames.settle()
        return tree

    def transforms(self, history: FrameHistory) -> TransformTopics:
        """Return the object that puts the transforms into a history.

        For a recording it expects the frames that occur at the beginning.

        Args:
            history: an empty history.
        """
        made = self._make_transforms(history)
        if self.recording is not None:
            made.expect_as(self._told)
        return made

    def joint_states(self) -> JointStateTopics:
        """Return what takes the positions of joints."""
        topics = self.topics.joint_states
        decode, index = self.new_decoding().decode, self.joint_index(topics)
        return JointStateTopics(topics, decode, index)

    def joint_index(self, topics: Collection[str]) -> JointIndex | None:
        """Return what finds joint states at a time; None without a recording."""
        recording, key = self.recording, tuple(topics)
        if recording is not None and key not in self._joint_indexes:
            names_of = JointNames(self.new_decoding().decode)
            self._joint_indexes[key] = JointIndex(recording, key, names_of)
        return self._joint_indexes.get(key)

    def meant_frames(self, frame: str) -> tuple[str, ...]:
        """Return the frames that a config means by a name (see `NameSpaces.meant`)."""
        there = [topic for topic in self.named if topic in self.topics.descriptions]
        return self.spaces.meant(frame, there)

    def look_on(self) -> bool:
        """Look at one more second of a recording; False when enough was seen.

        A jump then finds what it needs, and it is known whether the time goes back. On
        a web server that would be all of the recording, whoever looks at how little.
        """
        if self.recording is None or self.recording.is_remote:
            return False
        joints = self.joint_index(self.topics.joint_states)
        found = [one.look_on() for one in (self._index, joints) if one is not None]
        return any(found)

    @property
    def turned_back_by(self) -> int:
        """By how much the stamps go back in what `look_on` has seen [ns]; 0: never."""
        return 0 if self._index is None else self._index.turned_back_by

    def new_decoding(self) -> Decoding:
        """Return what decodes the messages for a session."""
        return Decoding(self.decoding.types, self.spaces)

    def decode(self, message: Recorded) -> Any:
        """Return a message as an object with its fields.

        Raises:
            DecodeError: its bytes are not what its type says.
        """
        return self.decoding.decode(message)

    def decoder(self, topic: SourceTopic) -> Decoder:
        """Return the decoder of a topic, with the reason when there is none."""
        return self.decoding.types.decoder(topic.schema, topic.message_encoding)

    def transform_decoder(self) -> Callable[[Recorded], Transforms]:
        """Return what reads the transforms of a message; it raises DecodeError."""
        return self.new_decoding().transforms

    def text_of(self, topic: str) -> str | None:
        """Return the last text of a topic, if any.

        For a robot on the network this subscribes to it, and `on_status` is called when
        the text has come.
        """
        recording = self.recording
        if recording is None or topic not in recording.topics:
            if topic == self.topics.description:
                return self.description
            self._follow_text(topic)
            return self._texts.get(topic)
        if topic not in self._texts:
            latched = [m for m in recording.latched() if m.topic == topic]
            # Not every topic of strings is latched, or has the name of a latched one.
            last = recording.last(topic, recording.end_ns or 0) if not latched else None
            texts = map(self.decoding.text, latched if last is None else [last])
            self._texts[topic] = next((t for t in reversed([*texts]) if t), "")
        return self._texts[topic] or None

    @property
    def types(self) -> Mapping[str, str]:
        """Published topic → the type of its messages; "" if it cannot be read."""
        return {
            name: self.decoder(topic).type_name
            for name, topic in self.source.topics().items()
            if topic.reason is None and not topic.is_awaited
        }

    @property
    def loose(self) -> frozenset[str]:
        """Topics whose publishers now offer no more than Best Effort.

        The QoS of a recording is a matter of the past.
        """
        live = self.source.live
        if live is None:
            return frozenset()
        return frozenset(
            name
            for name, topic in live.topics().items()
            if topic.qos is not None and topic.qos.reliability == "best_effort"
        )

    def tell_status(self) -> None:
        """Say that the source or its recording is doing otherwise; in any thread."""
        for listener in list(self.on_status):
            listener()

    # Callbacks of the source

    def _look(self) -> None:
        """Find the topics of the robot; in the thread of a live source."""
        before, self.topics = self.topics, self._chosen(self.types)
        self.spaces.set_spaces(self.topics.spaces)
        recording = self.recording
        if recording is not None and (self._index is None or self.topics != before):
            self._read(recording)
        if self.source.live is not None:
            self._listen(self.source.live, before)
        for listener in list(self.on_topics):
            listener()
        if self.topics != before:
            self.tell_status()

    def _chosen(self, known: Mapping[str, str]) -> RobotTopics:
        """Return the topics of the robot, and the transforms of all sources.

        A prefix distinguishes the frames of each source.
        """
        topics = self.source.topics()
        prefixes = dict.fromkeys(topics[name].frame_prefix for name in known)
        found = robot_topics(known, self.named)
        if len(prefixes) < 2:
            return found
        each = [
            robot_topics(
                {n: k for n, k in known.items() if topics[n].frame_prefix == p}
            )
            for p in prefixes
        ]
        moving = {name: None for one in each for name in one.moving}
        static = {name: None for one in each for name in one.static}
        return replace(found, moving=tuple(moving), static=tuple(static))

    def _read(self, recording: Bag) -> None:
        """Take the descriptions of a recording, whatever their time."""
        main, decode = self.topics.description or "", self.transform_decoder()
        if self.has_recorded(main):
            self.description = self.text_of(main)
        moving = [name for name in self.topics.moving if self.has_recorded(name)]
        self._index = TransformIndex(recording, moving, decode)
        # The frames at the beginning; every session starts from them.
        self._told = self._make_transforms(FrameHistory())
        if self.spaces:
            # Which frames all robots share is known once all have told of theirs.
            self._told.expect(self._first_transforms(recording))
        self._told.expect(self._first_transforms(recording))

    def _listen(self, live: Source, before: RobotTopics) -> None:
        """Ask a live source for what it says of the robot."""
        moving, static = self.topics.moving, self.topics.static
        with self._framed:
            published = self.source.topics()
            self._told.set_topics(moving, static, published, are_taken=False)
        main, last = self.topics.description, before.description
        if main is not None and main != last and not self.has_recorded(main):
            live.subscribe(main, self._describe)
        if len(self.topics.descriptions) > 1:
            # The frames of one may be those of another.
            for topic in self.topics.others:
                self._follow_text(topic)
        if last is not None and main != last:
            live.unsubscribe(last, self._describe)
        for topic in {*before.moving, *before.static}.difference(moving, static):
            live.unsubscribe(topic, self._expect)
        for topic in (*moving, *static):
            if self._seen < ENOUGH and not self.has_recorded(topic):
                live.subscribe(topic, self._expect)

    def _describe(self, message: Recorded) -> None:
        text = self.decoding.text(message)
        if text and text != self.description:
            self.description = text
            self.on_description(text)
            self.tell_status()

    def _follow_text(self, topic: str) -> None:
        """Ask a live source for the texts of a topic, once."""
        live = self.source.live
        if live is None or topic in self._followed or self.has_recorded(topic):
            return
        self._followed.add(topic)
        live.subscribe(topic, self._take_text)

    def _take_text(self, message: Recorded) -> None:
        text = self.decoding.text(message)
        if text and text != self._texts.get(message.topic):
            self._texts[message.topic] = text
            self.tell_status()

    def _expect(self, message: Recorded) -> None:
        with self._framed:
            self._told.expect([message])
            self._framed.notify_all()
        self._seen += 1
        live = self.source.live
        if self._seen == ENOUGH and live is not None:
            for topic in (*self.topics.moving, *self.topics.static):
                live.unsubscribe(topic, self._expect)

    def _make_transforms(self, history: FrameHistory) -> TransformTopics:
        topics, decode = self.topics, self.transform_decoder()
        moving, static, index = topics.moving, topics.static, self._index
        return TransformTopics(
            history, moving, static, decode, index, self.spaces, self._source_of
        )

    def _source_of(self, topic: str) -> str | None:
        """Return the prefix of the live source that has a topic; None: recorded."""
        if self.has_recorded(topic):
            return None
        known = self.source.topics().get(topic)
        return "" if known is None else known.frame_prefix

    def _first_transforms(self, recording: Bag) -> Iterator[Recorded]:
        start, moving = recording.start_ns, self.topics.moving
        if start is not None and moving:
            end = start + round(FIRST_SECONDS * 1e9)
            yield from recording.messages(start, end, moving)
        yield from (m for m in recording.latched() if m.topic in self._told.always)
