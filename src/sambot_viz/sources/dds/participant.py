"""A participant of DDS: with `raw`, the one place that knows its Python package.

A thread waits for whatever comes, lets it wait a moment for more, takes all of it, and
hands it to the loop at once: to wake that for each of a thousand messages in a second
costs more than they do.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import count
from typing import Any

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.sources.dds import names, raw
from sambot_viz.sources.dds.endpoints import DdsEndpoint, DdsPeer, as_endpoint, as_peer
from sambot_viz.sources.dds.ends import DEPTH, DdsPublisher, DdsReader, policies
from sambot_viz.sources.dds.settings import settings
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_graph import NO_HASH, NODE

_TOGETHER = 0.008
"""Messages that come within this time are handed on together [s]."""
LONGEST_STOP = 5.0
"""`close` waits this long for the thread [s]."""
_MOST_KEPT = 1000
"""Received messages of a topic that may wait; above it the oldest are dropped."""
_MOST_ENDPOINTS = 1000
"""Maximum number taken at once."""
_NUMBERS = count(1000)
"""Of domains in this process, where each source has one; the real one is a setting."""

Post = Callable[[Callable[[], object]], object]
OnSample = Callable[[bytes, int, int], object]
"""Called with CDR, what identifies its writer, and when it was written [ns]."""


@dataclass(frozen=True, slots=True)
class _ReadFrom:
    """A reader: the function that takes its messages, and the callback for the loop."""

    condition: Any
    take: Callable[[], list[Any]]
    told: Callable[[list[Any]], object]


class DdsParticipant:
    """A participant, its readers and its writers; used in the loop's thread.

    Args:
        address: the domain, and where its participants are.
        post: has something done in that thread.

    Attributes:
        id: identifies it to all others.
        is_closed: it has ended.

    Raises:
        SourceError: the address makes no sense on this computer.
    """

    def __init__(self, address: Address, post: Post) -> None:
        from cyclonedds.core import DDSException, GuardCondition, WaitSet
        from cyclonedds.domain import Domain, DomainParticipant
        from cyclonedds.qos import Policy, Qos

        number = next(_NUMBERS)
        name = Policy.EntityName(NODE[1:])
        try:
            self._domain: Any = Domain(number, settings(address))
            self._participant: Any = DomainParticipant(number, qos=Qos(name))
        except DDSException as error:
            raise SourceError(_refused(address)) from error
        self.id: bytes = self._participant.guid.bytes
        self.is_closed = False
        self._post = post
        self._waitset: Any = WaitSet(self._participant)
        self._end: Any = GuardCondition(self._participant)
        self._waitset.attach(self._end)
        self._readings: dict[Any, _ReadFrom] = {}
        self._readers: list[bytes] = []
        self._publishers: dict[bytes, DdsPublisher] = {}
        self._node: DdsPublisher | None = None
        self._is_saying = False
        self._thread = threading.Thread(
            target=self._read, name=f"sambot-viz {address.label}", daemon=True
        )
        self._thread.start()

    def close(self) -> None:
        """End it, with its readers and writers."""
        self.is_closed = True
        self._end.set(True)
        self._thread.join(LONGEST_STOP)
        for publisher in (*self._publishers.values(), self._node):
            if publisher is not None:
                publisher.close()
        self._readings.clear()
        # What belongs to it ends with it, then its domain.
        self._waitset = self._end = None
        self._participant = None
        self._domain = None

    def watch_peers(self, told: Callable[[DdsPeer], object]) -> None:
        """Tell of other participants as they come and go, those that are there first.

        Those of this program are left out, also of others on the network.
        """
        from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsParticipant

        reader: Any = BuiltinDataReader(self._participant, BuiltinTopicDcpsParticipant)
        self._watch(reader, partial(as_peer, NODE[1:]), told)

    def watch_endpoints(self, told: Callable[[DdsEndpoint], object]) -> None:
        """Tell of the readers and writers of other participants in the same way."""
        from cyclonedds import builtin

        for topic, is_writer in (
            (builtin.BuiltinTopicDcpsPublication, True),
            (builtin.BuiltinTopicDcpsSubscription, False),
        ):
            reader: Any = builtin.BuiltinDataReader(self._participant, topic)
            self._watch(reader, partial(as_endpoint, self.id, is_writer), told)

    def say_node(self) -> None:
        """Say from now on which node this is, and what it has."""
        kept = Qos("reliable", "transient_local")
        self._node = self._write(names.DISCOVERY, names.DISCOVERY_TYPE, "", kept, 1)
        self._say()

    def subscribe(
        self,
        topic: str,
        wire_type: str,
        qos: Qos,
        take: OnSample,
        on_large: Callable[[int], object],
    ) -> DdsReader:
        """Subscribe to a topic of DDS.

        Args:
            topic: the name in DDS, such as rt/scan.
            wire_type: the name of its type in DDS.
            qos: the requested QoS.
            take: called with the messages.
            on_large: called with the size of a message that is too large [bytes].
        """
        from cyclonedds.sub import DataReader
        from cyclonedds.topic import Topic

        def told(samples: list[Any]) -> None:
            for content, info in samples:
                if len(content) > limits.MESSAGE.value:
                    on_large(len(content))
                else:
                    take(content, info.publication_handle, info.source_timestamp)

        made: Any = Topic(self._participant, topic, raw.wire_type(wire_type))
        reader: Any = DataReader(self._participant, made, qos=policies(qos, _MOST_KEPT))
        identity: bytes = reader.guid.bytes
        taken = partial(raw.take, reader, _MOST_KEPT)
        self._read_from(identity, reader, taken, told)
        self._readers.append(identity)
        self._say()
        return DdsReader(reader, partial(self._leave, identity))

    def publisher(self, topic: str, wire_type: str, type_hash: str) -> DdsPublisher:
        """Begin to publish a topic of DDS, of a type with a hash; "" for none."""
        made = self._write(topic, wire_type, type_hash, Qos("reliable", "volatile"))
        self._publishers[made.id] = made
        self._say()
        return made

    def _write(
        self, topic: str, wire_type: str, type_hash: str, qos: Qos, depth: int = DEPTH
    ) -> DdsPublisher:
        from cyclonedds.pub import DataWriter
        from cyclonedds.topic import Topic

        has_hash = type_hash and type_hash != NO_HASH
        said = f"typehash={type_hash};" if has_hash else ""
        made: Any = Topic(self._participant, topic, raw.wire_type(wire_type))
        writer: Any = DataWriter(
            self._participant, made, qos=policies(qos, depth, said)
        )
        return DdsPublisher(writer, self._forget)

    def _watch(
        self,
        reader: Any,
        read: Callable[[Any], Any],
        told: Callable[[Any], object],
    ) -> None:
        def take() -> list[Any]:
            samples = map(read, reader.take(N=_MOST_ENDPOINTS))
            return [one for one in samples if one is not None]

        def tell(found: list[Any]) -> None:
            for one in found:
                told(one)

        self._read_from(reader, reader, take, tell)

    def _read_from(
        self,
        key: object,
        reader: Any,
        take: Callable[[], list[Any]],
        told: Callable[[list[Any]], object],
    ) -> None:
        from cyclonedds.core import InstanceState, ReadCondition, SampleState, ViewState

        new = SampleState.NotRead | ViewState.Any | InstanceState.Any
        condition: Any = ReadCondition(reader, new)
        self._readings[key] = _ReadFrom(condition, take, told)
        self._waitset.attach(condition)

    def _leave(self, identity: bytes) -> None:
        reading = self._readings.pop(identity, None)
        if reading is not None and not self.is_closed:
            self._waitset.detach(reading.condition)
            self._readers.remove(identity)
            self._say()

    def _forget(self, identity: bytes) -> None:
        if not self.is_closed and self._publishers.pop(identity, None) is not None:
            self._say()

    def _say(self) -> None:
        """Say soon what this node has: a thousand topics are subscribed to at once."""
        if self._node is not None and not self._is_saying:
            self._is_saying = True
            asyncio.get_running_loop().call_later(_TOGETHER, self._say_now)

    def _say_now(self) -> None:
        self._is_saying = False
        if self._node is not None and not self.is_closed:
            message = names.nodes_message(
                self.id, NODE, self._readers, self._publishers
            )
            self._node.put(message)

    def _read(self) -> None:
        from cyclonedds.util import duration

        waitset, forever = self._waitset, duration(infinite=True)
        while True:
            waitset.wait(forever)
            if self.is_closed:
                return
            self._take_all()
            time.sleep(_TOGETHER)

    def _take_all(self) -> None:
        # DDS ends a reader when nothing refers to it: names of this function may, but
        # not those of one that waits for the next message.
        found: list[tuple[_ReadFrom, list[Any]]] = []
        # Others may subscribe meanwhile.
        for reading in tuple(self._readings.values()):
            if taken := reading.take():
                found.append((reading, taken))
        if found:
            self._post(partial(self._hand_on, found))

    def _hand_on(self, found: list[tuple[_ReadFrom, list[Any]]]) -> None:
        for reading, taken in found:
            reading.told(taken)


def _refused(address: Address) -> str:
    if address.interface:
        return (
            f"DDS cannot begin at the network interface {address.interface}: "
            "`ip -brief address` lists those of this computer"
        )
    return (
        f"DDS cannot begin in domain {address.domain}: is there a network, and are "
        "there fewer than 100 participants on this computer?"
    )
