"""The robot of a live source: its description, and what moves it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from pathlib import Path

from sambot_viz.frames import FrameHistory
from sambot_viz.frames.frame_prefix import frame_prefix, joints_of
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.messages import Decoder, MessageTypes
from sambot_viz.robot.model import Robot
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.sources.recorder import SourceRecorder
from sambot_viz.sources.source import Source
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.robot_topics import (
    RobotTopics,
    robot_topics,
    stand_in_model,
    top_frame,
)
from sambot_viz.topics.transforms import TransformTopics

ENOUGH = 300
"""After so many messages the frames that there are have been seen."""


class LiveRobot:
    """What a live source says of a robot; many sessions follow it.

    Its listeners are called in the thread of the source, and must only post.

    Args:
        source: its connection.
        types: decodes its messages.
        recordings: the folder of recordings that users of the page start; None: they
            may not.

    Attributes:
        source: as given.
        name: the address of the source.
        decoding: decodes its messages.
        named: descriptions that a config asks for.
        topics: those that are the robot's, as far as they are known.
        recorder: records what the source gives.
        refusal: why the last description cannot be shown; empty when it can.
        on_description: called with the text of a robot, again when it changes.
        on_topics: called when the source has other topics.
        on_status: called when the source is doing otherwise.
    """

    def __init__(
        self, source: Source, types: MessageTypes, recordings: Path | None = None
    ) -> None:
        self.source = source
        self.name = source.uri
        self.decoding = Decoding(types)
        self.named: Sequence[str] = ()
        self.topics = RobotTopics()
        self.refusal = ""
        self._framed = threading.Condition()
        self.on_description: Callable[[str], object] = lambda text: None
        self.on_topics: list[Callable[[], object]] = []
        self.on_status: list[Callable[[], object]] = []
        self._description: str | None = None
        self._seen = 0
        self._frames = TransformTopics(FrameHistory(), (), (), self.decoding.transforms)
        source.on_topics = self._look
        source.on_status = self.tell_status
        # After `_look` is set: the recorder is told of topics first, and passes it on.
        self.recorder = SourceRecorder(source, recordings, self.tell_status)

    def close(self) -> None:
        """End the recording and the connection; a second call does nothing."""
        # What has come is still written.
        self.recorder.close()
        self.source.close()

    @property
    def model(self) -> str:
        """The XML text of a robot of one link: the description is still to come."""
        return stand_in_model()

    @property
    def label(self) -> str:
        """What problems of the model name as its file."""
        return f"{self.name} {self.topics.description or '/robot_description'}"

    @property
    def has_description(self) -> bool:
        """Whether a robot was described."""
        return self._description is not None

    @property
    def sentence(self) -> str:
        """How the source is, and what of the robot is missing."""
        status = self.source.status
        if not status.is_connected or self._description is not None:
            return status.sentence
        if self.topics.description is None:
            return (
                f"{status.sentence}; no /robot_description is published: start "
                "robot_state_publisher, or give the robot with --model"
            )
        return f"{status.sentence}; waiting for {self.topics.description}"

    def decoder(self, topic: SourceTopic) -> Decoder:
        """Return the decoder of a topic, with the reason when there is none."""
        return self.decoding.types.decoder(topic.schema, topic.message_encoding)

    def root_and_top(self, robot: Robot, timeout: float) -> tuple[str, str]:
        """Return the frame of a robot's root link, and the one at the top of its tree.

        Args:
            robot: the robot; its root is the top when nothing is known to hold it.
            timeout: how long to wait for transforms that do [s].
        """

        def is_held() -> bool:
            root, top = self._root_and_top(robot)
            return root != top

        with self._framed:
            self._framed.wait_for(is_held, timeout)
            return self._root_and_top(robot)

    def _root_and_top(self, robot: Robot) -> tuple[str, str]:
        pairs = list(self._frames.pairs())
        root = frame_prefix(joints_of(robot), pairs) + plain_name(robot.root)
        return root, top_frame(root, pairs)

    def _look(self) -> None:
        known = {
            name: self.decoder(topic).type_name
            for name, topic in self.source.topics().items()
            if topic.reason is None
        }
        before, self.topics = self.topics, robot_topics(known, self.named)
        if self.topics.description not in (None, before.description):
            self.source.subscribe(self.topics.description or "", self._describe)
        for topic in (*self.topics.moving, *self.topics.static):
            if self._seen < ENOUGH:
                self.source.subscribe(topic, self._expect)
        for listener in list(self.on_topics):
            listener()
        if self.topics != before:
            self.tell_status()

    def _describe(self, message: Recorded) -> None:
        text = self.decoding.text(message)
        if text and text != self._description:
            self._description = text
            self.on_description(text)
            self.tell_status()

    def _expect(self, message: Recorded) -> None:
        with self._framed:
            self._frames.expect([message])
            self._framed.notify_all()
        self._seen += 1
        if self._seen == ENOUGH:
            for topic in (*self.topics.moving, *self.topics.static):
                self.source.unsubscribe(topic, self._expect)

    def tell_status(self) -> None:
        """Say that the source or its recording is doing otherwise; in any thread."""
        for listener in list(self.on_status):
            listener()
