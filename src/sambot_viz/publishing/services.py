"""Calls of services whose fields are known, over any transport."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from sambot_viz.errors import DecodeError, SourceError
from sambot_viz.messages import MessageTypes, Schema
from sambot_viz.sources.source import Encoding, Reply, Source
from sambot_viz.text import text


@dataclass(frozen=True, slots=True)
class ServiceType:
    """A type of services.

    Attributes:
        name: the name, without the suffix of the request and the response.
        request: the fields of the request, as in a .srv file.
        response: the fields of the response.
        older: the response of an older version; "" without one.
    """

    name: str
    request: str
    response: str
    older: str = ""


CANCEL_GOAL = ServiceType(
    "action_msgs/CancelGoal",
    "action_msgs/GoalInfo goal_info",
    "int8 return_code\naction_msgs/GoalInfo[] goals_canceling",
)
GET_PARAMETERS = ServiceType(
    "rcl_interfaces/GetParameters",
    "string[] names",
    "rcl_interfaces/ParameterValue[] values",
)
SET_PARAMETERS = ServiceType(
    "rcl_interfaces/SetParameters",
    "rcl_interfaces/Parameter[] parameters",
    "rcl_interfaces/SetParametersResult[] results",
)


_RESULT = f"""\
int8 status
nav2_msgs/NavigateToPose_Result result
{"=" * 80}
MSG: nav2_msgs/NavigateToPose_Result
uint16 error_code
"""
GET_RESULT = ServiceType(
    "nav2_msgs/NavigateToPose_GetResult",
    "unique_identifier_msgs/UUID goal_id",
    f"{_RESULT}string error_msg",
    _RESULT,
)


@dataclass(frozen=True, slots=True)
class ServiceAnswer:
    """The answer of a service.

    Attributes:
        content: the response, an object with its fields; None without one.
        refusal: why there is none.
    """

    content: Any = None
    refusal: str = ""


def call_service(
    source: Source,
    service: str,
    kind: ServiceType,
    fields: Mapping[str, Any],
    types: MessageTypes,
    answered: Callable[[ServiceAnswer], object],
) -> None:
    """Call a service once.

    Args:
        source: the robot.
        service: its name.
        kind: its type.
        fields: of the request.
        types: has the definitions that the type names.
        answered: called once, in the thread of the source or at once; it must only
            post.
    """

    def write(encoding: Encoding) -> bytes:
        if encoding == "json":
            return json.dumps(fields, allow_nan=False).encode()
        return types.shape(f"{kind.name}_Request", kind.request).as_cdr(fields)

    def take(reply: Reply) -> None:
        answered(read_reply(reply, kind, types))

    try:
        source.call(service, write, take)
    except SourceError as error:
        answered(ServiceAnswer(refusal=str(error)))


def read_reply(reply: Reply, kind: ServiceType, types: MessageTypes) -> ServiceAnswer:
    """Return the response in a reply, or why there is none."""
    if reply.refusal:
        return ServiceAnswer(refusal=reply.refusal)
    for response in filter(None, (kind.response, kind.older)):
        content: Any = None
        with suppress(DecodeError, TypeError, ValueError):
            content = _read(reply, f"{kind.name}_Response", response, types)
        if content is not None:
            return ServiceAnswer(content)
    said = text(repr(bytes(reply.content[:80])), 80)
    return ServiceAnswer(refusal=f"what it answers makes no sense: {said}")


def _read(reply: Reply, name: str, response: str, types: MessageTypes) -> Any:
    if reply.is_json:
        return types.shape(name, response).filled(json.loads(reply.content))
    schema = Schema(name, "ros2msg", response)
    return types.decoder(schema, "cdr").decode(reply.content)
