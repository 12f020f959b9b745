"""Nodes of ROS with rmw_cyclonedds_cpp, in this process, over the loopback alone.

What they put on the wire is written here again, and not with the code that is tested.
The participant has a port of its own, so that tests beside each other never meet.
"""

from __future__ import annotations

import random
import socket
import threading
import types
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field
from functools import cache
from itertools import count
from typing import Any

import numpy as np
import pytest
from cyclonedds import _clayer as clayer  # pyright: ignore
from cyclonedds import builtin
from cyclonedds.core import DDSException, InstanceState, SampleState, ViewState
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from live_peers import STRING, WAIT, Came, LivePeer, cdr_string
from patience import until
from rosbags.typesys import Stores, get_typestore

ANY_HASH = "RIHS01_" + "5a" * 32
INFO = "rmw_dds_common/msg/ParticipantEntitiesInfo"
ALL = SampleState.Any | ViewState.Any | InstanceState.Any
VIEWER = "/sambot_viz"
LOOK = 0.005
"""Between two looks at what has come [s]."""
NUMBERS = count(5000)
"""Of domains in this process."""

SETTINGS = """<CycloneDDS><Domain Id="any"><General><Interfaces>
<NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Compatibility>
<IgnoreTypeInformation>1.16</IgnoreTypeInformation></Compatibility><Discovery>
<ExternalDomainId>{domain}</ExternalDomainId><ParticipantIndex>0</ParticipantIndex>
<Ports><Base>{base}</Base><DomainGain>0</DomainGain></Ports></Discovery>
</Domain></CycloneDDS>"""


def free_ports() -> int:
    """The first of two ports of the loopback that are not used; see `free_port`."""
    while True:
        port = random.randrange(20_000, 30_000, 2)
        with ExitStack() as stack, suppress(OSError):
            for one in (port, port + 1):
                made = socket.socket(type=socket.SOCK_DGRAM)
                stack.enter_context(made).bind(("127.0.0.1", one))
            return port


@cache
def wire_type(name: str) -> Any:
    """A type of DDS without fields that mean anything."""
    package, kind, last = name.split("/")
    named = {"typename": f"{package}::{kind}::dds_::{last}_"}
    fields: dict[str, Any] = {"__annotations__": {"word": str}}
    return dataclass(types.new_class("Any", (IdlStruct,), named, fields.update))


@dataclass
class Publication:
    """A topic of a node.

    Attributes:
        kept: its messages, if it is latched.
        writer: of cyclonedds, while there is a participant.
    """

    type_name: str
    type_hash: str
    is_latched: bool
    node: str
    is_loose: bool = False
    kept: list[bytes] = field(default_factory=list)
    writer: Any = None


