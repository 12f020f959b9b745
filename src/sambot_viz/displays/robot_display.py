"""Displays that show a robot: their additions to `Display`, and their inputs.

Most displays draw data. One that draws a robot may read it from a file, sets the frames
of that robot, and waits for mesh files; the rest of the program reaches these through
`Display.robot_display`, so that other displays need not know of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, Protocol, TypeAlias

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot
from sambot_viz.topics.reasons import TopicReason

ModelResult: TypeAlias = "Robot | RobotError"
"""A robot, or the reason why its file gave none."""


@dataclass(frozen=True, slots=True)
class Description:
    """The robot that messages of a topic describe.

    Attributes:
        topic: its name.
        text: the URDF; None for the opened robot, and before one has come.
        label: the name of its file in problems.
        is_opened: whether the robot is the one that was opened.
        level: level of the status of the topic.
        sentence: why there is no robot, or a doubt, with the remedy.
        instead: a topic to use in place of this one; empty without a suggestion.
        reason: why the robot has no place, though its topic is read.
    """

    topic: str
    text: str | None = None
    label: str = ""
    is_opened: bool = False
    level: Literal["Ok", "Warn", "Error"] = "Ok"
    sentence: str = "OK"
    instead: str = ""
    reason: TopicReason | None = None


@dataclass(frozen=True, slots=True)
class WantedQos:
    """The QoS that a display asks for, in RViz's words.

    Attributes:
        reliability: "Reliable", "Best Effort" or "System Default".
        durability: "Transient Local", "Volatile" or "System Default".
    """

    reliability: str
    durability: str


class Descriptions(Protocol):
    """The robots that the topics of a recording or of a live robot describe."""

    def of(self, topic: str, qos: WantedQos) -> Description:
        """Return the robot of a topic; displays draw again when it changes."""
        ...

    def topics(self) -> Sequence[str]:
        """Return the topics that describe robots."""
        ...

    def link_frame(self, topic: str, link: str) -> str:
        """Return the frame of a link of the robot of a topic, in its name space."""
        ...

    def joint_topics(self, topic: str) -> tuple[str, ...]:
        """Return the topics that move the joints of a further robot, as it is one."""
        ...

    def transform_doubts(self) -> Mapping[str, TopicReason]:
        """Return the problems of topics with transforms, by their names."""
        ...


@dataclass(frozen=True, slots=True)
class Repair:
    """A value that would make a status go away, for a button beside it.

    Attributes:
        label: of the button.
        path: the property.
        value: what to set it to.
    """

    label: str
    path: str
    value: str


@dataclass(frozen=True, slots=True)
class ModelRequest:
    """A display's wish for a model to be read.

    Attributes:
        owner: the display; a new request replaces its earlier one.
        path: the file, or the text of a topic.
        trusted: whether its code may run.
        done: called with the result, in another thread.
    """

    owner: object
    path: Path | Description
    trusted: bool
    done: Callable[[ModelResult], None]


class ModelReader(Protocol):
    """Reads models in the background, for displays with a separate model file."""

    @property
    def package_path(self) -> tuple[Path | str, ...]:
        """The folders in which packages are looked for, or ``name=folder``."""
        ...

    def read(self, request: ModelRequest) -> None:
        """Read a model soon."""


class RobotDisplay(Protocol):
    """A display that shows a robot: the opened one, or one that it has read."""

    @property
    def own_robot(self) -> Robot | None:
        """The robot of a file or a topic of the display; None for the opened one."""
        ...

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that `own_robot` is read from, meshes left out."""
        ...

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Problems of the files that the robot is drawn from."""
        ...

    def refusal(self, path: str, value: object) -> str | None:
        """Return why a browser may not set a property to a value, or None."""
        ...

    def read_again(self) -> None:
        """Read `files` again: one of them has been saved."""
        ...

    def publish(self) -> bool:
        """Set the transforms of `own_robot`, and return whether any were new."""
        ...
