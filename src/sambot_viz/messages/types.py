"""The registry of types: a decoder for each channel, and never an error for a bag."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from threading import Lock

from sambot_viz.errors import DecodeError
from sambot_viz.messages.decoder import Decoder, FieldDecoder, JsonDecoder
from sambot_viz.messages.definition import (
    LANGUAGES,
    Types,
    canonical_name,
    closed,
    parse,
    standard_types,
)
from sambot_viz.messages.reason import Reason
from sambot_viz.messages.schema import Schema

_DISTROS = ("ros2_humble", "ros2_lyrical")


class MessageTypes:
    """Makes decoders, one for all channels with the same definition and encoding.

    Args:
        msg_path: folders with .msg files, for types without a definition.
        distro: the ROS distribution whose types come first, such as "humble".
    """

    def __init__(
        self, msg_path: Sequence[Path] = (), distro: str | None = None
    ) -> None:
        self._msg_path = tuple(msg_path)
        self._distros = tuple(
            dict.fromkeys(([f"ros2_{distro}"] if distro else []) + list(_DISTROS))
        )
        self._decoders: dict[tuple[Schema, str], Decoder] = {}
        # Players of several sessions ask at the same time.
        self._lock = Lock()

    def decoder(self, schema: Schema, message_encoding: str) -> Decoder:
        """Return the decoder of a channel; what cannot be read has its reason."""
        key = schema, message_encoding
        with self._lock:
            if (known := self._decoders.get(key)) is None:
                known = self._decoders[key] = self._made(schema, message_encoding)
        return known

    def _made(self, schema: Schema, encoding: str) -> Decoder:
        name = canonical_name(schema.name)
        if encoding == "json":
            return JsonDecoder(name, encoding)
        if encoding not in ("cdr", "ros1"):
            text = f"the encoding {encoding or 'of the messages'} cannot be read here"
            return Decoder(name, encoding, Reason("encoding", text))
        try:
            if schema.encoding in LANGUAGES:
                made = parse(name, schema.encoding, schema.text, self._find)
            else:
                made = closed(name, {}, self._find)
        except DecodeError as error:
            return Decoder(name, encoding, Reason("type-unknown", str(error)))
        return FieldDecoder(name, encoding, [made])

    def _find(self, name: str) -> Types | None:
        for distro in self._distros:
            if name in (types := standard_types(distro)):
                return {name: types[name]}
        return None