class DdsPeer(LivePeer):
    """A participant, with a talker in it that publishes strings.

    Args:
        domain: ROS's domain id.

    Attributes:
        before_answer: is called with the service before it answers.
    """

    absent = "No participant of DDS answers in domain 0 at 127.0.0.1:"
    # Which command it is hangs on who else is on this computer.
    remedy = "`"

    def __init__(self, domain: int = 0) -> None:
        self._port = free_ports()
        self._domain_id = domain
        self.uri = f"dds:?interface=lo&peer=127.0.0.1:{self._port}"
        self.requests = []
        self.before_answer: Callable[[str], object] = lambda service: None
        self._calls: list[str] = []
        self._came: list[Came] = []
        self._topics: dict[str, Publication] = {}
        self._services: dict[str, tuple[str, bytes | None]] = {}
        self._serving: dict[str, tuple[Any, Any]] = {}
        self._listeners: dict[str, list[Any]] = {}
        self._taps: dict[tuple[str, str], Any] = {}
        self._clients: dict[bool, dict[Any, Any]] = {True: {}, False: {}}
        self._nodes: dict[bytes, tuple[str, bool]] = {}
        self._lock = threading.RLock()
        self._participant: Any = None
        self.start()

    def start(self) -> None:
        settings = SETTINGS.format(base=self._port - 10, domain=self._domain_id)
        number = next(NUMBERS)
        self._domain: Any = Domain(number, settings)
        self._participant = until(
            lambda: DomainParticipant(number), WAIT, not_yet=DDSException
        )
        self._own = self._participant.guid
        watched = (
            (True, builtin.BuiltinTopicDcpsPublication),
            (False, builtin.BuiltinTopicDcpsSubscription),
        )
        self._watched = {
            is_writer: builtin.BuiltinDataReader(self._participant, topic)
            for is_writer, topic in watched
        }
        self._info = self._writer("ros_discovery_info", INFO, hash_of(INFO), True)
        with self._lock:
            for topic, publication in self._topics.items():
                self._begin(topic, publication)
            for service in self._services:
                self._serve(service)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def stop(self) -> None:
        if self._participant is None:
            return
        self._ended.set()
        self._thread.join()
        for kept in (self._listeners, self._taps, self._serving, self._nodes):
            kept.clear()
        for clients in self._clients.values():
            clients.clear()
        for publication in self._topics.values():
            publication.writer = None
        self._watched, self._info, self._participant = {}, None, None
        self._domain = None

    def advertise(
        self,
        topic: str,
        latched: bool = False,
        type_name: str = STRING,
        type_hash: str = "",
        node: str = "/talker",
        is_loose: bool = False,
    ) -> None:
        type_hash = type_hash or hash_of(type_name)
        made = Publication(type_name, type_hash, latched, node, is_loose)
        with self._lock:
            self._topics[topic] = made
            if self._participant is not None:
                self._begin(topic, made)

    def publish(self, topic: str, data: str) -> None:
        self.log(topic, cdr_string(data))

    def log(self, topic: str, payload: bytes) -> None:
        """Publish bytes."""
        publication = self._topics[topic]
        if publication.is_latched:
            publication.kept.append(payload)
        if publication.writer is not None:
            write(publication.writer, payload)

    def remove(self, topic: str) -> None:
        with self._lock:
            del self._topics[topic]

    def subscribed(self) -> list[str]:
        with self._lock:
            found = [one.topic_name for one in self._clients[False].values()]
            there = {topic: one.writer for topic, one in self._topics.items()}
        names = [name[2:] for name in found if name.startswith("rt/")]
        return sorted(name for name in names if is_heard(there.get(name)))

    def advertised(self) -> list[tuple[str, str]]:
        with self._lock:
            found = [*self._clients[True].values()]
        return [
            (one.topic_name[2:], plain(one.type_name))
            for one in found
            if one.topic_name.startswith("rt/")
        ]

    def came(self) -> list[Came]:
        return list(self._came)

    def listen_as(
        self,
        topic: str,
        *nodes: str,
        type_hash: str = "",
        type_name: str = STRING,
        is_latched: bool = False,
    ) -> None:
        type_hash = type_hash or hash_of(type_name)
        with self._lock:
            self._listeners[topic] = []
            for node in nodes:
                reader = self._reader(f"rt{topic}", type_name, type_hash, is_latched)
                self._listeners[topic].append(reader)
                self._nodes[reader.guid.bytes] = node, False
            self._say_nodes()

    def complain(self, words: str) -> None:
        pytest.skip("no participant of DDS refuses a topic")

    def serve(self, service: str, failure: str = "", reply: bytes | Any = None) -> None:
        if failure:
            pytest.skip("a service has no way to fail over DDS")
        with self._lock:
            is_new = service not in self._services
            self._services[service] = failure, reply
            if is_new and self._participant is not None:
                self._serve(service)

    def calls(self) -> list[str]:
        return list(self._calls)

    def served(self) -> list[tuple[str, bytes]]:
        """The services that were called and what with, in their order."""
        return list(zip(self._calls, self.requests, strict=False))

    def offer(self, topic: str, kind: str, definition: str = "") -> None:
        """Begin to publish a topic of any type."""
        self.advertise(topic, False, kind, ANY_HASH if definition else "")

    def _begin(self, topic: str, made: Publication) -> None:
        made.writer = self._writer(
            f"rt{topic}", made.type_name, made.type_hash, made.is_latched, made.is_loose
        )
        self._nodes[made.writer.guid.bytes] = made.node, True
        self._say_nodes()
        for payload in made.kept:
            write(made.writer, payload)

    def _serve(self, service: str) -> None:
        kind = "test_msgs/srv/Any"
        reader = self._reader(f"rq{service}Request", f"{kind}_Request", ANY_HASH)
        writer = self._writer(f"rr{service}Reply", f"{kind}_Response", ANY_HASH)
        self._serving[service] = reader, writer
        self._nodes[reader.guid.bytes] = "/talker", False
        self._say_nodes()

    def _writer(
        self,
        topic: str,
        type_name: str,
        type_hash: str,
        is_latched: bool = False,
        is_loose: bool = False,
    ) -> Any:
        made = Topic(self._participant, topic, wire_type(type_name))
        qos = profile(type_hash, is_latched, is_loose)
        return DataWriter(self._participant, made, qos=qos)

    def _reader(
        self, topic: str, type_name: str, type_hash: str, is_latched: bool = False
    ) -> Any:
        made = Topic(self._participant, topic, wire_type(type_name))
        return DataReader(self._participant, made, qos=profile(type_hash, is_latched))

    def _say_nodes(self) -> None:
        """Say which endpoint is of which node."""
        store = get_typestore(Stores.ROS2_JAZZY)
        gid = store.types["rmw_dds_common/msg/Gid"]
        entities = store.types["rmw_dds_common/msg/NodeEntitiesInfo"]

        def gids(node: str, is_writer: bool) -> list[Any]:
            wanted = node, is_writer
            found = [one for one, has in self._nodes.items() if has == wanted]
            return [gid(data=np.frombuffer(one, np.uint8)) for one in found]

        nodes = {node: node.rpartition("/") for node, _ in self._nodes.values()}
        message = store.types[INFO](
            gid(data=np.frombuffer(self._own.bytes, np.uint8)),
            [
                entities(space or "/", name, gids(node, False), gids(node, True))
                for node, (space, _, name) in nodes.items()
            ],
        )
        write(self._info, bytes(store.serialize_cdr(message, INFO)))

    def _run(self) -> None:
        while not self._ended.wait(LOOK):
            with self._lock:
                for is_writer, reader in self._watched.items():
                    for sample in reader.take(N=100):
                        self._see(is_writer, sample)
                asked = [
                    (service, content)
                    for service, (reader, _) in self._serving.items()
                    for content in take(reader)
                ]
                for (topic, kind), reader in self._taps.items():
                    for content in take(reader):
                        self._came.append(Came(topic, kind, content))
            for service, content in asked:
                self._answer(service, content)

    def _see(self, is_writer: bool, sample: Any) -> None:
        """Take what a client has begun or ended."""
        clients = self._clients[is_writer]
        if not sample.sample_info.valid_data:
            clients.pop(sample.key, None)
            return
        if sample.participant_key == self._own:
            return
        clients[sample.key] = sample
        if not is_writer or not sample.topic_name.startswith("rt/"):
            return
        topic, kind = sample.topic_name[2:], plain(sample.type_name)
        if (topic, kind) not in self._taps:
            reader = self._reader(f"rt{topic}", kind, hash_of(kind))
            self._taps[topic, kind] = reader
            # Whoever only looks is not told of as one that takes it.
            self._nodes[reader.guid.bytes] = VIEWER, False
            self._say_nodes()

    def _answer(self, service: str, content: bytes) -> None:
        # Cyclone DDS writes before each request who asks, and which of his it is.
        head, request = content[4:20], content[:4] + content[20:]
        self._calls.append(service)
        self.requests.append(request)
        self.before_answer(service)
        _, reply = self._services[service]
        reply = request if reply is None else reply
        with self._lock:
            write(self._serving[service][1], reply[:4] + head + reply[4:])


