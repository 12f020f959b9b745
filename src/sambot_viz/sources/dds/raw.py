"""Messages as bytes in and out of cyclonedds: the one place with its private names.

Its public way makes a Python object of each message, a list with a number for each byte
of a cloud: a thousand times slower than to hand on what came.
"""

from __future__ import annotations

import types
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib import import_module
from typing import Any

VERSION = "11.0.1"
"""The names here are private: they are those of this version."""

_HEAD = 4
"""The bytes of CDR before the fields."""


@cache
def _private() -> Any:
    return import_module("cyclonedds._clayer")


@lru_cache(maxsize=1024)
def wire_type(name: str) -> Any:
    """Return a type with the name of one on the wire, such as std_msgs::msg::dds_::….

    Its fields are never used: whoever has the messages knows what they are.
    """
    from cyclonedds.idl import IdlStruct
    from cyclonedds.idl.types import uint8

    fields: dict[str, Any] = {"__annotations__": {"opaque": uint8}}
    # The metaclass takes the name of the type beside the bases.
    made: Any = types.new_class(
        "Opaque", (IdlStruct,), {"typename": name}, fields.update
    )
    return dataclass(made)


def take(reader: Any, most: int) -> list[tuple[bytes, Any]]:
    """Take received messages: each as CDR with its header, and its sample info.

    The padding of CDR to a multiple of four bytes is still at the end; see `unfilled`.

    Args:
        reader: a reader of cyclonedds.
        most: the largest number to take.
    """
    from cyclonedds.core import InstanceState, SampleState, ViewState

    mask = SampleState.Any | ViewState.Any | InstanceState.Any
    taken: Any = _private().ddspy_take(reader._ref, mask, most)
    # A number is an error: the reader is being taken away.
    if isinstance(taken, int):
        return []
    return [(content, info) for content, info in taken if info.valid_data]


def write(writer: Any, message: bytes) -> bool:
    """Publish CDR with its header; return whether it was taken."""
    filling = -len(message) % 4
    head = message[: _HEAD - 1] + bytes([filling])
    whole = head + message[_HEAD:] + bytes(filling)
    return _private().ddspy_write(writer._ref, whole) >= 0


def unfilled(content: bytes) -> bytes:
    """Return CDR without what only fills it up at its end, as its head says."""
    filling = content[_HEAD - 1] & 3 if len(content) >= _HEAD else 0
    if not filling:
        return content
    return content[: _HEAD - 1] + b"\0" + content[_HEAD:-filling]
