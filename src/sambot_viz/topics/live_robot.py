"""The robot of a live source: its description, and what moves it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from sambot_viz.errors import DecodeError
from sambot_viz.frames import FrameHistory
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.message import Recorded
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

    Attributes:
        source: as given.
        name: the address of the source.
        decoding: decodes its messages.
        topics: those that are the robot's, as far as they are known.
        on_description: called with the text of a robot, again when it changes.
        on_topics: called when `topics` has changed.
        on_status: called when the source is doing otherwise.
    """

    def __init__(self, source: Source, types: MessageTypes) -> None:
        self.source = source
        self.name = source.uri
        self.decoding = Decoding(types)
        self.topics = RobotTopics()
        self._framed = threading.Condition()
        self.on_description: Callable[[str], object] = lambda text: None
        self.on_topics: list[Callable[[], object]] = []
        self.on_status: list[Callable[[], object]] = []
        self._description: str | None = None
        self._seen = 0
        self._frames = TransformTopics(FrameHistory(), (), (), self.decoding.transforms)
        source.on_topics = self._look
        source.on_status = self._tell_status

    @property
    def model(self) -> str:
        """The XML text of a robot of one link: the description is still to come."""
        return stand_in_model()

    @property
    def label(self) -> str:
        """What problems of the model name as its file."""
        return f"{self.name} {self.topics.description or '/robot_description'}"

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

    def top_frame(self, root: str, timeout: float) -> str:
        """Return the frame at the top of the tree of a root link, such as odom.

        Args:
            root: the link; itself when nothing is known to hold it.
            timeout: how long to wait for transforms that do [s].
        """
        with self._framed:
            self._framed.wait_for(lambda: self._top(root) != root, timeout)
            return self._top(root)

    def _top(self, root: str) -> str:
        return top_frame(root, self._frames.pairs())

    def _look(self) -> None:
        types = self.decoding.types
        known = {
            name: types.decoder(topic.schema, topic.message_encoding).type_name
            for name, topic in self.source.topics().items()
            if topic.reason is None
        }
        before, self.topics = self.topics, robot_topics(known)
        if self.topics == before:
            return
        if self.topics.description not in (None, before.description):
            self.source.subscribe(self.topics.description or "", self._describe)
        for topic in (*self.topics.moving, *self.topics.static):
            if self._seen < ENOUGH:
                self.source.subscribe(topic, self._expect)
        for listener in list(self.on_topics):
            listener()
        self._tell_status()

    def _describe(self, message: Recorded) -> None:
        try:
            text: Any = self.decoding.decode(message).data
        except (DecodeError, AttributeError):
            return
        if text and text != self._description:
            self._description = str(text)
            self.on_description(self._description)
            self._tell_status()

    def _expect(self, message: Recorded) -> None:
        with self._framed:
            self._frames.expect([message])
            self._framed.notify_all()
        self._seen += 1
        if self._seen == ENOUGH:
            for topic in (*self.topics.moving, *self.topics.static):
                self.source.unsubscribe(topic, self._expect)

    def _tell_status(self) -> None:
        for listener in list(self.on_status):
            listener()
