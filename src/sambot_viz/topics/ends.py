"""Which nodes publish and subscribe to a topic, how, and which of them get nothing.

It is what ``ros2 topic info -v`` lists, with what follows from it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.ros_endpoint import RosEndpoint, TopicEndpoints
from sambot_viz.sources.ros_graph import NO_HASH, UNNAMED
from sambot_viz.text import text
from sambot_viz.topics.reasons import qos_words, weaker_policy

MOST_ENDS = 50
"""Maximum number of listed publishers of a topic, and of its subscribers."""
_WIDEST = 80


@dataclass(frozen=True, slots=True)
class TopicEnd:
    """A publisher or a subscriber of a topic.

    Attributes:
        node: the full name of its node, or a placeholder.
        publishes: whether it is a publisher.
        qos: the QoS that it offers or requests, in RViz's words; "" if unknown.
        trouble: why it gets nothing from a publisher, with the remedy; "" if it does.
    """

    node: str
    publishes: bool
    qos: str = ""
    trouble: str = ""

    def __str__(self) -> str:
        node = text(self.node, _WIDEST)
        told = f"{node} ({self.qos})" if self.qos else node
        return f"{told}: {self.trouble}" if self.trouble else told


def ends_of(topic: SourceTopic) -> Iterator[TopicEnd]:
    """Yield the publishers of a topic, then its subscribers, as far as known."""
    ends = topic.endpoints
    if ends is None:
        publishers = topic.publishers if isinstance(topic.publishers, tuple) else ()
        for node in publishers[:MOST_ENDS]:
            yield TopicEnd(node, publishes=True)
        for node in (topic.subscribers or ())[:MOST_ENDS]:
            yield TopicEnd(node, publishes=False)
        return
    for one in ends.publishers[:MOST_ENDS]:
        yield TopicEnd(one.node or UNNAMED, True, _words(one))
    for one in ends.subscribers[:MOST_ENDS]:
        yield TopicEnd(one.node or UNNAMED, False, _words(one), _trouble(one, ends))


def _words(endpoint: RosEndpoint) -> str:
    return qos_words(endpoint.qos) if endpoint.qos is not None else ""


def _trouble(subscriber: RosEndpoint, ends: TopicEndpoints) -> str:
    """Return why a subscriber gets nothing from one of the publishers."""
    for publisher in ends.publishers[:MOST_ENDS]:
        if found := _between(publisher, subscriber, ends.matches_qos):
            return found
    return ""


def _between(publisher: RosEndpoint, subscriber: RosEndpoint, matches_qos: bool) -> str:
    name = text(publisher.node or UNNAMED, _WIDEST)
    type_name = text(subscriber.type_name, _WIDEST)
    if publisher.type_name != subscriber.type_name:
        other = text(publisher.type_name, _WIDEST)
        return (
            f"gets nothing from {name}, which publishes {other}, and it wants "
            f"{type_name}: remap one of the two"
        )
    hashes = {publisher.type_hash, subscriber.type_hash} - {"", NO_HASH}
    if len(hashes) > 1:
        return (
            f"cannot read {name}, which has another definition of {type_name}: build "
            f"both with the same version of {type_name.partition('/')[0]}"
        )
    if not matches_qos or publisher.qos is None or subscriber.qos is None:
        return ""
    found = weaker_policy(publisher.qos, subscriber.qos)
    if found is None:
        return ""
    policy, weak, strong = found
    return (
        f"gets nothing from {name}, which offers {weak}, and it wants {strong}: change "
        f"the {policy.lower()} of one of the two"
    )
