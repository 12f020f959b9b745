"""A rosbridge server with rosapi, in this process; it can lie.

As the real one it fixes the durability of a subscription when that begins: one that
begins before its publisher does not get latched messages.
"""

from __future__ import annotations

import json
import struct
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from live_peers import STRING, WAIT, Came, LivePeer, cdr_string, free_port
from patience import until
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import Server, ServerConnection, serve

Answer = dict[str, Any] | None


def cbor(value: object) -> bytes:
    """A value as CBOR, with lengths of the shortest kind."""
    if isinstance(value, bool):
        return b"\xf5" if value else b"\xf4"
    if isinstance(value, int):
        return _head(0, value) if value >= 0 else _head(1, -1 - value)
    if isinstance(value, float):
        return b"\xfb" + struct.pack(">d", value)
    if isinstance(value, bytes):
        return _head(2, len(value)) + value
    if isinstance(value, str):
        return _head(3, len(value.encode())) + value.encode()
    if isinstance(value, list):
        return _head(4, len(value)) + b"".join(map(cbor, value))
    if isinstance(value, dict):
        pairs = (cbor(part) for pair in value.items() for part in pair)
        return _head(5, len(value)) + b"".join(pairs)
    assert value is None
    return b"\xf6"


def _head(major: int, number: int) -> bytes:
    if number < 24:
        return bytes([major << 5 | number])
    for kind, size in ((24, 1), (25, 2), (26, 4), (27, 8)):
        if number < 1 << 8 * size:
            return bytes([major << 5 | kind]) + number.to_bytes(size, "big")
    raise ValueError(number)


@dataclass
class Subscription:
    client: ServerConnection
    topic: str
    asked: dict[str, Any]


@dataclass
class Topic:
    type: str = STRING
    is_latched: bool = False
    publishers: list[str] = field(default_factory=lambda: ["/talker"])
    kept: list[bytes] = field(default_factory=list)


