"""The operations of rosbridge's protocol, and what rosapi answers.

rosbridge 2.0 as rosbridge_suite speaks it, for ROS 2 and ROS 1. Messages come as
`cbor-raw`, which is the bytes that ROS itself sends; servers that do not know that
answer in JSON.
"""

from __future__ import annotations

import json
import re
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, TypeVar, cast

import msgspec

from sambot_viz.messages import Schema
from sambot_viz.messages.cbor import CborError, read_cbor

EACH_COUNTS = {
    "tf2_msgs/TFMessage",
    "tf/tfMessage",
    "sensor_msgs/JointState",
    "visualization_msgs/Marker",
    "visualization_msgs/MarkerArray",
    "visualization_msgs/InteractiveMarkerUpdate",
    "map_msgs/OccupancyGridUpdate",
}
"""Types of which one message does not replace the one before: several publishers share
a topic, or a message holds a change. Of all others only the newest is asked for."""

FEWEST_MS = 33
"""Shortest period of other messages [ms]: nothing is drawn more often."""
QUEUE = 100
"""The length of the server's queue for `EACH_COUNTS` and latched topics."""

TYPES_BY_NAME = {
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/robot_description": "std_msgs/msg/String",
    "/clock": "rosgraph_msgs/msg/Clock",
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/odom": "nav_msgs/msg/Odometry",
}
"""Topics whose types everybody knows, for a server without rosapi."""

_T = TypeVar("_T")
_IDL_NAMES = {
    "boolean": "bool",
    "double": "float64",
    "float": "float32",
    "octet": "byte",
}
_CBOR_TEXT = 0x60
_TOPIC_IN_JSON = re.compile(rb'"topic"\s*:\s*("(?:[^"\\]|\\.)*")')
_TOPIC_IN_CBOR = re.compile(rb"\x65topic(?:([\x60-\x77])|\x78(.)|\x79(..))", re.DOTALL)
_SEQUENCE = re.compile(r"sequence<\s*([\w/]+)\s*(?:,\s*(\d+)\s*)?>")


class MalformedOperation(ValueError):
    """A frame that makes no sense."""


@dataclass(frozen=True, slots=True)
class Publication:
    """A message of a topic.

    Attributes:
        topic: its name.
        payload: the bytes of ROS, or JSON.
        is_json: which of the two.
        stamp_ns: when the server got it [ns], None if it does not say so.
    """

    topic: str
    payload: bytes | memoryview
    is_json: bool
    stamp_ns: int | None = None


class ServiceResponse(msgspec.Struct):
    """The answer to a call; `values` is JSON, a text of the server when it failed."""

    id: str = ""
    result: bool = True
    values: msgspec.Raw = msgspec.Raw(b"null")


class StatusLine(msgspec.Struct):
    """A line of the server: level "error", "warning", "info" or "none".

    Some servers repeat the id of the operation that it is about.
    """

    level: str = ""
    msg: str = ""
    id: Any = ""


class ForeignOperation(msgspec.Struct):
    """An operation that a client that offers nothing does not need."""

    op: str = ""


class _Publish(msgspec.Struct):
    topic: str
    msg: msgspec.Raw


class TopicList(msgspec.Struct):
    """What `/rosapi/topics` and `/rosapi/topics_and_raw_types` answer."""

    topics: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    typedefs_full_text: tuple[str, ...] = ()


class PublisherList(msgspec.Struct):
    """What `/rosapi/publishers` answers."""

    publishers: tuple[str, ...] = ()


class SubscriberList(msgspec.Struct):
    """What `/rosapi/subscribers` answers."""

    subscribers: tuple[str, ...] = ()


class FieldList(msgspec.Struct):
    """A type as `/rosapi/message_details` describes it."""

    type: str = ""
    fieldnames: tuple[str, ...] = ()
    fieldtypes: tuple[str, ...] = ()
    fieldarraylen: tuple[int, ...] = ()


class MessageDetails(msgspec.Struct):
    """What `/rosapi/message_details` answers."""

    typedefs: tuple[FieldList, ...] = ()


class GoalFeedback(msgspec.Struct):
    """How far a goal is; `values` are the fields of the feedback."""

    id: Any = ""
    values: msgspec.Raw = msgspec.Raw(b"{}")


