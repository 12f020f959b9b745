"""Publishers, subscriptions and services of nodes, and all of those of one topic."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from sambot_viz.sources.qos import Qos


class Kind(Enum):
    """What an endpoint does."""

    PUBLISHER = "publisher"
    SUBSCRIBER = "subscriber"
    SERVICE = "service"


@dataclass(frozen=True, slots=True)
class RosEndpoint:
    """A publisher, a subscriber or a service of a node.

    Attributes:
        kind: which of them.
        node: its full name; "" where it is not known.
        name: of the topic or the service.
        type_name: as ROS 2 writes it, such as sensor_msgs/msg/LaserScan.
        type_hash: of the definition, such as RIHS01_…; "" where it is not known.
        qos: what it offers or asks for.
    """

    kind: Kind
    node: str
    name: str
    type_name: str
    type_hash: str = ""
    qos: Qos | None = None


@dataclass(frozen=True, slots=True)
class TopicEndpoints:
    """Who publishes a topic and who subscribes to it, each with its QoS.

    Attributes:
        publishers: the first one first.
        subscribers: the same; without this program.
        matches_qos: subscribers get nothing from publishers that offer less than they
            ask for: so it is with DDS, zenoh hands on all.
    """

    publishers: tuple[RosEndpoint, ...]
    subscribers: tuple[RosEndpoint, ...]
    matches_qos: bool = True


def nodes_of(endpoints: Iterable[RosEndpoint]) -> tuple[str, ...]:
    """Return the names of the nodes that have said which endpoints they have."""
    return tuple(dict.fromkeys(one.node for one in endpoints if one.node))
