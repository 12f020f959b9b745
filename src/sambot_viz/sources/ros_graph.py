"""The nodes of a robot with what they publish, subscribe to and serve.

A transport of ROS 2 itself says this of each endpoint; bridges say less of it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz import limits
from sambot_viz.sources.qos import Qos, parse_qos, profile_text
from sambot_viz.sources.ros_endpoint import Kind, RosEndpoint, TopicEndpoints
from sambot_viz.sources.source import Receivers

_MANGLED = re.compile(r"(\w+)::(msg|srv|action)::dds_::(\w+?)_", re.ASCII)
NODE = "/sambot_viz"
"""What this program is called among the nodes."""
UNNAMED = "an unnamed program"
"""Stands for an endpoint whose node is unknown."""
NO_HASH = "TypeHashNotSupported"
"""What ROS 2 Humble has where later ones have the hash of a type."""


class RosGraph:
    """The endpoints of a robot by the key with which they come and go.

    Args:
        matches_qos: as `TopicEndpoints.matches_qos`.
    """

    def __init__(self, matches_qos: bool) -> None:
        self._matches_qos = matches_qos
        self._endpoints: dict[str, RosEndpoint] = {}
        self._named: dict[tuple[Kind, str], dict[str, RosEndpoint]] = {}

    def add(self, key: str, endpoint: RosEndpoint) -> bool:
        """Add an endpoint; return whether there was room for it."""
        named = endpoint.kind, endpoint.name
        if named not in self._named and self.is_full:
            return False
        self.discard(key)
        self._endpoints[key] = endpoint
        self._named.setdefault(named, {})[key] = endpoint
        return True

    def discard(self, key: str) -> None:
        """Remove an endpoint, if it is there."""
        if (endpoint := self._endpoints.pop(key, None)) is not None:
            named = endpoint.kind, endpoint.name
            del self._named[named][key]
            if not self._named[named]:
                del self._named[named]

    def __len__(self) -> int:
        return len(self._endpoints)

    @property
    def is_full(self) -> bool:
        """Whether names are left out."""
        return len(self._named) >= limits.TOPICS.value

    @property
    def has_nodes(self) -> bool:
        """Whether the node of an endpoint is known."""
        return any(one.node for one in self._endpoints.values())

    def topics(self) -> Iterator[str]:
        """Yield the topics that are published, then those that only are wanted."""
        published = [name for kind, name in self._named if kind is Kind.PUBLISHER]
        yield from published
        others = dict.fromkeys(
            name for kind, name in self._named if kind is Kind.SUBSCRIBER
        )
        for name in published:
            others.pop(name, None)
        yield from (name for name in others if self.takers(name))

    def of(self, kind: Kind, name: str) -> tuple[RosEndpoint, ...]:
        """Return the endpoints of a kind with a name, the first one first."""
        return tuple(self._named.get((kind, name), {}).values())

    def takers(self, topic: str) -> list[RosEndpoint]:
        """Return who has subscribed to a topic.

        Others that show the robot by this program take nothing.
        """
        return [one for one in self.of(Kind.SUBSCRIBER, topic) if one.node != NODE]

    def endpoints(self, topic: str) -> TopicEndpoints:
        """Return who publishes a topic and who subscribes to it."""
        publishers = self.of(Kind.PUBLISHER, topic)
        return TopicEndpoints(publishers, (*self.takers(topic),), self._matches_qos)

    def receivers(self, topic: str) -> Receivers:
        """Return who has subscribed to a topic, and the type that the robot knows."""
        takers = self.takers(topic)
        known = (*takers, *self.of(Kind.PUBLISHER, topic))
        names = tuple(dict.fromkeys(one.node or UNNAMED for one in takers))
        return Receivers(names, known[0].type_name if known else "")

    def offered(self, topic: str) -> Qos | None:
        """Return what the publishers of a topic offer together."""
        profiles = [one.qos for one in self.of(Kind.PUBLISHER, topic) if one.qos]
        return parse_qos("\n".join(map(profile_text, profiles)))


def mangled(type_name: str) -> str:
    """Return the name on the wire of a type such as std_msgs/msg/String."""
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def demangled(wire_name: str) -> str:
    """Return the name of a type for one on the wire; "" where it is none of ROS."""
    found = _MANGLED.fullmatch(wire_name)
    return "/".join(found.groups()) if found else ""
