"""The registry of types: a decoder for each channel, and never an error for a bag."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from threading import Lock

from sambot_viz.errors import DecodeError
from sambot_viz.messages.decoder import (
    Decoder,
    FieldDecoder,
    definition_wrong,
)
from sambot_viz.messages.definition import TypeDefinition, UnreadFieldError, closed
from sambot_viz.messages.definition_text import LANGUAGES, canonical_name, parse
from sambot_viz.messages.flatbuffer import FlatBufferDecoder
from sambot_viz.messages.known_types import KnownTypes
from sambot_viz.messages.plain_fields import PLAIN_ENCODINGS, PlainFieldsDecoder
from sambot_viz.messages.protobuf import ProtobufDecoder
from sambot_viz.messages.reason import Reason
from sambot_viz.messages.schema import Schema
from sambot_viz.messages.shape import MessageShape

_BY_FIELDS = ("cdr", "ros1")
_BY_SCHEMA = {"protobuf": ProtobufDecoder, "flatbuffer": FlatBufferDecoder}
"""Encodings with their own definitions."""


class MessageTypes:
    """Makes decoders, one for all channels with the same definition and encoding.

    Types without a definition are ROS's own, or found in folders: those given, then
    those of AMENT_PREFIX_PATH.

    Args:
        msg_path: folders of packages, packages, workspaces or installations with .msg
            files.
        distro: the ROS distribution whose types come first, such as "humble"; None:
            that of ROS_DISTRO.
    """

    def __init__(
        self, msg_path: Sequence[Path] = (), distro: str | None = None
    ) -> None:
        prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
        folders = [*msg_path, *(Path(prefix) for prefix in prefixes if prefix)]
        self._known = KnownTypes(folders, distro or os.environ.get("ROS_DISTRO"))
        self._decoders: dict[tuple[Schema, str], Decoder] = {}
        self._shapes: dict[tuple[str, str], MessageShape] = {}
        # Players of several sessions ask at the same time.
        self._lock = Lock()

    def decoder(self, schema: Schema, message_encoding: str) -> Decoder:
        """Return the decoder of a channel; what cannot be read has its reason."""
        key = schema, message_encoding
        with self._lock:
            if (known := self._decoders.get(key)) is None:
                known = self._decoders[key] = self._made(schema, message_encoding)
        return known

    def shape(self, name: str, text: str = "") -> MessageShape:
        """Return a type of ROS that is filled with fields of any encoding.

        Args:
            name: of the type.
            text: its definition, as a .msg file has it; "" for a type that is known.

        Raises:
            DecodeError: its definition is not known.
        """
        key = name, text
        with self._lock:
            if (known := self._shapes.get(key)) is None:
                known = self._shapes[key] = MessageShape(self._definition(name, text))
        return known

    def _definition(self, name: str, text: str) -> TypeDefinition:
        def find(one: str):
            return self._known.find(one, "cdr")

        if text:
            return parse(name, "ros2msg", text, find)
        definitions = self._known.definitions(name, "cdr")
        return definitions[0] if definitions else closed(name, {}, find)

    def _made(self, schema: Schema, encoding: str) -> Decoder:
        name = canonical_name(schema.name)
        if encoding in PLAIN_ENCODINGS:
            return PlainFieldsDecoder(name, encoding)
        if encoding in _BY_SCHEMA:
            try:
                return _BY_SCHEMA[encoding](schema)
            except Exception as error:
                # The library's errors are of several kinds, by what is broken.
                known = isinstance(error, DecodeError)
                cause = str(error) if known else f"its {encoding} schema is damaged"
                return Decoder(name, encoding, Reason("encoding", cause))
        if encoding not in _BY_FIELDS:
            return Decoder(name, encoding, _not_read(encoding))
        try:
            return self._by_fields(name, schema, encoding)
        except UnreadFieldError as error:
            return Decoder(name, encoding, Reason("encoding", str(error)))
        except Exception as error:
            # One type must never cost the others, and rosbags' errors are its own.
            cause = str(error) if isinstance(error, DecodeError) else repr(error)
            code = "type-unknown"
            if schema.encoding and schema.encoding not in LANGUAGES:
                code = "encoding"
                cause = f"its definition is {schema.encoding}, which is not read yet"
            remedy = "give the folder of its package with --msg-path"
            return Decoder(name, encoding, Reason(code, f"{cause}: {remedy}"))

    def _by_fields(self, name: str, schema: Schema, encoding: str) -> Decoder:
        def find(one: str):
            return self._known.find(one, encoding)

        def others():
            return self._known.definitions(name, encoding)

        if schema.encoding not in LANGUAGES:
            if known := others():
                return FieldDecoder(name, encoding, known)
            closed(name, {}, find)  # raises: it says which type is missing
        try:
            own = parse(name, schema.encoding, schema.text, find)
        except DecodeError as error:
            if not (known := others()):
                raise
            decoder = FieldDecoder(name, encoding, known)
            decoder.note = definition_wrong(f"is broken ({error})", name)
            return decoder
        return FieldDecoder(name, encoding, [own], others)


def _not_read(encoding: str) -> Reason:
    named = f"encoding is {encoding}" if encoding else "channel has no encoding"
    return Reason("encoding", f"its {named}, which is not known here")
