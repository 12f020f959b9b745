"""Peers of live sources: robots in this process, on free ports of the loopback.

Each has topics that appear and vanish, keeps the messages of latched ones as ROS does,
knows what it was asked for, and can be stopped and started again at the same port.
"""

from __future__ import annotations

import random
import socket
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import foxglove
from foxglove.websocket import (
    Capability,
    ChannelView,
    Client,
    ClientChannel,
    ConnectionGraph,
    ServerListener,
    Service,
    ServiceRequest,
    ServiceSchema,
    StatusLevel,
)
from patience import until

from sambot_viz.sources.message import Recorded
from sambot_viz.sources.source import Source

WAIT = 40.0
"""How long tests of sources wait for a condition [s]."""
STRING = "std_msgs/msg/String"


def cdr_string(data: str) -> bytes:
    """A std_msgs/msg/String as CDR."""
    words = data.encode() + b"\0"
    return b"\0\1\0\0" + len(words).to_bytes(4, "little") + words


def cdr_word(content: bytes | memoryview) -> str:
    """The string of a std_msgs/msg/String; what comes behind it fills up."""
    length = int.from_bytes(content[4:8], "little")
    return bytes(content[8 : 7 + length]).decode()


def free_port() -> int:
    """A port of the loopback at which nothing listens now.

    Not of those that the system gives to clients: one that tries to connect while the
    peer is stopped could be given the peer's own port, and hold it.
    """
    while True:
        port = random.randrange(20_000, 30_000)
        with socket.socket() as one, suppress(OSError):
            one.bind(("127.0.0.1", port))
            return port


class Inbox:
    """A callback that keeps the strings that come, by topic and in all."""

    def __init__(self) -> None:
        self.messages: list[Recorded] = []

    def __call__(self, message: Recorded) -> None:
        self.messages.append(message)

    def strings(self) -> list[str]:
        return [cdr_word(one.payload) for one in list(self.messages)]

    def wait_for(self, *strings: str) -> None:
        """Wait until exactly these have come, in this order."""
        until(
            lambda: self.strings() == list(strings),
            WAIT,
            not_yet=(),
            why=f"never {strings}",
        )


@dataclass(frozen=True)
class Came:
    """A message that a client has published: CDR, or what JSON says."""

    topic: str
    type_name: str
    content: Any


class LivePeer(ABC):
    """A robot with one transport.

    Attributes:
        requests: what services were called with, CDR or the fields.
        absent: what is said where it is not there.
        remedy: what is said with that.
    """

    absent, remedy = "Nothing listens at 127.0.0.1:", "`ros2 "
    uri: str
    requests: list[Any]

    @abstractmethod
    def start(self) -> None:
        """Listen, at the same port as before."""

    @abstractmethod
    def stop(self) -> None:
        """Break all connections, and listen no longer; may be called twice."""

    @abstractmethod
    def advertise(self, topic: str, latched: bool = False) -> None:
        """Begin to publish strings."""

    @abstractmethod
    def publish(self, topic: str, data: str) -> None:
        """Publish a string."""

    @abstractmethod
    def remove(self, topic: str) -> None:
        """Publish a topic no longer."""

    @abstractmethod
    def subscribed(self) -> list[str]:
        """Topics that clients have subscribed to, sorted; one for each subscription."""

    @abstractmethod
    def advertised(self) -> list[tuple[str, str]]:
        """Topics that clients publish now, and their types."""

    @abstractmethod
    def came(self) -> list[Came]:
        """What clients have published."""

    @abstractmethod
    def listen_as(self, topic: str, *nodes: str) -> None:
        """Let nodes have subscribed to a topic."""

    @abstractmethod
    def complain(self, words: str) -> None:
        """Tell all clients of an error."""

    @abstractmethod
    def serve(self, service: str, failure: str = "", reply: bytes | Any = None) -> None:
        """Offer a service, or let it do otherwise.

        Args:
            service: its name.
            failure: what it fails with; "" for success.
            reply: what it answers, CDR or the fields; None for what it was asked.
        """

    @abstractmethod
    def calls(self) -> list[str]:
        """The services that were called, in their order."""


