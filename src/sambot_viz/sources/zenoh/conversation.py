"""The protocol with the nodes of a robot over one session of zenoh.

Tokens announce nodes and their topics, and which definition of a type each node has.
"""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.sources.live.conversation import Ends
from sambot_viz.sources.live.graph_conversation import GraphConversation
from sambot_viz.sources.live.outgoing_topic import OutgoingTopic
from sambot_viz.sources.live.service_calls import LONGEST_ANSWER
from sambot_viz.sources.ros_endpoint import Kind, RosEndpoint
from sambot_viz.sources.ros_graph import NODE
from sambot_viz.sources.zenoh import names
from sambot_viz.sources.zenoh.session import (
    ZenohDeclaration,
    ZenohPublisher,
    ZenohSession,
)
from sambot_viz.sources.zenoh.subscriptions import ZenohSubscriptions
from sambot_viz.text import text


@dataclass(frozen=True, slots=True)
class _Publisher:
    """Publishes a topic, and says that this node does."""

    publisher: ZenohPublisher
    token: ZenohDeclaration

    def put(self, message: bytes) -> None:
        self.publisher.put(message)

    def close(self) -> None:
        self.token.undeclare()
        self.publisher.undeclare()


class ZenohConversation(GraphConversation):
    """One session of zenoh, as long as its router is there.

    Args:
        session: that is connected.
        ends: of the source.
    """

    protocol = "zenoh"
    matches_qos = False

    def __init__(self, session: ZenohSession, ends: Ends) -> None:
        super().__init__(ends)
        self.session_id = session.router
        self._session = session
        self._tokens: set[str] = set()
        self._is_told = False
        self._elsewhere: dict[int, set[str]] = {}
        # Tokens that are gone: all are, just before a lost connection is noticed.
        self._gone: set[str] = set()
        self._kept = ZenohSubscriptions(self, session, self._graph, self._types)
        self._subscriptions = self._kept

    def begin(self) -> None:
        """Say which node this is, and ask for all others."""
        # It is there as long as it is held.
        self._node = self._session.declare_token(
            names.node_token(self._domain, self._session.name, NODE)
        )
        self._session.watch(names.TOKENS, self._token, self._all_told)
        self.is_ready = True

    @property
    def is_closed(self) -> bool:
        """Whether the session has ended: nothing more can be asked of it."""
        return self._session.is_closed

    def tick(self, now: float) -> None:
        """Remove what is gone, and request the kept messages of older publishers."""
        for key in self._gone:
            self._remove(key)
        self._gone.clear()
        self._kept.tick()
        super().tick(now)

    def _nothing(self) -> str:
        """Return why no node is there, with what shows some; "" when some is."""
        if self._tokens:
            return ""
        if not self._is_told:
            return (
                "its router has not told yet which nodes there are: with thousands of "
                "topics that takes a minute"
            )
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

    def _all_told(self) -> None:
        self._is_told = True

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

    def _publisher(self, outgoing: OutgoingTopic, type_hash: str) -> _Publisher:
        topic, type_name = outgoing.topic, outgoing.type_name
        endpoint = RosEndpoint(Kind.PUBLISHER, NODE, topic, type_name, type_hash)
        key = names.key_of(self._domain, topic, type_name, type_hash)
        return _Publisher(
            self._session.publisher(key), self._session.declare(self._domain, endpoint)
        )

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
