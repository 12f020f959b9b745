"""The topics of a robot that are subscribed to over zenoh.

A topic is subscribed to with its type and any definition of it; the key of a message
says which, so that two nodes may differ.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

from sambot_viz import limits
from sambot_viz.sources.live.conversation import Conversation
from sambot_viz.sources.message import Recorded, TopicChannel, is_latched_name
from sambot_viz.sources.ros_graph import Kind, RosEndpoint, RosGraph
from sambot_viz.sources.type_descriptions import TypeDescriptions, service_of
from sambot_viz.sources.zenoh import names
from sambot_viz.sources.zenoh.session import ZenohDeclaration, ZenohSession

_TICKS_FOR_CACHES = 2
"""What is kept has come by then, or its publisher has a cache of the older kind."""


@dataclass(slots=True)
class _ZenohSubscription:
    """A subscription at the router.

    Attributes:
        key: of its messages.
        type_name: of its messages.
        is_latched: what is kept was asked for.
        declared: what takes it back: the subscription and its token.
        channels: by the hash of the definition.
        ticks: how long nothing has come of what is kept; None when that is over.
    """

    key: str
    type_name: str
    is_latched: bool
    declared: tuple[ZenohDeclaration, ...] = ()
    channels: dict[str, TopicChannel] = field(default_factory=dict[str, TopicChannel])
    ticks: int | None = None


class ZenohSubscriptions:
    """Subscribes to what is wanted and there, and hands on what comes.

    Args:
        owner: the conversation, which counts what cannot be read.
        session: of zenoh.
        graph: of the nodes that are there.
        types: definitions of messages.
    """

    def __init__(
        self,
        owner: Conversation,
        session: ZenohSession,
        graph: RosGraph,
        types: TypeDescriptions,
    ) -> None:
        self._owner, self._session = owner, session
        self._graph, self._types = graph, types
        self._wanted: frozenset[str] = frozenset()
        self._there: dict[str, _ZenohSubscription] = {}

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

    def tick(self) -> None:
        """Ask older publishers for what they keep, where nothing has come."""
        for topic, subscription in self._there.items():
            if subscription.ticks is None:
                continue
            subscription.ticks += 1
            if subscription.ticks > _TICKS_FOR_CACHES:
                subscription.ticks = None
                take = partial(self._take, topic, subscription)
                self._session.ask_kept(subscription.key, take)

    def _subscribe(self, topic: str) -> None:
        """Subscribe to a wanted topic, and again when its publishers ask for that."""
        publishers = self._graph.of(Kind.PUBLISHER, topic)
        if topic not in self._wanted or not publishers:
            return
        type_name = publishers[0].type_name
        offered = self._graph.offered(topic)
        is_latched = offered is not None and offered.is_any_transient_local
        known = self._there.get(topic)
        if known is not None:
            if known.type_name == type_name and known.is_latched >= is_latched:
                return
            self._unsubscribe(topic)
        self._ask_definition(publishers)
        domain = self._owner.ends.address.domain
        key = names.key_of(domain, topic, type_name)
        made = self._there[topic] = _ZenohSubscription(
            key, type_name, is_latched, ticks=0 if is_latched else None
        )
        endpoint = RosEndpoint(
            Kind.SUBSCRIBER,
            names.NODE,
            topic,
            type_name,
            publishers[0].type_hash,
            offered,
        )
        subscriber = self._session.subscribe(
            key,
            is_latched,
            partial(self._take, topic, made),
            lambda size: self._owner.leave_out(topic.encode(), size, True),
        )
        # Some programs publish only when somebody has subscribed.
        made.declared = subscriber, self._session.declare(domain, endpoint)

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
            for declared in subscription.declared:
                declared.undeclare()

    def _take(
        self,
        topic: str,
        subscription: _ZenohSubscription,
        key: str,
        payload: bytes,
        attached: bytes,
    ) -> None:
        """Take a message."""
        if self._there.get(topic) is not subscription:
            return
        subscription.ticks = None
        type_hash = key.rpartition("/")[2]
        channel = subscription.channels.get(type_hash)
        if channel is None and len(subscription.channels) >= limits.CHANNELS.value:
            self._owner.unreadable += 1
            return
        if channel is None:
            channel = subscription.channels[type_hash] = self._channel(
                topic, subscription, type_hash
            )
        stamp = names.stamp_of(attached)
        if stamp is not None and not subscription.is_latched:
            self._owner.ends.clock.note_message(stamp)
        now = self._owner.ends.clock.now_ns()
        self._owner.ends.put(Recorded(topic, channel, now, stamp, payload))

    def _channel(
        self, topic: str, subscription: _ZenohSubscription, type_hash: str
    ) -> TopicChannel:
        return TopicChannel(
            topic,
            self._types.schema(subscription.type_name, type_hash),
            "cdr",
            qos=self._graph.offered(topic),
            is_latched=is_latched_name(topic),
        )
