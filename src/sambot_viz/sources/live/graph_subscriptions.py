"""The topics of a robot that are subscribed to where its nodes tell what they have.

A topic is subscribed to with its type and any definition of it; each message says which
one it has, so that two nodes may differ.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from sambot_viz import limits
from sambot_viz.sources.live.conversation import Conversation
from sambot_viz.sources.live.type_descriptions import TypeDescriptions, service_of
from sambot_viz.sources.message import Recorded, TopicChannel, is_latched_name
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import Kind, RosEndpoint
from sambot_viz.sources.ros_graph import RosGraph


class Closing(Protocol):
    """What ends something that was begun."""

    def __call__(self) -> object:
        """End it."""
        ...


@dataclass(slots=True, eq=False)
class GraphSubscription:
    """A topic that is subscribed to.

    Attributes:
        topic: its name.
        type_name: of its messages.
        offered: what its publishers offered when it was subscribed to.
        close: ends it.
        channels: by the hash of the definition.
        is_heard: a message has come.
    """

    topic: str
    type_name: str
    offered: Qos
    close: Closing = lambda: None
    channels: dict[str, TopicChannel] = field(default_factory=dict[str, TopicChannel])
    is_heard: bool = False


class GraphSubscriptions(ABC):
    """Subscribes to the wanted topics that exist, and delivers their messages.

    Args:
        owner: the conversation, which counts unreadable messages.
        graph: the graph of the present nodes.
        types: definitions of messages.
    """

    def __init__(
        self, owner: Conversation, graph: RosGraph, types: TypeDescriptions
    ) -> None:
        self._owner, self._graph, self._types = owner, graph, types
        self._wanted: frozenset[str] = frozenset()
        self._there: dict[str, GraphSubscription] = {}

    @abstractmethod
    def _open(self, subscription: GraphSubscription, publisher: RosEndpoint) -> Closing:
        """Subscribe to a topic, as its first publisher has it; return what ends it."""

    @abstractmethod
    def _suits(self, subscription: GraphSubscription, offered: Qos) -> bool:
        """Return whether a subscription gets all of what publishers now offer."""

    def update(self, wanted: frozenset[str]) -> None:
        """Subscribe to the wanted topics that exist, and to no others."""
        for topic in self._wanted - wanted:
            self._unsubscribe(topic)
        self._wanted = wanted
        for topic in wanted:
            self._subscribe(topic)

    def follow(self, service: RosEndpoint) -> None:
        """Ask for definitions when a service that has them has come."""
        if service.name == service_of(service.node):
            for topic in self._there:
                self._ask_definition(self._graph.of(Kind.PUBLISHER, topic))

    def _subscribe(self, topic: str) -> None:
        """Subscribe to a wanted topic, and again when its publishers ask for that."""
        publishers = self._graph.of(Kind.PUBLISHER, topic)
        if topic not in self._wanted or not publishers:
            return
        type_name = publishers[0].type_name
        offered = self._graph.offered(topic) or Qos()
        known = self._there.get(topic)
        if known is not None:
            if known.type_name == type_name and self._suits(known, offered):
                return
            self._unsubscribe(topic)
        self._ask_definition(publishers)
        made = self._there[topic] = GraphSubscription(topic, type_name, offered)
        made.close = self._open(made, publishers[0])

    def _ask_definition(self, publishers: Sequence[RosEndpoint]) -> None:
        """Ask the first node of a topic what its messages are, if that is not known."""
        if not publishers:
            return
        publisher = publishers[0]
        type_name, type_hash = publisher.type_name, publisher.type_hash
        is_known = self._types.schema(type_name, type_hash).text
        if is_known or not self._graph.of(Kind.SERVICE, service_of(publisher.node)):
            return

        def told() -> None:
            self._owner.topics_changed = True
            for topic, one in tuple(self._there.items()):
                if one.type_name == type_name:
                    # What has come was not read; `update` has what is kept come again
                    # when somebody has been told of the definition.
                    self._unsubscribe(topic)

        self._types.ask(publisher.node, type_name, type_hash, told)

    def _unsubscribe(self, topic: str) -> None:
        if (subscription := self._there.pop(topic, None)) is not None:
            subscription.close()

    def _take(
        self,
        subscription: GraphSubscription,
        type_hash: str,
        payload: bytes,
        stamp: int | None,
    ) -> None:
        """Take a message, with when it was published [ns]."""
        topic = subscription.topic
        if self._there.get(topic) is not subscription:
            return
        subscription.is_heard = True
        channel = subscription.channels.get(type_hash)
        if channel is None and len(subscription.channels) >= limits.CHANNELS.value:
            self._owner.unreadable += 1
            return
        if channel is None:
            channel = subscription.channels[type_hash] = self._channel(
                subscription, type_hash
            )
        clock = self._owner.ends.clock
        if stamp is not None and not subscription.offered.is_any_transient_local:
            clock.note_message(stamp)
        now = clock.now_ns()
        self._owner.ends.put(Recorded(topic, channel, now, stamp, payload))

    def _leave_out(self, topic: str, size: int) -> None:
        """Take note of a message that is too large [bytes]."""
        self._owner.leave_out(topic.encode(), size, True)

    def _channel(self, subscription: GraphSubscription, type_hash: str) -> TopicChannel:
        topic = subscription.topic
        return TopicChannel(
            topic,
            self._types.schema(subscription.type_name, type_hash),
            "cdr",
            qos=self._graph.offered(topic),
            is_latched=is_latched_name(topic),
        )
