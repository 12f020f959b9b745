"""The topics of Gazebo that the sensors and plugins of a model send and take."""

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
    """A topic of Gazebo that the model sends or takes."""

    node: RunningNode
    end: Endpoint

    @property
    def name(self) -> str:
        """The topic, without a slash before it; empty where Gazebo makes it up."""
        return bare(self.end.topic)

    @property
    def kind(self) -> str:
        """Its type, without the package."""
        return self.end.message

    @property
    def what(self) -> str:
        """What sends or takes it."""
        what = "sensor" if self.node.package == SENSOR else "plugin"
        return f"the {what} {self.node.name}"

    @property
    def verb(self) -> str:
        """What that does with it."""
        return "sends" if self.end.publishes else "takes"


def model_topics(around: Surroundings) -> list[GazeboTopic]:
    """Return the topics of Gazebo that the model sends or takes, and names."""
    return [topic for topic in _all(around) if topic.name]


def unnamed(around: Surroundings) -> list[GazeboTopic]:
    """Return those that the model does not name: Gazebo makes their topics up."""
    return [topic for topic in _all(around) if not topic.name and _is_left_out(topic)]


def _all(around: Surroundings) -> Iterator[GazeboTopic]:
    for node in around.running.started:
        for end in node.endpoints if not node.is_bridge else ():
            if end.in_gazebo:
                yield GazeboTopic(node, end)


def _is_left_out(topic: GazeboTopic) -> bool:
    """False where another element is this one, misspelt."""
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
