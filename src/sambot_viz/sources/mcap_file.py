"""A recording as it is written: one MCAP file of messages as bytes."""

from __future__ import annotations

import json
from collections import Counter
from typing import TYPE_CHECKING, BinaryIO

from sambot_viz import limits
from sambot_viz._version import __version__
from sambot_viz.messages import Schema
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.sources.qos import Qos, profile_text

if TYPE_CHECKING:
    from mcap.records import McapRecord

_LAST_TIME = 2**64
_LATCHED = Qos("reliable", "transient_local", "keep_last", 1, True)


class McapFile:
    """Writes messages as `ros2 bag record` does: chunks of zstd, an index at the end.

    Args:
        stream: where to write, from its beginning; it is not closed.

    Attributes:
        definitions: the schemas and channels so far.
        flushed: how much is in the file for sure, in whole chunks [bytes].
    """

    def __init__(self, stream: BinaryIO) -> None:
        # It takes 0.07 s to import, and only recordings need it.
        from mcap.writer import Writer

        self.definitions: list[McapRecord] = []
        self.flushed = 0
        self._stream = stream
        self._writer = Writer(stream)
        self._writer.start("ros2", f"sambot-viz {__version__}")
        self._schemas: dict[Schema, int] = {}
        # A peer that comes back has new channel objects, with the same content.
        self._by_content: dict[tuple[object, ...], int] = {}
        self._channels: dict[TopicChannel, int] = {}
        self._sequences = Counter[int]()

    def write(self, message: Recorded, log_ns: int) -> bool:
        """Add a message to the present chunk.

        Args:
            message: what to write.
            log_ns: its log time [ns], which may be later than its own.

        Returns:
            False for a message that the format has no place for.

        Raises:
            OSError: the disk takes no more.
        """
        publish_ns = (
            message.log_ns if message.publish_ns is None else message.publish_ns
        )
        if not (0 <= log_ns < _LAST_TIME and 0 <= publish_ns < _LAST_TIME):
            return False
        channel = self._channels.get(message.channel)
        if channel is None:
            channel = self._add_channel(message.channel)
        if not channel:
            return False
        self._sequences[channel] += 1
        self._writer.add_message(
            channel,
            log_ns,
            bytes(message.payload),
            publish_ns,
            self._sequences[channel],
        )
        return True

    def flush(self) -> None:
        """End the chunk, so that what was written so far can be read.

        Raises:
            OSError: the disk takes no more.
        """
        self._writer.flush()
        self.flushed = self._stream.tell()

    def finish(self) -> None:
        """Write the index.

        Raises:
            OSError: the disk takes no more.
        """
        self._writer.finish()

    def _add_channel(self, channel: TopicChannel) -> int:
        """Return the number of a channel; 0 when there are too many."""
        qos = channel.qos or (_LATCHED if channel.is_latched else None)
        encoding = channel.message_encoding
        content = channel.topic, channel.schema, encoding, qos
        number = self._by_content.get(content)
        if number is None:
            number = 0
            if len(self._by_content) < limits.RECORDING_CHANNELS.value:
                number = self._register(
                    _plain(channel.topic),
                    _plain(encoding),
                    self._add_schema(channel.schema, encoding),
                    {"offered_qos_profiles": profile_text(qos) if qos else ""},
                )
            self._by_content[content] = number
        if len(self._channels) >= 2 * limits.RECORDING_CHANNELS.value:
            self._channels.clear()
        self._channels[channel] = number
        return number

    def _register(
        self, topic: str, encoding: str, schema: int, metadata: dict[str, str]
    ) -> int:
        from mcap.records import Channel

        number = self._writer.register_channel(topic, encoding, schema, metadata)
        self.definitions.append(Channel(number, topic, encoding, metadata, schema))
        return number

    def _add_schema(self, schema: Schema, message_encoding: str) -> int:
        if not (schema.name or schema.text):
            return 0
        if message_encoding == "json" and schema.encoding != "jsonschema":
            # Of rosbridge: the format wants a schema of JSON for messages in JSON.
            told = json.dumps({"title": schema.name, "type": "object"})
            schema = Schema(schema.name, "jsonschema", told)
        number = self._schemas.get(schema)
        if number is None:
            from mcap.records import Schema as SchemaRecord

            text = schema.text
            data = text.encode("utf-8", "replace") if isinstance(text, str) else text
            name, language = _plain(schema.name), _plain(schema.encoding)
            number = self._writer.register_schema(name, language, data)
            self.definitions.append(
                SchemaRecord(id=number, data=data, encoding=language, name=name)
            )
            self._schemas[schema] = number
        return number


def _plain(text: str) -> str:
    """Return a text that can be written as UTF-8."""
    return text.encode("utf-8", "replace").decode("utf-8")
