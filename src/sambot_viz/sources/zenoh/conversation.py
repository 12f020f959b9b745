"""What is said with the nodes of a robot over one session of zenoh.

Tokens say what there is. A topic is subscribed to with its type and any definition of
it; the key of a message says which, so that two nodes may differ.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import count

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.messages import standard_hash
from sambot_viz.sources.action_names import send_service, status_topic
from sambot_viz.sources.hidden_action import HiddenAction
from sambot_viz.sources.message import (
    Recorded,
    SourceTopic,
    TopicChannel,
    is_latched_name,
)
from sambot_viz.sources.ros_graph import Endpoint, Kind, RosGraph
from sambot_viz.sources.source import (
    Capability,
    Encoding,
    OutgoingAction,
    Source,
)
from sambot_viz.sources.type_descriptions import TypeDescriptions, service_of
from sambot_viz.sources.websocket.conversation import Conversation, Ends
from sambot_viz.sources.websocket.outgoing_topic import OutgoingTopic
from sambot_viz.sources.websocket.service_calls import LONGEST_ANSWER, ServiceCalls
from sambot_viz.sources.zenoh import names
from sambot_viz.sources.zenoh.session import (
    ZenohDeclaration,
    ZenohPublisher,
    ZenohSession,
)
from sambot_viz.text import text

NODE = "/sambot_viz"
"""What this program is called among the nodes."""
_TICKS_FOR_CACHES = 2
"""What is kept has come by then, or its publisher has a cache of the older kind."""
_TICKS_FOR_NODES = 4


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


@dataclass(frozen=True, slots=True)
class _Published:
    """A topic that is published: what says so, and what sends."""

    outgoing: OutgoingTopic
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
        self._ids = count(1)
        self._wanted: frozenset[str] = frozenset()
        self._subscriptions: dict[str, _ZenohSubscription] = {}
        self._published: dict[int, _Published] = {}
        self._ticks = 0

    def begin(self) -> None:
        """Say which node this is, and ask for all others."""
        # It is there as long as it is held.
        self._node = self._session.declare_token(
            names.node_token(self._domain, self._session.name, NODE)
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
        type_hash = self._hash_for(outgoing)
        outgoing.receivers = self._graph.receivers(outgoing.topic)
        if not type_hash:
            outgoing.refused = f"the definition of {outgoing.type_name} is not known"
            return
        outgoing.number = next(self._ids)
        endpoint = Endpoint(
            Kind.PUBLISHER, NODE, outgoing.topic, outgoing.type_name, type_hash
        )
        key = names.key_of(self._domain, outgoing.topic, outgoing.type_name, type_hash)
        self._published[outgoing.number] = _Published(
            outgoing, self._session.publisher(key), self._declare(endpoint)
        )

    def publish(self, outgoing: OutgoingTopic, message: bytes) -> None:
        """Send a message."""
        if (published := self._published.get(outgoing.number)) is not None:
            published.publisher.put(message)

    def unadvertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the nodes that a topic is published no longer."""
        if (published := self._published.pop(outgoing.number, None)) is not None:
            published.token.undeclare()
            published.publisher.undeclare()

    def action(self, name: str, type_name: str, source: Source) -> OutgoingAction:
        """Return an action, by its hidden services and topics."""
        self._service(send_service(name))
        if status_topic(name) not in source.topics():
            raise SourceError(f"the robot has no action {text(name, 80)}")
        return HiddenAction(name, type_name, source, self.goals)

    def update(self, wanted: frozenset[str]) -> None:
        """Subscribe to the wanted topics that exist, and to no others."""
        for topic in self._wanted - wanted:
            self._unsubscribe(topic)
        self._wanted = wanted
        for topic in wanted:
            self._subscribe(topic)
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
        for topic, subscription in self._subscriptions.items():
            if subscription.ticks is not None:
                subscription.ticks += 1
                if subscription.ticks > _TICKS_FOR_CACHES:
                    subscription.ticks = None
                    take = partial(self._take, topic, subscription)
                    self._session.ask_kept(subscription.key, take)

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

    def _note(self, endpoint: Endpoint) -> None:
        """Take note that an endpoint has come or gone."""
        topic = endpoint.name
        for published in self._published.values():
            if published.outgoing.topic == topic:
                published.outgoing.receivers = self._graph.receivers(topic)
        if endpoint.kind is Kind.PUBLISHER:
            self.topics_changed = True
            self._subscribe(topic)
        elif endpoint.name == service_of(endpoint.node):
            for topic in self._subscriptions:
                self._ask_definition(self._graph.of(Kind.PUBLISHER, topic))

    def _hash_for(self, outgoing: OutgoingTopic) -> str:
        """Return which definition is published: that which the nodes have."""
        topic = outgoing.topic
        there = (
            *self._graph.of(Kind.SUBSCRIBER, topic),
            *self._graph.of(Kind.PUBLISHER, topic),
        )
        hashes = [one.type_hash for one in there if one.type_name == outgoing.type_name]
        known = standard_hash(outgoing.type_name)
        return known if known in hashes or not hashes else hashes[0]

    def _subscribe(self, topic: str) -> None:
        """Subscribe to a wanted topic, and again when its publishers ask for that."""
        publishers = self._graph.of(Kind.PUBLISHER, topic)
        if topic not in self._wanted or not publishers:
            return
        type_name = publishers[0].type_name
        offered = self._graph.offered(topic)
        is_latched = offered is not None and offered.is_any_transient_local
        known = self._subscriptions.get(topic)
        if known is not None:
            if known.type_name == type_name and known.is_latched >= is_latched:
                return
            self._unsubscribe(topic)
        self._ask_definition(publishers)
        key = names.key_of(self._domain, topic, type_name)
        made = self._subscriptions[topic] = _ZenohSubscription(
            key, type_name, is_latched, ticks=0 if is_latched else None
        )
        endpoint = Endpoint(
            Kind.SUBSCRIBER,
            NODE,
            topic,
            type_name,
            publishers[0].type_hash,
            offered,
        )
        subscriber = self._session.subscribe(
            key,
            is_latched,
            partial(self._take, topic, made),
            lambda size: self.leave_out(topic.encode(), size, True),
        )
        # Some programs publish only when somebody has subscribed.
        made.declared = subscriber, self._declare(endpoint)

    def _ask_definition(self, publishers: Sequence[Endpoint]) -> None:
        """Ask the first node of a topic what its messages are, if that is not known."""
        if not publishers:
            return
        publisher = publishers[0]
        type_name, type_hash = publisher.type_name, publisher.type_hash
        is_known = self._types.schema(type_name, type_hash).text
        if is_known or not self._graph.of(Kind.SERVICE, service_of(publisher.node)):
            return

        def told() -> None:
            self.topics_changed = True
            for topic, one in tuple(self._subscriptions.items()):
                if one.type_name == type_name:
                    # What has come was not read; what is kept comes again.
                    self._unsubscribe(topic)
                    self._subscribe(topic)

        self._types.ask(publisher.node, type_name, type_hash, told)

    def _unsubscribe(self, topic: str) -> None:
        if (subscription := self._subscriptions.pop(topic, None)) is not None:
            for declared in subscription.declared:
                declared.undeclare()

    def _declare(self, endpoint: Endpoint) -> ZenohDeclaration:
        number = next(self._ids)
        return self._session.declare_token(
            names.endpoint_token(self._domain, self._session.name, number, endpoint)
        )

    def _take(
        self,
        topic: str,
        subscription: _ZenohSubscription,
        key: str,
        payload: bytes,
        attached: bytes,
    ) -> None:
        """Take a message; in a thread of zenoh, which the loop is not to hold up."""
        if self._subscriptions.get(topic) is not subscription:
            return
        subscription.ticks = None
        type_hash = key.rpartition("/")[2]
        channel = subscription.channels.get(type_hash)
        if channel is None and len(subscription.channels) >= limits.CHANNELS.value:
            self.unreadable += 1
            return
        if channel is None:
            channel = subscription.channels[type_hash] = self._channel(
                topic, subscription, type_hash
            )
        stamp = names.stamp_of(attached)
        if stamp is not None and not subscription.is_latched:
            self.ends.clock.note_message(stamp)
        now = self.ends.clock.now_ns()
        self.ends.put(Recorded(topic, channel, now, stamp, payload))

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

    def _service(self, service: str) -> Endpoint:
        found = self._graph.of(Kind.SERVICE, service)
        if not found:
            raise SourceError(f"the robot has no service {text(service, 120)}")
        return found[0]

    def _call(self, number: int, service: str, request: bytes) -> None:
        found = self._service(service)

        def answered(content: bytes, why: str) -> None:
            if why:
                self.calls.fail(number, text(why, 400))
            else:
                self.calls.take(number, content)

        key = names.key_of(self._domain, service, found.type_name, found.type_hash)
        self._session.call(key, number, request, LONGEST_ANSWER + 1.0, answered)
