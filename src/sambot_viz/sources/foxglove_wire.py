"""The frames of Foxglove's websocket protocol, in both directions.

Text frames are JSON with `op`; binary frames are little-endian and begin with an
opcode. Nothing that a peer writes about lengths is trusted, and a channel that makes
no sense does not hide the others of its frame.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar, cast

import msgspec

from sambot_viz.messages import Schema
from sambot_viz.sources.qos import Qos, parse_qos

SUBPROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")
"""Newer servers take only the first, older ones only the second."""

_MESSAGE, _TIME, _SERVICE, _ASSET = 1, 2, 3, 4
_CALL = 2
"""The opcode of a call, in the other direction."""
_MESSAGE_HEAD = struct.Struct("<BIQ")
_PUBLISHED_HEAD = struct.Struct("<BI")
_TIME_HEAD = struct.Struct("<BQ")
_ASSET_HEAD = struct.Struct("<BIBI")
_SERVICE_HEAD = struct.Struct("<BIII")
_BASE64_SCHEMAS = ("protobuf", "flatbuffer")

Id = Annotated[int, msgspec.Meta(ge=0)]


class Malformed(ValueError):
    """A frame that makes no sense."""


@dataclass(frozen=True, slots=True)
class MessageFrame:
    """A message of a subscription; `payload` is a view of the frame."""

    subscription_id: int
    log_ns: int
    payload: memoryview


@dataclass(frozen=True, slots=True)
class TimeFrame:
    """The time at the server [ns]."""

    time_ns: int


@dataclass(frozen=True, slots=True)
class AssetFrame:
    """The answer to a request for a file: its bytes, or the text of the refusal."""

    request_id: int
    error: str | None
    content: bytes


@dataclass(frozen=True, slots=True)
class ServiceFrame:
    """The answer of a service: the response, as CDR."""

    call_id: int
    content: bytes


BinaryFrame = MessageFrame | TimeFrame | AssetFrame | ServiceFrame


def parse_binary(frame: bytes) -> BinaryFrame | None:
    """Read a binary frame; None for kinds that only answer other clients' requests.

    Raises:
        Malformed: it is shorter than its own length.
    """
    opcode = frame[0] if frame else -1
    try:
        if opcode == _MESSAGE:
            _, subscription, log_ns = _MESSAGE_HEAD.unpack_from(frame)
            view = memoryview(frame)[_MESSAGE_HEAD.size :]
            return MessageFrame(subscription, log_ns, view)
        if opcode == _TIME:
            return TimeFrame(_TIME_HEAD.unpack_from(frame)[1])
        if opcode == _ASSET:
            return _asset(frame)
        if opcode == _SERVICE:
            return _service(frame)
    except struct.error as error:
        raise Malformed(f"a frame of {len(frame)} bytes is cut") from error
    if not frame:
        raise Malformed("a frame is empty")
    return None


def _asset(frame: bytes) -> AssetFrame:
    _, request, status, length = _ASSET_HEAD.unpack_from(frame)
    rest = memoryview(frame)[_ASSET_HEAD.size :]
    if length > len(rest):
        raise Malformed(f"an error text of {length} bytes in {len(rest)}")
    error = str(rest[:length], "utf-8", "replace") if status else None
    return AssetFrame(request, error, b"" if status else bytes(rest[length:]))


def _service(frame: bytes) -> ServiceFrame:
    _, _, call, length = _SERVICE_HEAD.unpack_from(frame)
    rest = frame[_SERVICE_HEAD.size :]
    if length > len(rest):
        raise Malformed(f"the name of an encoding of {length} bytes in {len(rest)}")
    return ServiceFrame(call, rest[length:])


class ServerInfo(msgspec.Struct, rename="camel"):
    """The first frame of a server."""

    name: str = ""
    capabilities: tuple[str, ...] = ()
    supported_encodings: tuple[str, ...] = ()
    session_id: str | None = None


class ServerChannel(msgspec.Struct, rename="camel"):
    """A channel that a server advertises."""

    id: Id
    topic: str
    encoding: str = ""
    schema_name: str = ""
    schema_encoding: str | None = None
    schema: str | None = None
    metadata: Any = None

    @property
    def qos(self) -> Qos | None:
        """The QoS that publishers offer, where the server says it as recorders do."""
        told: object = self.metadata
        if not isinstance(told, dict):
            return None
        profiles = cast("dict[str, object]", told).get("offered_qos_profiles", "")
        return parse_qos(str(profiles))

    def definition(self) -> Schema:
        """Return the schema; its encoding follows from the message's if missing."""
        encoding = self.schema_encoding or ""
        content: str | bytes = self.schema or ""
        if encoding in _BASE64_SCHEMAS:
            try:
                content = base64.b64decode(content, validate=True)
            except (binascii.Error, ValueError):
                content = b""
        if not encoding and content:
            encoding = {"cdr": "ros2msg", "ros1": "ros1msg"}.get(self.encoding, "")
        return Schema(self.schema_name, encoding, content)


class ServerStatus(msgspec.Struct):
    """A line about the server's health: level 0 info, 1 warning, 2 error."""

    level: int = 0
    message: str = ""
    id: str | None = None


class StatusesRemoved(msgspec.Struct, rename="camel"):
    """Lines about the server's health that are no longer true."""

    status_ids: tuple[str, ...] = ()


class Unadvertised(msgspec.Struct, rename="camel"):
    """Channels that are gone."""

    channel_ids: tuple[Id, ...] = ()


class ParameterValue(msgspec.Struct):
    """A parameter; None when it is not set."""

    name: str
    value: Any = None
    type: str | None = None


class TopicPublishers(msgspec.Struct, rename="camel"):
    """Who publishes a topic."""

    name: str
    publisher_ids: tuple[str, ...] = ()


