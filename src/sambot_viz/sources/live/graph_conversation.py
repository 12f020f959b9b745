"""The protocol with nodes that each announce their own topics.

Zenoh and DDS differ only in the form of the announcements and in the transport.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from itertools import count
from typing import Protocol

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.messages import standard_hash
from sambot_viz.sources.action_names import send_service, status_topic
from sambot_viz.sources.live.conversation import Conversation, Ends
from sambot_viz.sources.live.graph_subscriptions import GraphSubscriptions
from sambot_viz.sources.live.hidden_action import HiddenAction
from sambot_viz.sources.live.outgoing_topic import OutgoingTopic
from sambot_viz.sources.live.service_calls import ServiceCalls
from sambot_viz.sources.live.type_descriptions import TypeDescriptions
from sambot_viz.sources.message import SourceTopic, is_latched_name
from sambot_viz.sources.ros_endpoint import Kind, RosEndpoint, nodes_of
from sambot_viz.sources.ros_graph import NO_HASH, RosGraph
from sambot_viz.sources.source import Capability, Encoding, OutgoingAction, Source
from sambot_viz.text import text

_TICKS_FOR_NODES = 4


class GraphPublisher(Protocol):
    """What publishes a topic."""

    def put(self, message: bytes) -> None:
        """Publish a message."""
        ...

    def close(self) -> None:
        """Publish nothing more."""
        ...


@dataclass(frozen=True, slots=True)
class _Published:
    """A topic that is published, with the hash of its definition."""

    outgoing: OutgoingTopic
    type_hash: str
    publisher: GraphPublisher


class GraphConversation(Conversation):
    """One connection to the nodes of a robot.

    Args:
        ends: of the source.
    """

    publishes: Encoding = "cdr"
    protocol: str
    """What hands out no files."""
    matches_qos: bool
    """As `TopicEndpoints.matches_qos`."""

    def __init__(self, ends: Ends) -> None:
        super().__init__(ends)
        self.calls = ServiceCalls(self._call, self.publishes)
        self._types = TypeDescriptions(self.calls)
        self._domain = ends.address.domain
        self._graph = RosGraph(self.matches_qos)
        self._ids = count(1)
        self._published: dict[int, _Published] = {}
        self._ticks = 0

    _subscriptions: GraphSubscriptions

    @property
    @abstractmethod
    def is_closed(self) -> bool:
        """Whether the connection has ended: nothing more can be asked of it."""

    @abstractmethod
    def _publisher(self, outgoing: OutgoingTopic, type_hash: str) -> GraphPublisher:
        """Begin to publish a topic with a definition."""

    @abstractmethod
    def _call(self, number: int, service: str, request: bytes) -> None:
        """Send the call of a service."""

    @abstractmethod
    def _nothing(self) -> str:
        """Return why no node is there, with what shows some; "" when some is."""

    def receive(self, frame: str | bytes) -> None:
        """Take nothing: it has no frames."""
        raise NotImplementedError

    def topic_of(self, head: bytes) -> str:
        """Return the topic of a message that was too large: `head` is its name."""
        return head.decode()

    @property
    def offers(self) -> frozenset[Capability]:
        """What there is with all nodes: publish and graph."""
        return frozenset[Capability](("publish", "graph"))

    @property
    def unpublishable(self) -> str:
        """Nothing: the nodes take messages."""
        return ""

    def advertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the nodes of a topic that is published."""
        if self.is_closed:
            return
        outgoing.number = next(self._ids)
        outgoing.receivers = self._graph.receivers(outgoing.topic)
        self._begin(outgoing)

    def publish(self, outgoing: OutgoingTopic, message: bytes) -> None:
        """Send a message."""
        published = self._published.get(outgoing.number)
        if published is not None and not self.is_closed:
            published.publisher.put(message)

    def unadvertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the nodes that a topic is published no longer."""
        self._withdraw(outgoing.number)

    def action(self, name: str, type_name: str, source: Source) -> OutgoingAction:
        """Return an action, by its hidden services and topics."""
        self._service(send_service(name))
        if status_topic(name) not in source.topics():
            raise SourceError(f"the robot has no action {text(name, 80)}")
        return HiddenAction(name, type_name, source, self.goals)

    def update(self, wanted: frozenset[str]) -> None:
        """Subscribe to the wanted topics that exist, and to no others."""
        # Topics are told once more when the connection has ended already.
        if not self.is_closed:
            self._subscriptions.update(wanted)
        self.ends.assets.refuse_all(
            f"{self.protocol} hands out no files",
            "give the folder of the package with --package-path",
        )

    def tick(self, now: float) -> None:
        """Give up calls that are not answered."""
        self._ticks += 1
        self.calls.tick(now)

    def silence(self) -> str:
        """Return nothing: it is ready when there is a connection."""
        return ""

    def notes(self) -> list[str]:
        """Return notes on missing nodes, left out topics, and wrong clocks."""
        notes: list[str] = []
        if self._graph.is_full:
            notes.append(
                f"only the first {limits.TOPICS.value} of its topics are listed"
            )
        # Nodes stamp what they publish by the clock of their computer, also simulated.
        if (apart := self.ends.clock.apart_s) is not None:
            way, hours = "ahead of" if apart > 0 else "behind", abs(apart) / 3600
            notes.append(
                f"the robot's clock is {hours:,.1f} h {way} this computer's: "
                "`timedatectl` on both says which one is wrong, and "
                "`sudo timedatectl set-ntp true` there sets it"
            )
        if self._ticks >= _TICKS_FOR_NODES and (nothing := self._nothing()):
            notes.append(nothing)
        return notes

    def topics(self) -> dict[str, SourceTopic]:
        """Return the topics that nodes publish, or wait for."""
        found: dict[str, SourceTopic] = {}
        has_nodes = self._graph.has_nodes
        for name in self._graph.topics():
            ends = self._graph.endpoints(name)
            first = (*ends.publishers, *ends.subscribers)[0]
            found[name] = SourceTopic(
                name,
                self._types.schema(first.type_name, first.type_hash),
                "cdr",
                qos=self._graph.offered(name),
                is_latched=is_latched_name(name),
                publishers=nodes_of(ends.publishers) or len(ends.publishers),
                subscribers=nodes_of(ends.subscribers) if has_nodes else None,
                endpoints=ends,
                left_out=self.left_out(name),
            )
        return found

    def _note(self, endpoint: RosEndpoint) -> None:
        """Take note that an endpoint has come or gone."""
        for number, published in tuple(self._published.items()):
            outgoing = published.outgoing
            if outgoing.topic != endpoint.name:
                continue
            outgoing.receivers = self._graph.receivers(outgoing.topic)
            if published.type_hash != self._hash_for(outgoing):
                self._withdraw(number)
                self._begin(outgoing)
            else:
                outgoing.refused = self._unheard(outgoing)
        if endpoint.kind is Kind.SERVICE:
            self._subscriptions.follow(endpoint)
        else:
            # `update` follows when listeners know of them.
            self.topics_changed = True

    def _begin(self, outgoing: OutgoingTopic) -> None:
        """Publish a topic with the definition that its receivers have."""
        type_name, type_hash = outgoing.type_name, self._hash_for(outgoing)
        if not type_hash:
            outgoing.refused = (
                f"the robot has another definition of {type_name}"
                if standard_hash(type_name)
                else f"the definition of {type_name} is not known"
            )
            return
        self._published[outgoing.number] = _Published(
            outgoing, type_hash, self._publisher(outgoing, type_hash)
        )
        outgoing.refused = self._unheard(outgoing)

    def _unheard(self, outgoing: OutgoingTopic) -> str:
        """Return why those who have subscribed get nothing; "" when they do."""
        del outgoing
        return ""

    def _withdraw(self, number: int) -> None:
        if (published := self._published.pop(number, None)) is not None:
            published.publisher.close()

    def _hash_for(self, outgoing: OutgoingTopic) -> str:
        """Return which definition is published; "" where receivers have another."""
        topic, type_name = outgoing.topic, outgoing.type_name
        there = (
            *self._graph.of(Kind.SUBSCRIBER, topic),
            *self._graph.of(Kind.PUBLISHER, topic),
        )
        hashes = [one.type_hash for one in there if one.type_name == type_name]
        known = standard_hash(type_name)
        if not hashes or known in hashes:
            return known
        # What ROS does not have was written as --msg-path says it.
        return NO_HASH if NO_HASH in hashes else "" if known else hashes[0]

    def _service(self, service: str) -> RosEndpoint:
        found = self._graph.of(Kind.SERVICE, service)
        if not found:
            raise SourceError(f"the robot has no service {text(service, 120)}")
        return found[0]
