"""Requests and answers of the services for parameters."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from live_peers import LivePeer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbridge_peer import RosbridgePeer

TYPES = {
    "set": "rcl_interfaces/Parameter[] parameters",
    "was_set": "rcl_interfaces/SetParametersResult[] results",
    "values": "rcl_interfaces/ParameterValue[] values",
}


@cache
def _store() -> Any:
    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in TYPES.items():
        store.register(get_types_from_msg(text, f"test/msg/{name}"))
    return store


def message(name: str, **fields: object) -> Any:
    return _store().types[f"rcl_interfaces/msg/{name}"](**fields)


def value(kind: int, **given: object) -> Any:
    empty: dict[str, object] = {
        "bool_value": False,
        "integer_value": 0,
        "double_value": 0.0,
        "string_value": "",
    }
    arrays = {"byte": "u1", "bool": "?", "integer": "i8", "double": "f8"}
    empty |= {f"{one}_array_value": np.zeros(0, arrays[one]) for one in arrays}
    empty["string_array_value"] = []
    return message("ParameterValue", type=kind, **{**empty, **given})


def reply(peer: LivePeer, name: str, field: str, made: list[Any], plain: Any) -> Any:
    """An answer as the peer gives it: CDR, or fields."""
    if isinstance(peer, RosbridgePeer):
        return {field: plain}
    kind = f"test/msg/{name}"
    return bytes(_store().serialize_cdr(_store().types[kind](made), kind))


def read(content: bytes, name: str) -> Any:
    """The fields of a request or an answer in CDR."""
    return _store().deserialize_cdr(content, f"test/msg/{name}")