class RosbridgePeer(LivePeer):
    """A rosbridge that serves strings.

    Attributes:
        services: rosapi's, by name; without one a call of it fails.
        is_json: messages are sent as JSON, as by a server without `cbor-raw`.
        operations: what clients have sent.
    """

    def __init__(self) -> None:
        self._port = free_port()
        self.uri = f"rosbridge://127.0.0.1:{self._port}"
        self.services: dict[str, Callable[[dict[str, Any]], Answer]] = {
            "/rosapi/topics_and_raw_types": self._raw_topics,
            "/rosapi/topics": self._topics,
            "/rosapi/publishers": self._publishers,
            "/rosapi/subscribers": self._subscribers,
            "/rosapi/nodes": self._nodes,
            "/rosapi/node_details": self._node_details,
        }
        self.is_json = False
        self.operations: list[dict[str, Any]] = []
        self.requests = []
        self.there: dict[str, Topic] = {}
        self._lock = threading.RLock()
        self._server: Server | None = None
        self._thread: threading.Thread | None = None
        self._clients: set[ServerConnection] = set()
        self._advertised: dict[str, str] = {}
        self._listeners: dict[str, list[str]] = {}
        self._subscriptions: list[Subscription] = []
        self.start()

    def start(self) -> None:
        self._server = serve(self._serve, "127.0.0.1", self._port, compression=None)
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        if self._server is None or self._thread is None:
            return
        self._server.shutdown()
        self._thread.join()
        self._server = None
        with self._lock:
            clients = list(self._clients)
        for client in clients:
            # Both sides may end it at once.
            with suppress(ConnectionClosed):
                client.close()
        # What it had subscribed to is forgotten in its own thread.
        until(lambda: not self._clients, WAIT, not_yet=())

    def advertise(self, topic: str, latched: bool = False) -> None:
        with self._lock:
            self.there[topic] = Topic(is_latched=latched)

    def remove(self, topic: str) -> None:
        with self._lock:
            del self.there[topic]

    def publish(self, topic: str, data: str) -> None:
        payload = cdr_string(data)
        with self._lock:
            if self.there[topic].is_latched:
                self.there[topic].kept.append(payload)
            clients = {one.client for one in self._subscriptions if one.topic == topic}
            for client in clients:
                # It may leave just now.
                with suppress(ConnectionClosed):
                    self._publish(client, topic, payload)

    def subscribed(self) -> list[str]:
        with self._lock:
            return sorted(one.topic for one in self._subscriptions)

    def advertised(self) -> list[tuple[str, str]]:
        with self._lock:
            return list(self._advertised.items())

    def came(self) -> list[Came]:
        with self._lock:
            types = {one["topic"]: one["type"] for one in self.asked("advertise")}
            sent = self.asked("publish")
        return [Came(one["topic"], types[one["topic"]], one["msg"]) for one in sent]

    def listen_as(self, topic: str, *nodes: str) -> None:
        self._listeners[topic] = list(nodes)

    def serve(self, service: str, failure: str = "", reply: bytes | Any = None) -> None:
        def answer(arguments: dict[str, Any]) -> Answer:
            self.requests.append(arguments)
            if failure:
                raise RuntimeError(failure)
            return arguments if reply is None else reply

        self.services[service] = answer

    def calls(self) -> list[str]:
        named = (one["service"] for one in self.asked("call_service"))
        return [one for one in named if not one.startswith("/rosapi/")]

    def complain(self, words: str) -> None:
        self.send(json.dumps({"op": "status", "level": "error", "msg": words}))

    def asked(self, op: str) -> list[dict[str, Any]]:
        """The operations of a kind that clients have sent."""
        return [one for one in list(self.operations) if one["op"] == op]

    def send(self, frame: str | bytes) -> None:
        """Send a frame to all clients, whatever it is."""
        with self._lock:
            for client in self._clients:
                client.send(frame)

    def _serve(self, client: ServerConnection) -> None:
        with self._lock:
            if self._server is None:
                return
            self._clients.add(client)
        try:
            for frame in client:
                operation = json.loads(frame)
                with self._lock:
                    self.operations.append(operation)
                    self._take(client, operation)
        except ConnectionClosed:
            pass
        finally:
            with self._lock:
                self._clients.discard(client)
                left = [one for one in self._subscriptions if one.client is not client]
                self._subscriptions = left

    def _take(self, client: ServerConnection, operation: dict[str, Any]) -> None:
        op, topic = operation["op"], operation.get("topic", "")
        if op == "call_service":
            self._answer(client, operation)
        elif op == "subscribe":
            self._subscriptions.append(Subscription(client, topic, operation))
            if topic in self.there and self.there[topic].publishers:
                for payload in self.there[topic].kept:
                    self._publish(client, topic, payload)
        elif op == "advertise":
            self._advertised[topic] = operation["type"]
        elif op == "unadvertise":
            self._advertised.pop(topic, None)
        elif op == "unsubscribe":
            self._subscriptions = [
                one
                for one in self._subscriptions
                if one.client is not client or one.asked["id"] != operation["id"]
            ]

    def _answer(self, client: ServerConnection, call: dict[str, Any]) -> None:
        service = self.services.get(call["service"])
        answer: dict[str, Any] = {
            "op": "service_response",
            "service": call["service"],
            "id": call["id"],
            "result": service is not None,
        }
        if service is None:
            answer["values"] = f"Service {call['service']} does not exist"
        else:
            try:
                values = service(call["args"])
            except RuntimeError as error:
                answer |= {"result": False}
                values = str(error)
            if values is None:
                return
            answer["values"] = values
        client.send(json.dumps(answer))

    def _publish(self, client: ServerConnection, topic: str, payload: bytes) -> None:
        if self.is_json:
            words = payload[8:-1].decode()
            message: dict[str, Any] = {"data": words}
            operation = {"op": "publish", "topic": topic, "msg": message}
            client.send(json.dumps(operation))
        else:
            message = {"secs": 1_700_000_000, "nsecs": 5, "bytes": payload}
            client.send(cbor({"op": "publish", "topic": topic, "msg": message}))

    def _raw_topics(self, _: dict[str, Any]) -> Answer:
        texts = ["string data\n"] * len(self.there)
        return {**(self._topics(_) or {}), "typedefs_full_text": texts}

    def _topics(self, _: dict[str, Any]) -> Answer:
        return {
            "topics": list(self.there),
            "types": [topic.type for topic in self.there.values()],
        }

    def _publishers(self, arguments: dict[str, Any]) -> Answer:
        topic = self.there.get(arguments["topic"])
        return {"publishers": topic.publishers if topic else []}

    def _subscribers(self, arguments: dict[str, Any]) -> Answer:
        return {"subscribers": self._listeners.get(arguments["topic"], [])}

    def _nodes(self, _: dict[str, Any]) -> Answer:
        ends = [topic.publishers for topic in self.there.values()]
        ends += self._listeners.values()
        return {"nodes": sorted({node for nodes in ends for node in nodes})}

    def _node_details(self, arguments: dict[str, Any]) -> Answer:
        node = arguments["node"]
        return {
            "publishing": [t for t, of in self.there.items() if node in of.publishers],
            "subscribing": [t for t, of in self._listeners.items() if node in of],
            "services": [],
        }
