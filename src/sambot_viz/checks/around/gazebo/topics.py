"""List the Gazebo topics that sensors and plugins of a model send and receive."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.running.endpoints import with_endpoints
from sambot_viz.checks.around.running.known import SENSOR
from sambot_viz.checks.around.running.simulated import sensor_node
from sambot_viz.checks.around.running.system import Endpoint, RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import nearest
from sambot_viz.robot.xml.element import Element

_MISSPELT = 0.75


class GazeboTopic(NamedTuple):
    """A topic of Gazebo that the model sends or receives."""

    node: RunningNode
    end: Endpoint

    @property
    def name(self) -> str:
        """The topic, without a leading slash; empty where Gazebo generates it."""
        return bare(self.end.topic)

    @property
    def kind(self) -> str:
        """Its type, without the package."""
        return self.end.message

    @property
    def what(self) -> str:
        """The sensor or plugin that sends or receives it."""
        what = "sensor" if self.node.package == SENSOR else "plugin"
        return f"the {what} {self.node.name}"

    @property
    def verb(self) -> str:
        """The verb for the finding: "sends" or "takes"."""
        return "sends" if self.end.publishes else "takes"


def model_topics(around: Surroundings) -> list[GazeboTopic]:
    """Return the Gazebo topics that the model names, and sends or receives."""
    return [topic for topic in _all(around) if topic.name]


def unnamed(around: Surroundings) -> list[GazeboTopic]:
    """Return those without a name in the model: Gazebo generates their topics."""
    return [topic for topic in _all(around) if not topic.name and _is_left_out(topic)]


def _all(around: Surroundings) -> Iterator[GazeboTopic]:
    for node in around.running.started:
        for end in node.endpoints if not node.is_bridge else ():
            if end.in_gazebo:
                yield GazeboTopic(node, end)


def _is_left_out(topic: GazeboTopic) -> bool:
    """Return whether an element is really absent: no other one misspells it."""
    tags = [given.name for given in topic.node.parameters]
    return nearest(topic.end.parameter, tags, _MISSPELT) is None


def topics_of_sensor(sensor: Element) -> list[GazeboTopic]:
    """Return the topics that a <sensor> names; none for one of Gazebo Classic."""
    return [
        GazeboTopic(node, end)
        for each in sensor_node(sensor)
        for node in [with_endpoints(each, lambda _: None, displays=False)]
        for end in node.endpoints
        if end.topic
    ]


def doubled_topics(around: Surroundings) -> frozenset[str]:
    """Return the topics that sensors of different types have."""
    kinds: dict[str, set[str]] = {}
    for node in around.running.started:
        given = node.parameter("topic") if node.package == SENSOR else None
        if given is not None and given.value and node.endpoints:
            kinds.setdefault(bare(given.value), set()).add(node.executable)
    return frozenset(topic for topic, types in kinds.items() if len(types) > 1)
