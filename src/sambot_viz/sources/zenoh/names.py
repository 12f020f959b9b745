"""The names that rmw_zenoh_cpp gives: liveliness tokens, keys and attachments.

As its design page and its source write them since 2024-11. A token says of a node or of
an endpoint that it is there:
@ros2_lv/DOMAIN/SESSION/NODE/ENTITY/KIND/ENCLAVE/NAMESPACE/NAME[/TOPIC/TYPE/HASH/QOS],
with % for each slash.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import Kind, RosEndpoint
from sambot_viz.sources.ros_graph import demangled, mangled

TOKENS = "@ros2_lv/**"
_NODE = "NN"
_KINDS = {"MP": Kind.PUBLISHER, "MS": Kind.SUBSCRIBER, "SS": Kind.SERVICE}
_LETTERS = {kind: letters for letters, kind in _KINDS.items()}
_RELIABILITY = {"2": "best_effort"}
_DURABILITY = {"1": "transient_local"}
_HISTORY = {"2": "keep_all"}
"""What differs from the default, which is written as nothing or as its number."""
_STAMP = b"source_timestamp"


@dataclass(frozen=True, slots=True)
class LivenessToken:
    """The content of a liveliness token.

    Attributes:
        domain: the domain id.
        session: the zenoh session of the node.
        endpoint: the announced endpoint; None for a node.
        node: the full name of the node.
    """

    domain: int
    session: str
    node: str
    endpoint: RosEndpoint | None


def parse_token(key: str) -> LivenessToken | None:
    """Read a token; None when it is none of ROS, or of a kind that is not used."""
    parts = key.split("/")
    if len(parts) < 9 or not parts[1].isdecimal():
        return None
    _, domain, session, _, _, kind, _, namespace, name, *rest = parts
    node = f"{namespace.replace('%', '/').rstrip('/')}/{name}"
    if kind == _NODE:
        return LivenessToken(int(domain), session, node, None)
    if kind not in _KINDS or len(rest) < 4:
        return None
    topic, wire_name, type_hash, qos = rest[:4]
    type_name = demangled(wire_name)
    if not type_name:
        return None
    endpoint = RosEndpoint(
        _KINDS[kind],
        node,
        topic.replace("%", "/"),
        type_name,
        type_hash,
        _qos(qos),
    )
    return LivenessToken(int(domain), session, node, endpoint)


def node_token(domain: int, session: str, node: str) -> str:
    """Return the token of a node in the root namespace, such as /viewer."""
    return f"@ros2_lv/{domain}/{session}/0/0/{_NODE}/%/%/{node.lstrip('/')}"


def endpoint_token(
    domain: int, session: str, number: int, endpoint: RosEndpoint
) -> str:
    """Return the token of an endpoint with the usual QoS."""
    letters, topic = _LETTERS[endpoint.kind], endpoint.name.replace("/", "%")
    qos = endpoint.qos or Qos()
    durability = "1" if qos.durability == "transient_local" else ""
    return (
        f"@ros2_lv/{domain}/{session}/0/{number}/{letters}/%/%/"
        f"{endpoint.node.lstrip('/')}/{topic}/{mangled(endpoint.type_name)}/"
        f"{endpoint.type_hash}/:{durability}:,{qos.depth or 10}:,:,:,,"
    )


def key_of(domain: int, name: str, type_name: str, type_hash: str = "*") -> str:
    """Return the key of a topic or a service; by default with any definition."""
    return f"{domain}/{name.strip('/')}/{mangled(type_name)}/{type_hash}"


def attachment(number: int, stamp_ns: int, source: bytes) -> bytes:
    """Return what goes with each message.

    Args:
        number: of the message, from 1.
        stamp_ns: when it is published [ns].
        source: identifies the publisher, 16 bytes.
    """
    return b"".join(
        (
            _string(b"sequence_number"),
            struct.pack("<q", number),
            _string(_STAMP),
            struct.pack("<q", stamp_ns),
            _string(b"source_gid"),
            _string(source),
        )
    )


def stamp_of(attached: bytes) -> int | None:
    """Return when a message was published [ns]; None where that is not attached."""
    at = attached.find(_STAMP)
    written = attached[at + len(_STAMP) : at + len(_STAMP) + 8]
    if at < 0 or len(written) < 8:
        return None
    return int.from_bytes(written, "little", signed=True)


def _string(word: bytes) -> bytes:
    return bytes([len(word)]) + word


def _qos(written: str) -> Qos:
    reliability, durability, history = (*written.split(":"), "", "")[:3]
    kind, _, depth = history.partition(",")
    is_kept = durability == "1"
    return Qos(
        _RELIABILITY.get(reliability, "reliable"),
        _DURABILITY.get(durability, "volatile"),
        _HISTORY.get(kind, "keep_last"),
        int(depth) if depth.isdecimal() and len(depth) < 10 else 0,
        is_kept,
    )
