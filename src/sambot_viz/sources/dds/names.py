"""The names and the small messages that ROS 2 has on DDS.

A topic /scan is rt/scan there, a service /power has the topics rq/powerRequest and
rr/powerReply. Each participant says on one more topic which endpoint is of which node.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterable
from dataclasses import dataclass

from sambot_viz.sources.ros_endpoint import Kind
from sambot_viz.sources.ros_graph import NO_HASH, demangled, mangled

DISCOVERY = "ros_discovery_info"
DISCOVERY_TYPE = mangled("rmw_dds_common/msg/ParticipantEntitiesInfo")
ENDPOINT_ID, OLD_ENDPOINT_ID = 16, 24
"""The bytes of an endpoint's id in that message; up to ROS 2 Humble it had 24."""
CYCLONE, EPROSIMA = b"\1\x10", b"\1\x0f"
"""With what all ids begin in programs with Cyclone DDS and with Fast DDS."""
_HASH = re.compile(rb"typehash=(RIHS\d\d_[0-9a-f]{64});")
_REQUEST = re.compile(r"rq(/.+)Request")
_HEAD = b"\0\1\0\0"


@dataclass(frozen=True, slots=True)
class Named:
    """The meaning of a DDS topic in ROS 2."""

    kind: Kind
    name: str
    type_name: str


def named(topic: str, wire_type: str, is_writer: bool) -> Named | None:
    """Return what an endpoint of DDS is in ROS 2; None for nothing that is used."""
    if topic.startswith("rt/"):
        kind = Kind.PUBLISHER if is_writer else Kind.SUBSCRIBER
        type_name = demangled(wire_type)
        return Named(kind, topic[2:], type_name) if type_name else None
    found = _REQUEST.fullmatch(topic)
    type_name = demangled(wire_type.replace("_Request_", "_"))
    if found is None or is_writer or not type_name:
        return None
    return Named(Kind.SERVICE, found[1], type_name)


def type_hash_of(user_data: bytes) -> str:
    """Return the hash that an endpoint says of its type; up to Humble there is none."""
    found = _HASH.search(user_data)
    return found[1].decode() if found else NO_HASH


def request_topic(service: str) -> str:
    """Return the topic with the requests of a service."""
    return f"rq{service}Request"


def reply_topic(service: str) -> str:
    """Return the topic with the answers of a service."""
    return f"rr{service}Reply"


def nodes_of(message: bytes, id_size: int) -> tuple[bytes, dict[bytes, str]]:
    """Return the id of a participant, and that of each of its endpoints → its node.

    Args:
        message: a ParticipantEntitiesInfo as CDR.
        id_size: the bytes of an id in it.

    Raises:
        ValueError: it makes no sense.
    """
    reader = _CdrReader(message)
    participant = reader.skip(id_size)
    found: dict[bytes, str] = {}
    for _ in range(reader.count()):
        space, name = reader.string(), reader.string()
        node = f"{space.rstrip('/')}/{name}"
        for _ in range(2):
            for _ in range(reader.count()):
                # The id itself has 16 bytes also where it has room for more.
                found[reader.skip(id_size)[:ENDPOINT_ID]] = node
    return participant, found


def nodes_message(
    participant: bytes, node: str, readers: Iterable[bytes], writers: Iterable[bytes]
) -> bytes:
    """Return the ParticipantEntitiesInfo of a participant with one node.

    Args:
        participant: its id.
        node: in the root namespace, such as /viewer.
        readers: the ids of what it reads with.
        writers: the same of what it writes with.
    """
    written = participant + struct.pack("<I", 1)
    for word in (b"/\0", node.lstrip("/").encode() + b"\0"):
        written += bytes(-len(written) % 4) + struct.pack("<I", len(word)) + word
    for ids in (tuple(readers), tuple(writers)):
        written += bytes(-len(written) % 4) + struct.pack("<I", len(ids))
        written += b"".join(ids)
    return _HEAD + written


class _CdrReader:
    """Reads CDR from its beginning."""

    def __init__(self, message: bytes) -> None:
        self._order = "<" if message[1:2] == b"\1" else ">"
        self._body = message[len(_HEAD) :]
        self._at = 0

    def skip(self, size: int) -> bytes:
        taken = self._body[self._at : self._at + size]
        if len(taken) < size:
            raise ValueError("it ends before what it says it has")
        self._at += size
        return taken

    def count(self) -> int:
        self._at += -self._at % 4
        (number,) = struct.unpack(f"{self._order}I", self.skip(4))
        # Each counted element has at least one byte.
        if number > len(self._body):
            raise ValueError("it has more than there can be")
        return number

    def string(self) -> str:
        return self.skip(self.count()).rstrip(b"\0").decode("utf-8", "replace")