class GoalResult(msgspec.Struct):
    """The end of a goal: `values` is the result, or a text when it was not taken.

    Some servers say `result` of an end that is not the wanted one, with its status.
    """

    id: Any = ""
    action: str = ""
    values: msgspec.Raw = msgspec.Raw(b"{}")
    status: int = 0
    result: bool = True


Operation = (
    Publication
    | ServiceResponse
    | StatusLine
    | GoalFeedback
    | GoalResult
    | ForeignOperation
)
_OF_GOALS: dict[str, type[GoalFeedback | GoalResult]] = {
    "action_feedback": GoalFeedback,
    "action_result": GoalResult,
}
_PLAIN: dict[str, type[ServiceResponse | StatusLine | GoalFeedback | GoalResult]] = {
    "service_response": ServiceResponse,
    "status": StatusLine,
    **_OF_GOALS,
}
"""Operations that are read as they are."""


def topic_of(head: bytes) -> str:
    """Return the topic in the first bytes of a publication; "" when it is not there."""
    if (found := _TOPIC_IN_JSON.search(head)) is not None:
        with suppress(ValueError):
            return str(json.loads(found[1]))
    elif (found := _TOPIC_IN_CBOR.search(head)) is not None:
        short, one, two = found.groups()
        size = short[0] - _CBOR_TEXT if short else int.from_bytes(one or two, "big")
        return str(head[found.end() : found.end() + size], "utf-8", "replace")
    return ""


def parse_operation(frame: str | bytes) -> Operation:
    """Read a frame.

    Raises:
        MalformedOperation: it is neither JSON nor CBOR, or lacks what belongs to it.
    """
    try:
        return _from_cbor(frame) if isinstance(frame, bytes) else _from_text(frame)
    except (msgspec.MsgspecError, CborError, ValueError, RecursionError) as error:
        raise MalformedOperation(str(error)) from error


def _from_text(frame: str) -> Operation:
    try:
        op = msgspec.json.decode(frame, type=ForeignOperation).op
        if op == "publish":
            return _from_json(frame)
        kind = _PLAIN.get(op)
        return msgspec.json.decode(frame, type=kind) if kind else ForeignOperation(op)
    except msgspec.DecodeError:
        if "NaN" not in frame and "Infinity" not in frame:
            raise
        # Python writes these and reads them again; JSON does not have them.
        return _with_nan(json.loads(frame))


def _with_nan(operation: Any) -> Operation:
    if not isinstance(operation, dict):
        raise MalformedOperation("not an operation")
    found = cast("dict[str, Any]", operation)
    topic = found.get("topic")
    if kind := _OF_GOALS.get(str(found.get("op"))):
        # NaN is null in this encoding.
        return msgspec.json.decode(msgspec.json.encode(found), type=kind)
    if found.get("op") != "publish" or not isinstance(topic, str) or "msg" not in found:
        raise MalformedOperation("a number that JSON does not have")
    return Publication(topic, json.dumps(found["msg"]).encode(), True)


def _from_json(frame: str) -> Publication:
    published = msgspec.json.decode(frame, type=_Publish)
    return Publication(published.topic, bytes(published.msg), True)


def _from_cbor(frame: bytes) -> Publication | ForeignOperation:
    value = read_cbor(frame)
    if not isinstance(value, dict):
        raise MalformedOperation("not an operation")
    op, topic, message = value.get("op"), value.get("topic"), value.get("msg")
    if op != "publish":
        return ForeignOperation(str(op))
    if not isinstance(topic, str) or not isinstance(message, dict):
        raise MalformedOperation("a message without a topic or without content")
    content = message.get("bytes")
    if not isinstance(content, memoryview):
        raise MalformedOperation("a message without its bytes")
    seconds, rest = message.get("secs"), message.get("nsecs")
    stamp = None
    if isinstance(seconds, int) and isinstance(rest, int) and seconds > 0:
        stamp = seconds * 1_000_000_000 + rest
    return Publication(topic, content, False, stamp)


def decode_values(response: ServiceResponse | None, kind: type[_T]) -> _T:
    """Return the answer of a service; None without one.

    Raises:
        MalformedOperation: the service failed, or its answer is malformed.
    """
    if response is None:
        raise MalformedOperation("no answer")
    if not response.result:
        raise MalformedOperation(bytes(response.values).decode("utf-8", "replace"))
    try:
        return msgspec.json.decode(response.values, type=kind)
    except (msgspec.MsgspecError, RecursionError) as error:
        raise MalformedOperation(str(error)) from error