class FoxglovePeer(LivePeer, ServerListener):
    """The server of Foxglove's SDK, which keeps latched messages as the bridge does.

    Attributes:
        listeners: a topic and the nodes that have subscribed to it.
        before_answer: is called with the service before it answers, in its thread.
    """

    def __init__(self, **options: Any) -> None:
        self._port = free_port()
        self.uri = f"foxglove://127.0.0.1:{self._port}"
        self.options: dict[str, Any] = {"session_id": "first", **options}
        self.context = foxglove.Context()
        self.server: foxglove.WebSocketServer | None = None
        self._channels: dict[str, foxglove.Channel] = {}
        self._latched: dict[str, list[bytes]] = {}
        self._subscribed: list[tuple[int, str]] = []
        self._advertised: dict[tuple[int, int], tuple[str, str]] = {}
        self._came: list[Came] = []
        self._services: dict[str, tuple[str, bytes | None]] = {}
        self._calls: list[str] = []
        self.requests = []
        self.before_answer: Callable[[str], object] = lambda service: None
        self._lock = threading.Lock()
        self.listeners: tuple[str, list[str]] | None = None
        self._publishers: dict[str, list[str]] = {}
        self.start()

    def start(self) -> None:
        options: dict[str, Any] = {
            "name": "robot",
            "capabilities": [
                Capability.Time,
                Capability.ConnectionGraph,
                Capability.ClientPublish,
                Capability.Services,
            ],
            "supported_encodings": ["cdr", "json"],
            # Else the oldest of what is published at once goes missing.
            "message_backlog_size": 100_000,
            **self.options,
        }
        self.server = until(
            lambda: foxglove.start_server(
                host="127.0.0.1",
                port=self._port,
                context=self.context,
                server_listener=self,
                **options,
            ),
            WAIT,
            # Another peer of these tests may have the port for as long as it was free.
            not_yet=RuntimeError,
        )
        if self._services:
            self.server.add_services([*map(self._service, self._services)])

    def stop(self) -> None:
        if self.server is not None:
            self.server.stop()
            self.server = None
            self._subscribed.clear()
            self._advertised.clear()

    def advertise(
        self,
        topic: str,
        latched: bool = False,
        schema: str = STRING,
        qos: str | None = None,
    ) -> None:
        if latched:
            self._latched[topic] = []
        self._channels[topic] = foxglove.Channel(
            topic,
            schema=foxglove.Schema(
                name=schema, encoding="ros2msg", data=b"string data\n"
            ),
            message_encoding="cdr",
            metadata=None if qos is None else {"offered_qos_profiles": qos},
            context=self.context,
        )

    def publish(self, topic: str, data: str) -> None:
        payload = cdr_string(data)
        if topic in self._latched:
            self._latched[topic].append(payload)
        self._channels[topic].log(payload)

    def log(self, topic: str, payload: bytes) -> None:
        """Publish bytes."""
        self._channels[topic].log(payload)

    def remove(self, topic: str) -> None:
        self._latched.pop(topic, None)
        self._channels.pop(topic).close()

    def subscribed(self) -> list[str]:
        return sorted(topic for _, topic in self._subscribed)

    def advertised(self) -> list[tuple[str, str]]:
        return list(self._advertised.values())

    def came(self) -> list[Came]:
        return list(self._came)

    def listen_as(self, topic: str, *nodes: str) -> None:
        self.listeners = topic, list(nodes)
        self._tell_graph()

    def published_by(self, topic: str, *nodes: str) -> None:
        """Let nodes publish a topic."""
        self._publishers[topic] = list(nodes)
        self._tell_graph()

    def _tell_graph(self) -> None:
        graph = ConnectionGraph()
        if self.listeners is not None:
            graph.set_subscribed_topic(*self.listeners)
        for topic, nodes in self._publishers.items():
            graph.set_published_topic(topic, nodes)
        assert self.server is not None
        self.server.publish_connection_graph(graph)

    def serve(self, service: str, failure: str = "", reply: bytes | Any = None) -> None:
        is_new = service not in self._services
        self._services[service] = failure, reply
        if is_new and self.server is not None:
            self.server.add_services([self._service(service)])

    def calls(self) -> list[str]:
        return list(self._calls)

    def served(self) -> list[tuple[str, bytes]]:
        """The services that were called and what with, in their order."""
        with self._lock:
            return list(zip(self._calls, self.requests, strict=True))

    def _service(self, name: str) -> Service:
        def answer(request: ServiceRequest) -> bytes:
            with self._lock:
                self._calls.append(name)
                self.requests.append(bytes(request.payload))
            self.before_answer(name)
            failure, reply = self._services[name]
            if failure:
                raise RuntimeError(failure)
            return bytes(request.payload) if reply is None else reply

        return Service(name, schema=ServiceSchema("test/srv/Any"), handler=answer)

    def complain(self, words: str) -> None:
        assert self.server is not None
        self.server.publish_status(words, StatusLevel.Error)

    def on_client_advertise(self, client: Client, channel: ClientChannel) -> None:
        named = channel.topic, channel.schema_name
        self._advertised[client.id, channel.id] = named

    def on_client_unadvertise(self, client: Client, client_channel_id: int) -> None:
        self._advertised.pop((client.id, client_channel_id), None)

    def on_message_data(
        self, client: Client, client_channel_id: int, data: bytes
    ) -> None:
        self._came.append(Came(*self._advertised[client.id, client_channel_id], data))

    def on_subscribe(self, client: Client, channel: ChannelView) -> None:
        self._subscribed.append((client.id, channel.topic))
        for payload in self._latched.get(channel.topic, ()):
            self._channels[channel.topic].log(payload)

    def on_unsubscribe(self, client: Client, channel: ChannelView) -> None:
        if (client.id, channel.topic) in self._subscribed:
            self._subscribed.remove((client.id, channel.topic))


def knows_takers(source: Source, peer: FoxglovePeer, prefix: str = "") -> None:
    """Wait until a source has heard who takes a peer's topic: after its topics.

    Args:
        source: is connected.
        peer: the robot, which `listen_as` was called for, or which has no listener.
        prefix: of its names at the source.
    """
    if peer.listeners is None:
        return
    topic, names = peer.listeners
    outgoing = source.advertise(f"/{prefix}{topic}" if prefix else topic, STRING)
    eventually(lambda: outgoing.receivers.names == tuple(names))
    outgoing.close()
    eventually(lambda: (topic, STRING) not in peer.advertised())


def eventually(condition: Callable[[], Any]) -> None:
    """Wait until a live source has done what a condition asks for."""
    until(condition, WAIT, not_yet=(Exception,), why="it never came")
