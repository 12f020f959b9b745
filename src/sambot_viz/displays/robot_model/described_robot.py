"""The robot of a topic: the opened one, or one that is read in the background."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

from sambot_viz.displays.display import DisplayContext, Status
from sambot_viz.displays.robot_display import (
    Description,
    ModelRequest,
    ModelResult,
    WantedQos,
)
from sambot_viz.robot.model import Robot

Change = Literal["none", "edited", "other"]
_OF_TOPICS = (("Text",), ("Opened",), ("Gone",))


class DescribedRobot:
    """Chooses the robot of one display by the topic that it names.

    Args:
        context: the opened robot, the robots of topics, and the reader of models.
        wanted: returns the topic and the QoS of the display.
        on_read: called when a model has been read, or could not be.

    Attributes:
        robot: the robot to draw, or None while there is none.
        is_opened: whether it is the one that was opened.
        status: why there is no robot, or not the latest one; None if all is well.
        described: the robot of the topic; None where no messages come.
    """

    def __init__(
        self,
        context: DisplayContext,
        wanted: Callable[[], tuple[str, WantedQos]],
        on_read: Callable[[], None],
    ) -> None:
        self.robot: Robot | None = None
        self.is_opened = False
        self.status: Status | None = None
        self.described: Description | None = None
        self._context = context
        self._wanted_topic = wanted
        self._on_read = on_read
        self._source: tuple[object, ...] = ()

    def choose(self) -> Change:
        """Take the robot that the properties ask for.

        Returns:
            "edited" when it is another version of the opened robot, "other" when it
            is another robot.
        """
        source = self._wanted()
        if source == self._source:
            return "none"
        before, self._source = self._source, source
        was_opened, self.status = self.is_opened, None
        if before[:1] in _OF_TOPICS and source[0] in ("Text", "Gone"):
            # The last good robot stays, until the new one is read.
            if source[0] == "Text":
                self._read(self.described, trusted=False)
            return "none"
        self.robot = None
        self.is_opened = source[0] == "Opened"
        if self.is_opened:
            self.robot = self._context.robot
        elif source[0] == "Text":
            self._read(self.described, trusted=False)
        return "edited" if self.is_opened and was_opened else "other"

    def forget(self) -> None:
        """Choose again from the start when the robot is next asked for."""
        self._source = ()

    def frame_of(self, link: str, prefix: str) -> str:
        """Return the TF frame of a link.

        Args:
            link: of the robot.
            prefix: the TF Prefix of the display.
        """
        frame = f"{prefix}/{link}" if prefix else link
        topic, descriptions = self.topic, self._context.descriptions
        if not topic or descriptions is None:
            return frame
        return descriptions.link_frame(topic, frame)

    @property
    def is_kept_apart(self) -> bool:
        """Whether its frames have the name space of its topic, whatever its prefix."""
        robot = self.robot
        return robot is not None and self.frame_of(robot.root, "") != robot.root

    @property
    def topic(self) -> str:
        """The topic of the robot; "" for one that no topic describes."""
        name = self._wanted_topic()[0].removeprefix("/")
        return f"/{name}" if name else ""

    # For what derives from it

    def _wanted(self) -> tuple[object, ...]:
        """Return what the properties ask for."""
        self.described = None
        topic, qos = self._wanted_topic()
        if self._context.descriptions is not None and topic:
            # As ROS completes the name of a node without a namespace.
            topic = f"/{topic.removeprefix('/')}"
            self.described = self._context.descriptions.of(topic, qos)
            if self.described.text is not None:
                return ("Text", topic, self.described.text)
            if not self.described.is_opened:
                return ("Gone",)
        return ("Opened", id(self._context.robot))

    def _read(self, model: Path | Description | None, trusted: bool) -> None:
        """Start reading a file, or the text of a topic; `_take` gets the result."""
        models = self._context.models
        if model is None or models is None:
            return
        if self.robot is None:
            what = "file" if isinstance(model, Path) else "of the topic"
            self.status = Status("Warn", f"The model {what} is still being read")
        source = self._source

        def done(result: ModelResult) -> None:
            self._context.apply(lambda: self._take(source, trusted, result))

        models.read(ModelRequest(self, model, trusted, done))

    def _take(
        self, source: tuple[object, ...], trusted: bool, result: ModelResult
    ) -> None:
        """Keep what was read, unless another robot is wanted by now."""
        if source != self._source:
            return
        if isinstance(result, Robot):
            self.robot, self.status, self.is_opened = result, None, False
        else:
            told = self._may_quote(trusted)
            why = result.problems[0].message if told else "see `sambot-viz check`"
            self.status = Status("Error", f"URDF failed Model parse: {why}")
        self._on_read()

    def _may_quote(self, trusted: bool) -> bool:
        """Return whether the problems of a model may be shown: a topic is public."""
        del trusted
        return True
