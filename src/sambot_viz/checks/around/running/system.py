"""Model the running system of launch files: nodes, topics and transforms.

The package reads launch files and never runs them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from sambot_viz.cached import cached_property
from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.errors import Place

Starts = Literal["yes", "no", "unknown"]
"""Three values: "unknown" for anything that depends on an unknown value."""


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A topic that a node publishes or subscribes to.

    Attributes:
        topic: its full name, with namespace and remappings, such as /robot/odom.
        kind: its type, such as nav_msgs/msg/Odometry; empty when unknown.
        publishes: True for a publisher, False for a subscription.
        place: the line that defines it: a parameter, a bridge's entry or the node.
        written: the name there, before namespace and remappings.
        parameter: the parameter that names it; empty without one.
        in_gazebo: it is a topic of Gazebo, not of ROS. For a name that Gazebo
            generates, `topic` is empty, and `written` has the part that Gazebo adds.
        is_seldom: few users need it.
        latched: later subscribers also get the last message; "once" where no other
            follows, else "often".
        typed_at: the line that decides on its type; None for an uncertain one.
        switch: the parameter and the value that change the type or the topic.
    """

    topic: str
    kind: str
    publishes: bool
    place: Place
    written: str = ""
    parameter: str = ""
    in_gazebo: bool = False
    is_seldom: bool = False
    latched: str = ""
    typed_at: Place | None = None
    switch: tuple[str, str] = ("", "")

    @property
    def message(self) -> str:
        """The type without its package."""
        return re.split("[/.]", self.kind)[-1]


@dataclass(frozen=True, slots=True)
class PublishedTransform:
    """A transform that a node publishes.

    Attributes:
        parent: the frame it begins at.
        child: the frame whose pose it is.
        place: the line that says so.
    """

    parent: str
    child: str
    place: Place


@dataclass(frozen=True, slots=True)
class NeededFrame:
    """A frame of odometry that a node needs a transform to.

    Attributes:
        name: the frame.
        place: the line that says so.
    """

    name: str
    place: Place


@dataclass(frozen=True, slots=True)
class GivenParameter:
    """A parameter that a node gets.

    Attributes:
        name: its name, with dots.
        values: the text of the value, or of each item of a list; None when unknown.
        place: its line.
        given_at: where the launch file names its file; None for a parameter in the
            launch file itself.
        is_robot: the value is the text of a robot.
        robot: the command or the file that returns this text, as far as known.
        is_argument: the value comes from a launch argument.
    """

    name: str
    values: tuple[str, ...] | None
    place: Place
    given_at: Place | None = None
    is_robot: bool = False
    robot: str = ""
    is_argument: bool = False

    @property
    def value(self) -> str | None:
        """The value; None for an unknown value and for a list."""
        known = self.values is not None and len(self.values) == 1
        return self.values[0] if known and self.values else None


@dataclass(frozen=True, slots=True)
class GivenFile:
    """A file with parameters that a node gets.

    Attributes:
        shown: the file, as the user would write it.
        place: where the launch file names it.
        is_read: it has parameters for this node.
    """

    shown: str
    place: Place
    is_read: bool


@dataclass(frozen=True, slots=True)
class RunningNode:
    """A node that launch files start, or Gazebo.

    Attributes:
        package: its package; empty when unknown.
        executable: the program.
        name: its name; empty when unknown.
        namespace: such as /robot; / at the top, empty when unknown.
        starts: whether it starts.
        parameters: its parameters; of two with one name the last counts.
        parameters_known: it has no other parameters.
        remappings: topic → topic, as written.
        arguments: its arguments; None for an unknown one.
        place: its place in the launch file.
        chain: the places that include the launch files on the way there; the launch
            file of the user comes first.
        endpoints: the topics that it publishes and subscribes to, as far as known.
        transforms: the transforms that it publishes, as far as known.
        needs: the frames that it needs.
        endpoints_known: it has no other topics and transforms.
        is_simulator: it is Gazebo itself.
        argument_places: the place of each argument, where they have separate places.
        files: its parameter files, as far as they exist here.
    """

    package: str
    executable: str
    name: str
    namespace: str
    starts: Starts
    parameters: tuple[GivenParameter, ...]
    parameters_known: bool
    remappings: tuple[tuple[str, str], ...]
    arguments: tuple[str | None, ...]
    place: Place
    chain: tuple[Place, ...] = ()
    endpoints: tuple[Endpoint, ...] = ()
    transforms: tuple[PublishedTransform, ...] = ()
    needs: tuple[NeededFrame, ...] = ()
    endpoints_known: bool = False
    is_simulator: bool = False
    argument_places: tuple[Place, ...] = ()
    files: tuple[GivenFile, ...] = ()

    @property
    def placed_arguments(self) -> tuple[tuple[str | None, Place], ...]:
        """The arguments, each with its place."""
        places = self.argument_places or (self.place,) * len(self.arguments)
        return tuple(zip(self.arguments, places, strict=False))

    @property
    def path(self) -> str:
        """The full name, such as /robot/ekf_filter_node."""
        return f"{self.namespace.rstrip('/')}/{self.name or self.executable}"

    @property
    def launch(self) -> str:
        """The launch file that the user starts."""
        return (*self.chain, self.place)[0].file

    @property
    def is_bridge(self) -> bool:
        """True when it carries topics between Gazebo and ROS."""
        return len({end.in_gazebo for end in self.endpoints}) > 1

    def parameter(self, name: str) -> GivenParameter | None:
        """Return one of its parameters; None for a missing one."""
        named = (each for each in reversed(self.parameters) if each.name == name)
        return next(named, None)


@dataclass(frozen=True, slots=True)
class UnknownStart:
    """An action that may start unknown nodes.

    Attributes:
        what: the action, such as an include of an unavailable package.
        place: its line.
    """

    what: str
    place: Place


@dataclass(frozen=True)
class RunningSystem:
    """The system that launch files start.

    Attributes:
        launches: the launch files, as the user would write them.
        nodes: all nodes in the order of the files, including those that do not start.
        unknown: the actions that may start unknown nodes.
        declared: names of the launch arguments.
        paths: the paths in packages that actions use, with their places.
        unclear: launch arguments that are neither true nor false, with their values and
            the places that set these → the places that use them as conditions.
    """

    launches: tuple[str, ...] = ()
    nodes: tuple[RunningNode, ...] = ()
    unknown: tuple[UnknownStart, ...] = field(default=())
    declared: frozenset[str] = frozenset()
    paths: tuple[Fact, ...] = ()
    unclear: Mapping[tuple[str, str, Place], Place] = field(
        default_factory=dict[tuple[str, str, Place], Place]
    )

    @property
    def is_whole(self) -> bool:
        """True when no nodes start except the known ones."""
        return not self.unknown

    @cached_property
    def started(self) -> tuple[RunningNode, ...]:
        """The nodes that start, or may."""
        return tuple(node for node in self.nodes if node.starts != "no")

    @property
    def simulates(self) -> bool:
        """True when Gazebo starts, or may."""
        return any(node.is_simulator for node in self.started)

    @property
    def is_known(self) -> bool:
        """True when all its nodes and their topics are known."""
        return self.is_whole and all(
            node.endpoints_known for node in self.nodes if node.starts != "no"
        )

    def endpoints(self, topic: str) -> Iterator[tuple[RunningNode, Endpoint]]:
        """Yield the publishers and subscriptions of a topic, by its full name."""
        for node in self.started:
            for endpoint in node.endpoints:
                if endpoint.topic == topic:
                    yield node, endpoint
