"""The topics of a robot that are subscribed to over DDS.

A reader asks for what all publishers of the topic offer, as RViz does with adaptive
QoS: whoever offers less would not be heard.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from sambot_viz.sources.dds.participant import DdsParticipant
from sambot_viz.sources.live.conversation import Conversation
from sambot_viz.sources.live.graph_subscriptions import (
    Closing,
    GraphSubscription,
    GraphSubscriptions,
)
from sambot_viz.sources.live.type_descriptions import TypeDescriptions
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import RosEndpoint
from sambot_viz.sources.ros_graph import RosGraph, mangled


class DdsSubscriptions(GraphSubscriptions):
    """Subscribes to the wanted topics that exist, and delivers their messages.

    Args:
        owner: the conversation, which counts unreadable messages.
        participant: the participant of DDS.
        graph: the graph of the present nodes.
        types: definitions of messages.
        hashes: id of a writer → the hash of its type.
    """

    def __init__(
        self,
        owner: Conversation,
        participant: DdsParticipant,
        graph: RosGraph,
        types: TypeDescriptions,
        hashes: Mapping[int, str],
    ) -> None:
        super().__init__(owner, graph, types)
        self._participant = participant
        self._hashes = hashes

    def _suits(self, subscription: GraphSubscription, offered: Qos) -> bool:
        was = subscription.offered
        return (was.reliability, was.durability) == (
            offered.reliability,
            offered.durability,
        )

    def _open(self, subscription: GraphSubscription, publisher: RosEndpoint) -> Closing:
        topic = subscription.topic
        reader = self._participant.subscribe(
            f"rt{topic}",
            mangled(subscription.type_name),
            subscription.offered,
            partial(self._take_sample, subscription, publisher.type_hash),
            partial(self._leave_out, topic),
        )
        return reader.close

    def _take_sample(
        self,
        subscription: GraphSubscription,
        usual: str,
        content: bytes,
        handle: int,
        stamp: int,
    ) -> None:
        type_hash = self._hashes.get(handle, usual)
        self._take(subscription, type_hash, content, stamp)
