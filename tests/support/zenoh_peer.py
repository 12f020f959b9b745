"""Nodes of ROS with rmw_zenoh and their router, in this process.

As the design page of rmw_zenoh_cpp has it; what it puts on the wire is written here
again, and not with the code that is tested.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import timedelta
from functools import partial
from typing import Any

import pytest
import zenoh
import zenoh.ext
from live_peers import STRING, WAIT, Came, LivePeer, cdr_string, free_port
from patience import until
from rosbags.typesys import Stores, get_typestore
from zenoh.handlers import Callback

STAMP_NS = 1_700_000_000_000_000_005
ANY_HASH = "RIHS01_" + "5a" * 32


def attached(number: int) -> bytes:
    """What goes with each message."""
    head = b"\x0fsequence_number" + number.to_bytes(8, "little")
    stamp = b"\x10source_timestamp" + STAMP_NS.to_bytes(8, "little")
    return head + stamp + b"\x0asource_gid\x10" + bytes(16)


def on_the_wire(type_name: str) -> str:
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


@dataclass
class Publication:
    """A topic of a node.

    Attributes:
        qos: as its token has it.
        has_cache: keeps messages as publishers did before rmw_zenoh 0.2.2.
        kept: its messages, if it is latched.
    """

    type_name: str
    type_hash: str
    is_latched: bool
    node: str
    has_cache: bool = False
    kept: list[bytes] = field(default_factory=list)
    declared: list[Any] = field(default_factory=list)
    put: Callable[..., Any] = print


class ZenohPeer(LivePeer):
    """A router, with a talker in it that publishes strings.

    Args:
        domain: ROS's domain id.
        protocol: that the router speaks, tcp or tls.
        has_nodes: there is a node at all.
        settings: of the router.

    Attributes:
        hashes: which definitions of a type are listened to; empty for ROS's own.
        is_old: latched topics are kept as before rmw_zenoh 0.2.2.
        before_answer: is called with the service before it answers.
    """

    def __init__(
        self,
        domain: int = 0,
        protocol: str = "tcp",
        has_nodes: bool = True,
        **settings: Any,
    ) -> None:
        self._port = free_port()
        self.uri = f"zenoh://127.0.0.1:{self._port}"
        self._has_nodes = has_nodes
        self.hashes: set[str] = set()
        self._endpoint = f"{protocol}/127.0.0.1:{self._port}"
        self._settings = settings
        self._domain = domain
        self.is_old = False
        self.requests = []
        self.before_answer: Callable[[str], object] = lambda service: None
        self._calls: list[str] = []
        self._came: list[Came] = []
        self._topics: dict[str, Publication] = {}
        self._listeners: dict[str, list[Any]] = {}
        self._services: dict[str, tuple[str, bytes | None]] = {}
        self._serving: list[Any] = []
        self._tokens: set[str] = set()
        self._number = 0
        self._lock = threading.Lock()
        self._session: Any = None
        self.start()

    def start(self) -> None:
        config = zenoh.Config()
        for key, value in {
            "mode": "router",
            "listen/endpoints": [self._endpoint],
            "scouting/multicast/enabled": False,
            "timestamping/enabled": True,
            **self._settings,
        }.items():
            config.insert_json5(key, json.dumps(value))
        self._session = until(lambda: zenoh.open(config), WAIT, not_yet=zenoh.ZError)
        self._own = str(self._session.zid())
        at_once = partial(Callback, indirect=False)
        self._session.liveliness().declare_subscriber(
            "@ros2_lv/**", at_once(self._token), history=True
        )
        self._session.declare_subscriber(
            f"{self._domain}/**",
            at_once(self._take),
            allowed_origin=zenoh.Locality.REMOTE,
        )
        # Each is there as long as it is held.
        self._serving = [self._declare("NN", "/talker")] if self._has_nodes else []
        for topic, publication in self._topics.items():
            self._begin(topic, publication)
        for service in self._services:
            self._serve(service)

    def stop(self) -> None:
        if self._session is not None:
            self._session.close()
            self._session = None
            with self._lock:
                self._tokens.clear()

    def advertise(
        self,
        topic: str,
        latched: bool = False,
        type_name: str = STRING,
        type_hash: str = "",
        node: str = "/talker",
    ) -> None:
        type_hash = type_hash or type_hash_of(type_name)
        made = Publication(type_name, type_hash, latched, node, self.is_old)
        self._topics[topic] = made
        if self._session is not None:
            self._begin(topic, made)

    def publish(self, topic: str, data: str) -> None:
        self.log(topic, cdr_string(data))

    def log(self, topic: str, payload: bytes) -> None:
        """Publish bytes."""
        publication = self._topics[topic]
        if publication.is_latched:
            publication.kept.append(payload)
        self._number += 1
        publication.put(payload, attachment=attached(self._number))

    def remove(self, topic: str) -> None:
        for declared in reversed(self._topics.pop(topic).declared):
            declared.undeclare()

    def subscribed(self) -> list[str]:
        return sorted(topic for kind, topic, _ in self._of_clients() if kind == "MS")

    def advertised(self) -> list[tuple[str, str]]:
        return [(t, name) for kind, t, name in self._of_clients() if kind == "MP"]

    def came(self) -> list[Came]:
        return list(self._came)

    def listen_as(
        self, topic: str, *nodes: str, type_hash: str = "", type_name: str = STRING
    ) -> None:
        for declared in self._listeners.pop(topic, []):
            declared.undeclare()
        type_hash = type_hash or type_hash_of(type_name)
        self._listeners[topic] = [
            self._declare("MS", node, topic, type_name, type_hash) for node in nodes
        ]

    def complain(self, words: str) -> None:
        pytest.skip("no router of zenoh refuses a topic")

    def serve(self, service: str, failure: str = "", reply: bytes | Any = None) -> None:
        is_new = service not in self._services
        self._services[service] = failure, reply
        if is_new and self._session is not None:
            self._serve(service)

    def calls(self) -> list[str]:
        return list(self._calls)

    def served(self) -> list[tuple[str, bytes]]:
        """The services that were called and what with, in their order."""
        return list(zip(self._calls, self.requests, strict=False))

    def declare(self, key: str) -> None:
        """Declare a token, whatever it says."""
        self._serving.append(self._session.liveliness().declare_token(key))

    def tokens(self, key: str) -> list[str]:
        """The keys of the tokens that fit, which others have declared."""
        replies = self._session.liveliness().get(key, timeout=WAIT)
        return [str(reply.ok.key_expr) for reply in replies]

    def put(
        self, key: str, payload: bytes, attachment: bytes, days_ahead: int = 0
    ) -> None:
        """Publish something, whatever it is.

        Args:
            key: on which.
            payload: what.
            attachment: what goes with it.
            days_ahead: of the clock of who publishes it.
        """
        now = self._session.new_timestamp()
        at = zenoh.Timestamp(now.get_time() + timedelta(days_ahead), now.get_id())
        self._session.put(key, payload, attachment=attachment, timestamp=at)

    def answer(self, key: str, replies: Iterator[bytes | None]) -> None:
        """Answer questions of a key with the next reply each; None for none."""

        def take(query: Any) -> None:
            with query:
                if (content := next(replies)) is not None:
                    query.reply(key, content)

        self._serving.append(self._session.declare_queryable(key, take, complete=True))

    def offer(self, topic: str, kind: str, definition: str = "") -> None:
        """Begin to publish a topic of any type."""
        self.advertise(topic, False, kind, ANY_HASH if definition else "")

    def _begin(self, topic: str, made: Publication) -> None:
        name = topic.strip("/")
        key = f"{self._domain}/{name}/{on_the_wire(made.type_name)}/{made.type_hash}"
        if made.is_latched and not made.has_cache:
            publisher = zenoh.ext.declare_advanced_publisher(
                self._session,
                key,
                cache=zenoh.ext.CacheConfig(max_samples=1000),
                publisher_detection=True,
            )
            for payload in made.kept:
                publisher.put(payload, attachment=attached(0))
        else:
            publisher = self._session.declare_publisher(key)
        made.put, made.declared = publisher.put, [publisher]
        if made.has_cache:
            made.declared.append(
                self._session.declare_queryable(
                    f"{self._own}/{key}", partial(_answer_kept, key, made)
                )
            )
        qos = f":{1 if made.is_latched else ''}:,10:,:,:,,"
        made.declared.append(
            self._declare(
                "MP", made.node, topic, made.type_name, made.type_hash, qos=qos
            )
        )

    def _declare(
        self,
        kind: str,
        node: str,
        topic: str = "",
        type_name: str = "",
        type_hash: str = "",
        qos: str = "::,10:,:,:,,",
    ) -> Any:
        self._number += 1
        namespace, _, name = node.rpartition("/")
        head = f"@ros2_lv/{self._domain}/{self._own}/0/{self._number}/{kind}/%"
        key = f"{head}/{namespace.replace('/', '%') or '%'}/{name}"
        if topic:
            key += f"/{topic.replace('/', '%')}/{on_the_wire(type_name)}"
            key += f"/{type_hash}/{qos}"
        return self._session.liveliness().declare_token(key)

    def _serve(self, service: str) -> None:
        kind = "test_msgs/srv/Any"
        name = service.strip("/")
        key = f"{self._domain}/{name}/{on_the_wire(kind)}/{ANY_HASH}"

        def answer(query: Any) -> None:
            with query:
                assert query.attachment is not None, "rmw_zenoh wants it"
                request = bytes(query.payload)
                self._calls.append(service)
                self.requests.append(request)
                self.before_answer(service)
                failure, reply = self._services[service]
                if failure:
                    query.reply_err(failure.encode())
                else:
                    query.reply(
                        key,
                        request if reply is None else reply,
                        attachment=query.attachment,
                    )

        self._serving += (
            self._session.declare_queryable(key, answer, complete=True),
            self._declare("SS", "/talker", service, kind, ANY_HASH),
        )

    def _token(self, sample: Any) -> None:
        with self._lock:
            is_there = sample.kind == zenoh.SampleKind.PUT
            change = self._tokens.add if is_there else self._tokens.discard
            change(str(sample.key_expr))

    def _of_clients(self) -> list[tuple[str, str, str]]:
        """Kind, topic and type of what clients have said that they have."""
        with self._lock:
            tokens = [one.split("/") for one in self._tokens]
        return [
            (one[5], one[9].replace("%", "/"), _plain(one[10]))
            for one in tokens
            if len(one) > 10 and one[2] != self._own and "::" in one[10]
        ]

    def _take(self, sample: Any) -> None:
        _, *topic, kind, type_hash = str(sample.key_expr).split("/")
        assert type_hash in (self.hashes or {type_hash_of(_plain(kind))})
        assert sample.attachment is not None
        payload = bytes(sample.payload)
        self._came.append(Came(f"/{'/'.join(topic)}", _plain(kind), payload))


def type_hash_of(type_name: str) -> str:
    return get_typestore(Stores.ROS2_JAZZY).hash_rihs01(type_name)


def _plain(wire_name: str) -> str:
    package, kind, _, name = wire_name.split("::")
    return f"{package}/{kind}/{name.rstrip('_')}"


def _answer_kept(key: str, made: Publication, query: Any) -> None:
    with query:
        for payload in made.kept:
            query.reply(key, payload, attachment=attached(0))