def profile(type_hash: str, is_latched: bool = False, is_loose: bool = False) -> Qos:
    return Qos(
        Policy.Reliability.BestEffort
        if is_loose
        else Policy.Reliability.Reliable(100_000_000),
        Policy.Durability.TransientLocal if is_latched else Policy.Durability.Volatile,
        Policy.History.KeepLast(1000),
        Policy.DurabilityService(0, Policy.History.KeepLast(1000), -1, -1, -1),
        Policy.Userdata(f"typehash={type_hash};".encode()),
    )


def take(reader: Any) -> list[bytes]:
    taken = clayer.ddspy_take(reader._ref, ALL, 1000)
    # The header says how many bytes at the end only fill it up.
    found = [content for content, info in taken if info.valid_data]
    return [one[:3] + b"\0" + one[4 : len(one) - (one[3] & 3)] for one in found]


def write(writer: Any, content: bytes) -> None:
    filling = -len(content) % 4
    whole = content[:3] + bytes([filling]) + content[4:] + bytes(filling)
    assert clayer.ddspy_write(writer._ref, whole) >= 0


def is_heard(writer: Any) -> bool:
    """Whether a writer has a reader; one that is not there needs none."""
    return writer is None or bool(writer.get_matched_subscriptions())


def hash_of(type_name: str) -> str:
    store = get_typestore(Stores.ROS2_JAZZY)
    return store.hash_rihs01(type_name) if type_name in store.types else ANY_HASH


def plain(wire_name: str) -> str:
    package, kind, _, name = wire_name.split("::")
    return f"{package}/{kind}/{name.rstrip('_')}"