def plain_name(type_name: str) -> str:
    """Return a type's name as ROS 1 writes it: "sensor_msgs/JointState"."""
    return type_name.replace("/msg/", "/")


def is_ros2(type_name: str) -> bool:
    """Return whether a type's name is one of ROS 2."""
    return "/msg/" in type_name or is_of_action(type_name)


def is_of_action(type_name: str) -> bool:
    """Return whether a type is one that ROS makes of an action, as of its feedback."""
    return "/action/" in type_name


def encoding(type_name: str) -> str:
    """Return how messages of a type are written in `cbor-raw`; "" if unknown."""
    if not type_name:
        return ""
    return "cdr" if is_ros2(type_name) else "ros1"


def definition(type_name: str, words: str) -> Schema:
    """Return the schema for the full text of a definition, which may be empty."""
    encoding = "ros2msg" if is_ros2(type_name) else "ros1msg"
    return Schema(type_name, encoding if words.strip() else "", words)


def text_of_details(details: MessageDetails) -> str:
    """Return the definition that `/rosapi/message_details` describes in pieces."""
    parts: list[str] = []
    for number, one in enumerate(details.typedefs):
        # Constants are left out: no message holds them.
        head = f"{'=' * 80}\nMSG: {one.type}\n" if number else ""
        fields = zip(one.fieldtypes, one.fieldnames, one.fieldarraylen, strict=False)
        lines = [f"{_field_type(kind, size)} {name}" for kind, name, size in fields]
        parts.append(head + "\n".join(lines) + "\n")
    return "".join(parts)


def _field_type(kind: str, size: int) -> str:
    if found := _SEQUENCE.fullmatch(kind):
        kind, size = found[1], 0
    kind = _IDL_NAMES.get(kind, kind)
    if size < 0 or kind.endswith("]"):
        return kind
    return f"{kind}[{size}]" if size else f"{kind}[]"


def subscribe(
    subscription: str, topic: str, type_name: str, *, is_latched: bool
) -> str:
    """Ask for the messages of a topic; without a type the server finds it out."""
    each = is_latched or plain_name(type_name) in EACH_COUNTS
    return _text(
        "subscribe",
        id=subscription,
        topic=topic,
        # That of an action no server finds by its name, and some by the topic.
        **({} if not type_name or is_of_action(type_name) else {"type": type_name}),
        compression="cbor-raw",
        # The server must drop what we are too slow for, or its memory grows.
        queue_length=QUEUE if each else 1,
        throttle_rate=0 if each else FEWEST_MS,
    )


def unsubscribe(subscription: str, topic: str) -> str:
    """End a subscription."""
    return _text("unsubscribe", id=subscription, topic=topic)


def advertise(name: str, topic: str, type_name: str) -> str:
    """Begin to publish a topic, by the name that its messages have too."""
    return _text("advertise", id=name, topic=topic, type=type_name)


def unadvertise(name: str, topic: str) -> str:
    """Publish a topic no longer."""
    return _text("unadvertise", id=name, topic=topic)


def published(name: str, topic: str, message: bytes) -> str:
    """Publish a message, which is JSON already."""
    head = _text("publish", id=name, topic=topic)
    return f'{head[:-1]},"msg":{message.decode()}}}'


def call_service(call: str, service: str, **arguments: object) -> str:
    """Call a service of rosapi."""
    return _text("call_service", id=call, service=service, args=arguments)


def call_with(call: str, service: str, request: bytes) -> str:
    """Call a service with a request that is JSON already."""
    head = _text("call_service", id=call, service=service)
    return f'{head[:-1]},"args":{request.decode()}}}'


def send_goal(goal: str, action: str, type_name: str, fields: bytes) -> str:
    """Send a goal, whose fields are JSON already, and ask how far it is."""
    head = _text(
        "send_action_goal",
        id=goal,
        action=action,
        action_type=type_name,
        feedback=True,
    )
    return f'{head[:-1]},"args":{fields.decode()}}}'


def cancel_goal(goal: str, action: str) -> str:
    """Cancel a goal."""
    return _text("cancel_action_goal", id=goal, action=action)


def _text(op: str, **content: Any) -> str:
    return json.dumps({"op": op, **content}, separators=(",", ":"))