class TopicSubscribers(msgspec.Struct, rename="camel"):
    """Who has subscribed to a topic."""

    name: str
    subscriber_ids: tuple[str, ...] = ()


class GraphUpdate(msgspec.Struct, rename="camel"):
    """Topics whose publishers or subscribers have changed, and topics that are gone."""

    published_topics: tuple[TopicPublishers, ...] = ()
    subscribed_topics: tuple[TopicSubscribers, ...] = ()
    removed_topics: tuple[str, ...] = ()


class OfferedService(msgspec.Struct):
    """A service that can be called."""

    id: Id
    name: str


class ServicesAdvertised(msgspec.Struct):
    """Services that are there now."""

    services: tuple[OfferedService, ...]


class ServicesUnadvertised(msgspec.Struct, rename="camel"):
    """Services that are gone."""

    service_ids: tuple[Id, ...] = ()


class ServiceFailure(msgspec.Struct, rename="camel"):
    """Why a call has no answer."""

    call_id: Id = 0
    message: str = ""


class _Op(msgspec.Struct):
    op: str


class Advertised(msgspec.Struct):
    """Channels that are there now."""

    channels: tuple[ServerChannel, ...]


class ParameterValues(msgspec.Struct):
    """Parameters that were asked for, or have changed."""

    parameters: tuple[ParameterValue, ...]


TextFrame = (
    ServerInfo
    | ServerStatus
    | StatusesRemoved
    | Advertised
    | Unadvertised
    | ParameterValues
    | GraphUpdate
    | ServicesAdvertised
    | ServicesUnadvertised
    | ServiceFailure
)

_WHOLE = {
    "serverInfo": ServerInfo,
    "status": ServerStatus,
    "removeStatus": StatusesRemoved,
    "unadvertise": Unadvertised,
    "connectionGraphUpdate": GraphUpdate,
    "unadvertiseServices": ServicesUnadvertised,
    "serviceCallFailure": ServiceFailure,
}
_LISTS: Mapping[str, tuple[str, type[Any], Callable[[tuple[Any, ...]], TextFrame]]] = {
    "advertise": ("channels", ServerChannel, Advertised),
    "parameterValues": ("parameters", ParameterValue, ParameterValues),
    "advertiseServices": ("services", OfferedService, ServicesAdvertised),
}
"""Frames with a list whose entries are read one by one: the field, the type of an
entry, and the frame that is made of the valid ones."""
_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class ParsedText:
    """A text frame.

    Attributes:
        op: its kind, such as "advertise".
        content: its content; None for kinds that are not needed here.
        malformed: number of invalid entries that were left out.
    """

    op: str
    content: TextFrame | None
    malformed: int = 0


def parse_text(frame: str) -> ParsedText:
    """Read a text frame.

    Raises:
        Malformed: it is not JSON, has no `op` or not what belongs to it.
    """
    try:
        op = msgspec.json.decode(frame, type=_Op).op
        if op in _LISTS:
            field, kind, made = _LISTS[op]
            fields = msgspec.json.decode(frame, type=dict[str, msgspec.Raw])
            listed = fields.get(field, msgspec.Raw(b"[]"))
            raw = msgspec.json.decode(listed, type=tuple[msgspec.Raw, ...])
            good = _good(raw, kind)
            return ParsedText(op, made(good), len(raw) - len(good))
        whole = _WHOLE.get(op)
        return ParsedText(op, whole and msgspec.json.decode(frame, type=whole))
    except (msgspec.MsgspecError, RecursionError) as error:
        raise Malformed(str(error)) from error


def _good(raw: Iterable[msgspec.Raw], kind: type[_T]) -> tuple[_T, ...]:
    good: list[_T] = []
    for one in raw:
        with suppress(msgspec.MsgspecError, RecursionError):
            good.append(msgspec.json.decode(one, type=kind))
    return tuple(good)


def subscribe(subscription_id: int, channel_id: int) -> str:
    """Ask for the messages of a channel."""
    pair = {"id": subscription_id, "channelId": channel_id}
    return _text("subscribe", subscriptions=[pair])


def unsubscribe(subscription_id: int) -> str:
    """End a subscription."""
    return _text("unsubscribe", subscriptionIds=[subscription_id])


def fetch_asset(uri: str, request_id: int) -> str:
    """Ask for a file."""
    return _text("fetchAsset", uri=uri, requestId=request_id)


def get_parameters(names: Sequence[str], request_id: str) -> str:
    """Ask for parameters by name."""
    return _text("getParameters", parameterNames=list(names), id=request_id)


def subscribe_connection_graph() -> str:
    """Ask to be told who publishes what."""
    return _text("subscribeConnectionGraph")


def advertise(channel_id: int, topic: str, type_name: str) -> str:
    """Begin to publish a topic, whose messages are CDR."""
    channel = {"id": channel_id, "topic": topic, "encoding": "cdr"}
    return _text("advertise", channels=[{**channel, "schemaName": type_name}])


def unadvertise(channel_id: int) -> str:
    """Publish a topic no longer."""
    return _text("unadvertise", channelIds=[channel_id])


def published(channel_id: int, message: bytes) -> bytes:
    """Publish a message of a topic that was advertised."""
    return _PUBLISHED_HEAD.pack(_MESSAGE, channel_id) + message


def call_service(service_id: int, call_id: int, request: bytes) -> bytes:
    """Call a service with a request in CDR."""
    encoding = b"cdr"
    head = _SERVICE_HEAD.pack(_CALL, service_id, call_id, len(encoding))
    return head + encoding + request


def _text(op: str, **content: object) -> str:
    return json.dumps({"op": op, **content}, separators=(",", ":"))
