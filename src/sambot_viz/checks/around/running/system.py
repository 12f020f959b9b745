"""What runs when launch files are started: nodes, topics and transforms.

A model of it, not the programs: launch files are read, never run.
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
"""Three values: what depends on something that is not known is unknown."""


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A topic that a node publishes or subscribes to.

    Attributes:
        topic: its whole name, with namespace and remappings, such as /robot/odom.
        kind: its type, such as nav_msgs/msg/Odometry; empty when it is not known.
        publishes: True for a publisher, False for a subscription.
        place: the line that says so: of a parameter, a bridge's entry or the node.
        written: the name there, before namespace and remappings.
        parameter: the parameter that names it; empty without one.
        in_gazebo: it is a topic of Gazebo, not of ROS. One that Gazebo makes up has no
            topic here, and in written what Gazebo adds to it.
        is_seldom: few want what it sends.
        latched: who subscribes later gets the last message too; "once" where no other
            follows, else "often".
        typed_at: the line that decides on its type; None where that is not certain.
        switch: the parameter and the value with which the type or the topic is another.
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
    """A parameter that a node is given.

    Attributes:
        name: its name, with dots.
        values: the text of the value, or of each item of a list; None where it is
            not known.
        place: its line.
        given_at: where the launch file names the file that it is in; None for one
            that the launch file has itself.
        is_robot: the value is the text of a robot.
        robot: the command or the file that this text comes from, as far as is known.
        is_argument: the value is that of a launch argument.
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
        """The value; None when it is not known, or a list."""
        known = self.values is not None and len(self.values) == 1
        return self.values[0] if known and self.values else None


@dataclass(frozen=True, slots=True)
class GivenFile:
    """A file with parameters that a node is given.

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
        package: its package; empty when it is not known.
        executable: the program.
        name: what it is called; empty when it is not known.
        namespace: such as /robot; / at the top, empty when it is not known.
        starts: whether it does.
        parameters: what it is given; of two with one name the last counts.
        parameters_known: there are no others.
        remappings: topic → topic, as written.
        arguments: its arguments; None for one that is not known.
        place: where the launch file has it.
        chain: where the launch files that lead there are included, first the one
            that the user starts.
        endpoints: the topics it publishes and subscribes to, as far as is known.
        transforms: the transforms it publishes, as far as is known.
        needs: the frames that it needs.
        endpoints_known: it has no other topics and transforms.
        is_simulator: it is Gazebo itself.
        argument_places: the place of each of its arguments, where these have their own.
        files: the files with parameters that it is given, as far as they are here.
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
        """The whole name, such as /robot/ekf_filter_node."""
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
        """Return a parameter that it is given; None for others."""
        named = (each for each in reversed(self.parameters) if each.name == name)
        return next(named, None)


@dataclass(frozen=True, slots=True)
class UnknownStart:
    """Where more may start than is known.

    Attributes:
        what: the action, such as an include of a package that is not here.
        place: its line.
    """

    what: str
    place: Place


@dataclass(frozen=True)
class RunningSystem:
    """What runs when launch files are started.

    Attributes:
        launches: the launch files, as the user would write them.
        nodes: the nodes, also those that do not start, in the order of the files.
        unknown: where more may start than is known.
        declared: names of the launch arguments.
        paths: the paths in packages that are given to something, with their places.
        unclear: launch arguments that are neither true nor false, with their values
            and where these are set → where they are conditions.
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
        """True when nothing starts but the nodes that are known here."""
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
        """True when it is whole, and the topics of all its nodes are known."""
        return self.is_whole and all(
            node.endpoints_known for node in self.nodes if node.starts != "no"
        )

    def endpoints(self, topic: str) -> Iterator[tuple[RunningNode, Endpoint]]:
        """Give who publishes and who subscribes to a topic, by its whole name."""
        for node in self.started:
            for endpoint in node.endpoints:
                if endpoint.topic == topic:
                    yield node, endpoint
