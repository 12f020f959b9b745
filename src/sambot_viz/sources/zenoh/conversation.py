"""What is said with the nodes of a robot over one session of zenoh.

Tokens say what there is, and which definition of a type each node has.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.messages import standard_hash
from sambot_viz.sources.action_names import send_service, status_topic
from sambot_viz.sources.hidden_action import HiddenAction
from sambot_viz.sources.live.conversation import Conversation, Ends
from sambot_viz.sources.live.outgoing_topic import OutgoingTopic
from sambot_viz.sources.live.service_calls import LONGEST_ANSWER, ServiceCalls
from sambot_viz.sources.message import (
    SourceTopic,
    is_latched_name,
)
from sambot_viz.sources.ros_graph import NO_HASH, Kind, RosEndpoint, RosGraph
from sambot_viz.sources.source import (
    Capability,
    Encoding,
    OutgoingAction,
    Source,
)
from sambot_viz.sources.type_descriptions import TypeDescriptions
from sambot_viz.sources.zenoh import names
from sambot_viz.sources.zenoh.session import (
    ZenohDeclaration,
    ZenohPublisher,
    ZenohSession,
)
from sambot_viz.sources.zenoh.subscriptions import ZenohSubscriptions
from sambot_viz.text import text

_TICKS_FOR_NODES = 4


@dataclass(frozen=True, slots=True)
class _Published:
    """A topic that is published: what says so, and what sends."""

    outgoing: OutgoingTopic
    type_hash: str
    publisher: ZenohPublisher
    token: ZenohDeclaration


class ZenohConversation(Conversation):
    """One session of zenoh, as long as its router is there.

    Args:
        session: that is connected.
        ends: of the source.
    """

    publishes: Encoding = "cdr"

    def __init__(self, session: ZenohSession, ends: Ends) -> None:
        super().__init__(ends)
        self.calls = ServiceCalls(self._call, self.publishes)
        self.session_id = session.router
        self._types = TypeDescriptions(self.calls)
        self._session = session
        self._domain = ends.address.domain
        self._graph = RosGraph()
        self._tokens: set[str] = set()
        self._elsewhere: dict[int, set[str]] = {}
        # Tokens that are gone: all are, just before a lost connection is noticed.
        self._gone: set[str] = set()
        self._subscriptions = ZenohSubscriptions(
            self, session, self._graph, self._types
        )
        self._ids = count(1)
        self._published: dict[int, _Published] = {}
        self._ticks = 0

    def begin(self) -> None:
        """Say which node this is, and ask for all others."""
        # It is there as long as it is held.
        self._node = self._session.declare_token(
            names.node_token(self._domain, self._session.name, names.NODE)
        )
        self._session.watch(names.TOKENS, self._token)
        self.is_ready = True

    def receive(self, frame: str | bytes) -> None:
        """Take nothing: zenoh has no frames."""
        raise NotImplementedError

    def topic_of(self, head: bytes) -> str:
        """Return the topic of a message that was too large: what is given of it."""
        return head.decode()

    @property
    def offers(self) -> frozenset[Capability]:
        """What there is with each router: publish and graph."""
        return frozenset[Capability](("publish", "graph"))

    @property
    def unpublishable(self) -> str:
        """Nothing: each router takes messages."""
        return ""

    def advertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the nodes of a topic that is published."""
        if self._session.is_closed:
            return
        outgoing.number = next(self._ids)
        outgoing.receivers = self._graph.receivers(outgoing.topic)
        self._begin(outgoing)

    def publish(self, outgoing: OutgoingTopic, message: bytes) -> None:
        """Send a message."""
        published = self._published.get(outgoing.number)
        if published is not None and not self._session.is_closed:
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
        # Topics are told once more when the session has been closed already.
        if not self._session.is_closed:
            self._subscriptions.update(wanted)
        self.ends.assets.refuse_all(
            "zenoh hands out no files",
            "give the folder of the package with --package-path",
        )

    def tick(self, now: float) -> None:
        """Take away what is gone, and ask older publishers for what they keep."""
        self._ticks += 1
        self.calls.tick(now)
        for key in self._gone:
            self._remove(key)
        self._gone.clear()
        self._subscriptions.tick()

    def silence(self) -> str:
        """Return nothing: a session is ready when there is one."""
        return ""

    def notes(self) -> list[str]:
        """Return why nothing is there, and what is left out."""
        notes: list[str] = []
        if self._graph.is_full:
            notes.append(
                f"only the first {limits.TOPICS.value} of its topics are listed"
            )
        if self._tokens or self._ticks < _TICKS_FOR_NODES:
            return notes
        return [*notes, self._nothing()]

    def topics(self) -> dict[str, SourceTopic]:
        """Return the topics that nodes publish."""
        found: dict[str, SourceTopic] = {}
        for name in self._graph.published():
            publishers = self._graph.of(Kind.PUBLISHER, name)
            first = publishers[0]
            found[name] = SourceTopic(
                name,
                self._types.schema(first.type_name, first.type_hash),
                "cdr",
                qos=self._graph.offered(name),
                is_latched=is_latched_name(name),
                publishers=tuple(one.node for one in publishers),
                left_out=self.left_out(name),
            )
        return found

    def _nothing(self) -> str:
        """Return why no node is there, with what shows some."""
        for domain, there in self._elsewhere.items():
            if there:
                address = self.ends.address.with_protocol("zenoh")
                return (
                    f"no node has the domain id {self._domain}, others have {domain}: "
                    f"--source '{address}?domain={domain}'"
                )
        return (
            "no node is connected to this router: start them with "
            "RMW_IMPLEMENTATION=rmw_zenoh_cpp (`ros2 doctor --report` says which they "
            "have), and on another machine with ZENOH_CONFIG_OVERRIDE="
            f"'connect/endpoints=[\"tcp/{self.ends.address.label}\"]'"
        )

    def _token(self, key: str, is_there: bool) -> None:
        """Take a token that is there, or is gone."""
        if not is_there:
            self._gone.add(key)
            return
        self._gone.discard(key)
        token = names.parse_token(key)
        if token is None or token.session == self._session.name:
            return
        tokens = self._tokens
        if token.domain != self._domain:
            tokens = self._elsewhere.setdefault(token.domain, set())
        if len(tokens) >= limits.ENDPOINTS.value:
            return
        tokens.add(key)
        if token.domain == self._domain and token.endpoint is not None:
            self._graph.add(key, token.endpoint)
            self._note(token.endpoint)

    def _remove(self, key: str) -> None:
        token = names.parse_token(key)
        if token is None:
            return
        if token.domain != self._domain:
            self._elsewhere.get(token.domain, set[str]()).discard(key)
            return
        self._tokens.discard(key)
        self._graph.discard(key)
        if token.endpoint is not None:
            self._note(token.endpoint)

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
        if endpoint.kind is Kind.PUBLISHER:
            # `update` follows when somebody has been told of them.
            self.topics_changed = True
        elif endpoint.kind is Kind.SERVICE:
            self._subscriptions.follow(endpoint)

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
        endpoint = RosEndpoint(
            Kind.PUBLISHER, names.NODE, outgoing.topic, type_name, type_hash
        )
        key = names.key_of(self._domain, outgoing.topic, type_name, type_hash)
        self._published[outgoing.number] = _Published(
            outgoing,
            type_hash,
            self._session.publisher(key),
            self._session.declare(self._domain, endpoint),
        )

    def _withdraw(self, number: int) -> None:
        if (published := self._published.pop(number, None)) is not None:
            published.token.undeclare()
            published.publisher.undeclare()

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

    def _call(self, number: int, service: str, request: bytes) -> None:
        if self._session.is_closed:
            raise SourceError("the connection was lost")
        found = self._service(service)

        def answered(content: bytes, why: str) -> None:
            if why:
                self.calls.fail(number, text(why, 400))
            else:
                self.calls.take(number, content)

        key = names.key_of(self._domain, service, found.type_name, found.type_hash)
        self._session.call(key, number, request, LONGEST_ANSWER + 1.0, answered)
