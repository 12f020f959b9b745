"""Messages that say themselves how they are made: JSON, CBOR and MessagePack."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, cast

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.messages.cbor import CborTooDeep, read_cbor
from sambot_viz.messages.decoder import Decoder, Payload
from sambot_viz.messages.kept_elements import KeptElements


class PlainFieldsDecoder(Decoder):
    """Reads messages that are texts, numbers, lists and fields, whatever their type.

    Args:
        type_name: of the messages.
        encoding: one of `PLAIN_ENCODINGS`.
    """

    def decode(
        self, payload: Payload, kept: KeptElements | None = None
    ) -> dict[str, Any]:
        """Return the fields of a message."""
        name, read = PLAIN_ENCODINGS[self.encoding]
        try:
            found = read(within_limit(payload))
        except CborTooDeep as error:
            raise DecodeError(f"it is {name}, {error}") from None
        except (ValueError, RecursionError, MemoryError):
            # msgspec's errors are ValueErrors, as are those of json and ours.
            raise DecodeError(f"it is not {name}") from None
        if not isinstance(found, dict):
            raise DecodeError(f"it is {name}, but not an object with fields")
        return cast("dict[str, Any]", found)


def within_limit(payload: Payload) -> memoryview:
    """Return a view of the bytes of a message.

    Raises:
        DecodeError: there are more than are decoded.
    """
    limit = limits.FIELDS_MESSAGE
    if len(payload) > limit.value:
        raise DecodeError(f"it has {limit.said(len(payload))}")
    return memoryview(payload).toreadonly().cast("B")


def _json(data: memoryview) -> object:
    return json.loads(bytes(data))


def _msgpack(data: memoryview) -> object:
    from msgspec import msgpack

    return msgpack.decode(data)


PLAIN_ENCODINGS: Mapping[str, tuple[str, Callable[[memoryview], object]]] = {
    "json": ("JSON", _json),
    "cbor": ("CBOR", read_cbor),
    "msgpack": ("MessagePack", _msgpack),
}
"""What people call each encoding, and what reads it."""
