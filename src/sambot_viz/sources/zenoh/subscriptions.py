"""The topics of a robot that are subscribed to over zenoh.

The key of a message says which definition of its type it has.
"""

from __future__ import annotations

from functools import partial

from sambot_viz.sources.live.conversation import Conversation
from sambot_viz.sources.live.graph_subscriptions import (
    Closing,
    GraphSubscription,
    GraphSubscriptions,
)
from sambot_viz.sources.live.type_descriptions import TypeDescriptions
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import Kind, RosEndpoint
from sambot_viz.sources.ros_graph import NODE, RosGraph
from sambot_viz.sources.zenoh import names
from sambot_viz.sources.zenoh.session import ZenohSession

_TICKS_FOR_CACHES = 2
"""Kept messages have come by then, or their publisher has a cache of the older kind."""


class ZenohSubscriptions(GraphSubscriptions):
    """Subscribes to the wanted topics that exist, and delivers their messages.

    Args:
        owner: the conversation, which counts unreadable messages.
        session: the session of zenoh.
        graph: the graph of the present nodes.
        types: definitions of messages.
    """

    def __init__(
        self,
        owner: Conversation,
        session: ZenohSession,
        graph: RosGraph,
        types: TypeDescriptions,
    ) -> None:
        super().__init__(owner, graph, types)
        self._session = session
        self._domain = owner.ends.address.domain
        # Ticks since the last kept message.
        self._silent: dict[GraphSubscription, int] = {}

    def tick(self) -> None:
        """Ask older publishers for what they keep, where nothing has come."""
        for subscription, ticks in tuple(self._silent.items()):
            self._silent[subscription] = ticks + 1
            if subscription.is_heard:
                del self._silent[subscription]
            elif ticks >= _TICKS_FOR_CACHES:
                del self._silent[subscription]
                take = partial(self._take_sample, subscription)
                self._session.ask_kept(self._key(subscription), take)

    def _key(self, subscription: GraphSubscription) -> str:
        return names.key_of(self._domain, subscription.topic, subscription.type_name)

    def _suits(self, subscription: GraphSubscription, offered: Qos) -> bool:
        was_kept = subscription.offered.is_any_transient_local
        return was_kept >= offered.is_any_transient_local

    def _open(self, subscription: GraphSubscription, publisher: RosEndpoint) -> Closing:
        topic, offered = subscription.topic, subscription.offered
        if offered.is_any_transient_local:
            self._silent[subscription] = 0
        subscriber = self._session.subscribe(
            self._key(subscription),
            offered.is_any_transient_local,
            partial(self._take_sample, subscription),
            partial(self._leave_out, topic),
        )
        endpoint = RosEndpoint(
            Kind.SUBSCRIBER,
            NODE,
            topic,
            subscription.type_name,
            publisher.type_hash,
            offered,
        )
        # Some programs publish only when there is a subscription.
        token = self._session.declare(self._domain, endpoint)

        def close() -> None:
            self._silent.pop(subscription, None)
            subscriber.undeclare()
            token.undeclare()

        return close

    def _take_sample(
        self, subscription: GraphSubscription, key: str, payload: bytes, attached: bytes
    ) -> None:
        type_hash = key.rpartition("/")[2]
        self._take(subscription, type_hash, payload, names.stamp_of(attached))
