"""Parameters of the nodes of a robot, read and set by their services."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from sambot_viz.messages import MessageTypes
from sambot_viz.publishing.services import (
    GET_PARAMETERS,
    SET_PARAMETERS,
    ServiceAnswer,
    call_service,
)
from sambot_viz.sources.source import Source
from sambot_viz.text import text

_FIELDS = ("", "bool_value", "integer_value", "double_value", "string_value")
"""Where a value is in a rcl_interfaces/ParameterValue, by its type."""
_KINDS: dict[type, int] = {bool: 1, int: 2, float: 3, str: 4}
Value = bool | int | float | str


def get_parameters(
    source: Source,
    node: str,
    names: Sequence[str],
    types: MessageTypes,
    told: Callable[[Sequence[Value | None], str], object],
) -> None:
    """Read parameters of a node.

    Args:
        source: the robot.
        node: its full name.
        names: of the parameters.
        types: has the definitions of the messages.
        told: called with a value for each name, None where it is not set or of another
            kind, and with why nothing is known; in the thread of the source, or at
            once.
    """

    def answered(answer: ServiceAnswer) -> None:
        values = () if answer.content is None else answer.content.values
        found = [_value(one) for one in values[: len(names)]]
        told([*found, *[None] * (len(names) - len(found))], answer.refusal)

    service, fields = f"{node}/get_parameters", {"names": [*names]}
    call_service(source, service, GET_PARAMETERS, fields, types, answered)


def set_parameter(
    source: Source,
    node: str,
    name: str,
    value: Value,
    types: MessageTypes,
    told: Callable[[str], object],
) -> None:
    """Set a parameter of a node.

    Args:
        source: the robot.
        node: its full name.
        name: of the parameter.
        value: what it gets.
        types: has the definitions of the messages.
        told: called with why it was not set, "" for success; in the thread of the
            source, or at once.
    """

    def answered(answer: ServiceAnswer) -> None:
        if answer.content is None:
            told(answer.refusal)
            return
        results = answer.content.results
        if not len(results):
            told("the node does not say whether it has set it")
        elif results[0].successful:
            told("")
        else:
            told(text(str(results[0].reason), 400) or "the node refuses it")

    kind = _KINDS[type(value)]
    given = {"name": name, "value": {"type": kind, _FIELDS[kind]: value}}
    service, fields = f"{node}/set_parameters", {"parameters": [given]}
    call_service(source, service, SET_PARAMETERS, fields, types, answered)


def _value(value: Any) -> Value | None:
    kind = int(value.type)
    return getattr(value, _FIELDS[kind]) if 0 < kind < len(_FIELDS) else None
