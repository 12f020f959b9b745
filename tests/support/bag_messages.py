"""The messages of recordings, read by other programs than ours."""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

from sambot_viz.messages import Schema

Message = tuple[str, Schema, str, bytes]
"""Topic, schema, the messages' encoding, payload."""


def messages_of(path: Path) -> Iterator[Message]:
    """Yield what can be read of a file; a damaged one ends early."""
    if path.is_dir():
        for file in sorted(path.iterdir()):
            if file.suffix in (".mcap", ".db3"):
                yield from messages_of(file)
    elif path.suffix == ".mcap":
        yield from _of_mcap(path)
    elif path.suffix == ".db3":
        yield from _of_sqlite(path)
    elif path.suffix == ".bag":
        yield from _of_ros1(path)


def _of_mcap(path: Path) -> Iterator[Message]:
    from mcap.exceptions import McapError
    from mcap.records import Channel, Message
    from mcap.records import Schema as Definition
    from mcap.stream_reader import StreamReader

    schemas: dict[int, Schema] = {0: Schema("")}
    channels: dict[int, Channel] = {}
    with path.open("rb") as stream:
        try:
            for record in StreamReader(stream, record_size_limit=1 << 24).records:
                if isinstance(record, Definition):
                    text = record.data
                    text = text if b"\0" in text else text.decode("utf-8", "replace")
                    schemas[record.id] = Schema(record.name, record.encoding, text)
                elif isinstance(record, Channel):
                    channels[record.id] = record
                elif isinstance(record, Message):
                    channel = channels[record.channel_id]
                    schema = schemas[channel.schema_id]
                    yield channel.topic, schema, channel.message_encoding, record.data
        except (McapError, ValueError, RuntimeError, struct.error):
            return


def _of_sqlite(path: Path) -> Iterator[Message]:
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as base:
        try:
            tables = {
                name for (name,) in base.execute("select name from sqlite_master")
            }
            texts = {}
            if "message_definitions" in tables:
                found = base.execute(
                    "select topic_type, encoding, encoded_message_definition "
                    "from message_definitions"
                )
                texts = {name: Schema(name, how, text) for name, how, text in found}
            topics = {
                number: (name, texts.get(kind, Schema(kind)), encoding)
                for number, name, kind, encoding in base.execute(
                    "select id, name, type, serialization_format from topics"
                )
            }
            for number, data in base.execute("select topic_id, data from messages"):
                yield (*topics[number], data)
        except sqlite3.DatabaseError:
            return


def _of_ros1(path: Path) -> Iterator[Message]:
    from rosbags.rosbag1 import Reader
    from rosbags.rosbag1.reader import ReaderError

    try:
        with Reader(path) as reader:
            for connection, _, data in reader.messages():
                text = connection.msgdef.data
                schema = Schema(connection.msgtype, "ros1msg", text)
                yield connection.topic, schema, "ros1", data
    except ReaderError:
        return
