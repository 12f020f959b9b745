"""The robot of a recording: its description, and what moves it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from sambot_viz.errors import Problem
from sambot_viz.frames import FrameHistory, FrameTree
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.frame_prefix import frame_prefix, joints_of
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.robot_frames import hang_robot
from sambot_viz.joints import JointState
from sambot_viz.messages import Decoder, MessageTypes
from sambot_viz.robot.model import Robot
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.sources.subscriber import jump
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.joint_states import JointStateTopics
from sambot_viz.topics.robot_topics import (
    STAND_IN_LINK,
    STAND_IN_NAME,
    RobotTopics,
    base_frame,
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

FIRST_SECONDS = 2.0
"""The frames that move are learnt from the begin of a recording [s]."""

_NAMED = 5
"""So many topics are named where one is missing."""


class RecordedRobot:
    """What a recording says of a robot; many sessions may play it at their own times.

    Args:
        recording: its messages.
        types: decodes them.
        name: what it is called.
        at: where to begin [s from the first message]; None plays from there.
        is_heard: whether it is what a live robot has said within some seconds.

    Attributes:
        recording: as given.
        source: it, as a source.
        name: as given.
        decoding: decodes its messages.
        at_ns: the log time to begin with [ns]; None as `at`.
        topics: those that are the robot's.
        description: the URDF, the last one that was sent; None when there is none.
        refusal: why that cannot be shown; empty when it can.
    """

    def __init__(
        self,
        recording: Bag,
        types: MessageTypes,
        name: str,
        at: float | None = None,
        *,
        is_heard: bool = False,
    ) -> None:
        self.recording = recording
        self.name = name
        self._is_heard = is_heard
        self.refusal = ""
        self.at_ns: int | None = None
        if at is not None and recording.start_ns is not None:
            self.at_ns = recording.start_ns + round(at * 1e9)
        self.source = RecordingPlayback(recording, name, self.at_ns)
        self.decoding = Decoding(types)
        self._take_topics(self._topics_of(()))

    def choose(self, named: Sequence[str]) -> None:
        """Take the robot of the first of some topics that is there.

        Args:
            named: descriptions that a config asks for.
        """
        topics = self._topics_of(named) if named else self.topics
        if topics != self.topics:
            self._take_topics(topics)

    def _topics_of(self, named: Sequence[str]) -> RobotTopics:
        topics = self.recording.topics
        known = {name: self.decoder(topic).type_name for name, topic in topics.items()}
        return robot_topics(known, named)

    def _take_topics(self, topics: RobotTopics) -> None:
        self.topics = topics
        self._descriptions = self._read_descriptions()
        self.description = self.description_of(self.topics.description or "")
        decode = self.transform_decoder()
        self._index = TransformIndex(self.recording, topics.moving, decode)
        # What the begin tells of frames; every session starts from it.
        self._told = self._make_transforms(FrameHistory())
        self._told.expect(self._first_transforms())

    @property
    def problems(self) -> tuple[Problem, ...]:
        """What is wrong with the recording, and what it says of no robot."""
        of_frames = problems_of_transforms(self._told, self.name)
        found = (*self.recording.problems, *of_frames, *self._problems_of_time())
        empty = self.recording.start_ns is None
        # A recording without messages says so itself, and no model would help.
        if self.description is not None or (empty and found):
            return found
        topics = sorted(self.recording.topics)
        more = ", …" if len(topics) > _NAMED else ""
        told = f"topics: {', '.join(topics[:_NAMED])}{more}" if topics else "no topic"
        frames = any(True for _ in self._told.pairs())
        shown = "showing frames only" if frames else "no transforms either"
        missing = Problem(
            "warning",
            "no-description",
            f"no robot model in {self.name} ({told}); {shown}",
            "add --model ROBOT.urdf.xacro",
        )
        return (*found, missing)

    def _problems_of_time(self) -> Iterator[Problem]:
        """Yield that the time to look at is not in the recording."""
        recording, at_ns = self.recording, self.at_ns
        start, end = recording.start_ns, recording.end_ns
        if at_ns is None or start is None or end is None or start <= at_ns <= end:
            return
        length, asked = (end - start) * 1e-9, (at_ns - start) * 1e-9
        nearest = "its end" if asked > 0 else "its begin"
        hint = f"give a time from 0 to {length:.3f} with --at"
        if self._is_heard:
            hint = f"{hint}, or listen longer with --for"
        yield Problem(
            "warning",
            "at-outside",
            f"there is nothing at {asked:g} s of {self.name}, only from 0 to "
            f"{length:.3f} s; {nearest} is shown",
            hint,
        )

    @property
    def model(self) -> str:
        """The XML text of the robot; of a single link where the recording has none."""
        return self.stand_in if self.description is None else self.description

    @property
    def stand_in(self) -> str:
        """The XML text of a robot of a single link, at the top of the frames."""
        pairs = list(self._told.pairs())
        children = {child for _, child in pairs}
        roots = [parent for parent, _ in pairs if parent not in children]
        # Frames that form a loop have no root, and none is invented for them.
        frames = (*roots, *(parent for parent, _ in pairs), STAND_IN_LINK)
        return stand_in_model(frames[0])

    @property
    def label(self) -> str:
        """What problems of the model name as its file."""
        topic = self.topics.description
        return self.name if topic is None else f"{self.name}:{topic}"

    def root_frame(self, robot: Robot) -> str:
        """Return the frame of a robot's root link, with the prefix of its frames.

        Of a stand-in it is the frame that the missing robot seems to have.
        """
        if robot.name == STAND_IN_NAME:
            return base_frame(self._told.pairs()) or plain_name(robot.root)
        prefix = frame_prefix(joints_of(robot), self._told.pairs())
        return prefix + plain_name(robot.root)

    def top_frame(self, root: str) -> str:
        """Return the frame at the top of the tree of a root frame, such as odom."""
        return top_frame(root, self._told.pairs())

    def frames(self, robot: Robot, joints: JointState) -> FrameTree:
        """Return where all frames are at the time to look at, or else at the end.

        Args:
            robot: its joints hold the frames of which messages say nothing.
            joints: their positions, which messages change.
        """
        history = FrameHistory()
        tree = FrameTree(history)
        transforms, states = self.transforms(history), self.joint_states()
        at_ns = self.recording.end_ns if self.at_ns is None else self.at_ns
        if at_ns is not None:
            jump(self.recording, at_ns, (transforms, states))
        known = {n: q for n, q in states.changed().items() if n in joints.free}
        joints.set_all(known)
        frames = DataFrames(tree)
        frames.changed, frames.pairs = transforms.changed, transforms.pairs
        by_joints = not frames.places_links(robot)
        robot_joints = robot.joints.values() if by_joints else ()
        fixed = [joint.name for joint in robot_joints if joint.type != "floating"]
        kinematics, prefix = joints.kinematics, frames.prefix_of(robot)
        hang_robot(tree, robot, kinematics, joints.all_positions(), fixed, prefix)
        frames.settle()
        return tree

    def transforms(self, history: FrameHistory) -> TransformTopics:
        """Return what takes the transforms into a history, and expects the first ones.

        Args:
            history: an empty one.
        """
        made = self._make_transforms(history)
        made.expect_as(self._told)
        return made

    def joint_states(self) -> JointStateTopics:
        """Return what takes the positions of joints."""
        decoding = Decoding(self.decoding.types)
        return JointStateTopics(self.topics.joint_states, decoding.decode)

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
        return Decoding(self.decoding.types).transforms

    def _make_transforms(self, history: FrameHistory) -> TransformTopics:
        topics, decode = self.topics, self.transform_decoder()
        return TransformTopics(
            history, topics.moving, topics.static, decode, self._index
        )

    def _first_transforms(self) -> Iterator[Recorded]:
        recording, moving = self.recording, self.topics.moving
        start = recording.start_ns
        if start is not None and moving:
            end = start + round(FIRST_SECONDS * 1e9)
            yield from recording.messages(start, end, moving)
        yield from (m for m in recording.latched() if m.topic in self._told.always)

    def description_of(self, topic: str) -> str | None:
        """Return the last text that a topic has sent; None when there is none."""
        if topic not in self._descriptions:
            # Not every topic of strings is latched, or has the name of one that is.
            last = self.recording.last(topic, self.recording.end_ns or 0)
            decoding = Decoding(self.decoding.types)
            text = "" if last is None else decoding.text(last)
            self._descriptions[topic] = text
        return self._descriptions[topic] or None

    def _read_descriptions(self) -> dict[str, str]:
        topics = (self.topics.description, *self.topics.others)
        found: dict[str, str] = {}
        for message in self.recording.latched():
            if message.topic in topics:
                text = self.decoding.text(message)
                found[message.topic] = text or found.get(message.topic, "")
        return found
