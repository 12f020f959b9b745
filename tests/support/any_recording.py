"""The same messages as a recording of any format, whatever is in them."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

FORMATS = ("mcap", "mcap without chunks", "db3", "bag")
STRING = "std_msgs/msg/String"
TEXT = "string data\n"
DB3_TABLES = """
create table topics (id integer primary key, name text, type text,
  serialization_format text, offered_qos_profiles text);
create table messages (id integer primary key, topic_id integer, timestamp integer,
  data blob);
create table message_definitions (id integer primary key, topic_type text,
  encoding text, encoded_message_definition text, type_description_hash);
"""
"""The tables of a recording that is a database."""


@dataclass(frozen=True, slots=True)
class Given:
    """A topic, its type and definition, and the bytes of its messages."""

    topic: str
    payloads: Sequence[bytes] = ()
    type_name: str = STRING
    definition: str = TEXT


def write_any(folder: Path, kind: str, given: Iterable[Given], start: int = 0) -> Path:
    """Write a recording.

    Args:
        folder: where.
        kind: one of `FORMATS`.
        given: the topics; the first messages of all of them come first, a millisecond
            after each other, then the second ones.
        start: the time before the first of them [ns].
    """
    topics = list(given)
    rounds = max((len(one.payloads) for one in topics), default=0)
    messages = [
        (number, one.payloads[turn])
        for turn in range(rounds)
        for number, one in enumerate(topics)
        if turn < len(one.payloads)
    ]
    timed = [(n, start + 10**6 * (i + 1), data) for i, (n, data) in enumerate(messages)]
    path = folder / f"made.{kind.split()[0]}"
    write = {"mcap": _mcap, "db3": _db3, "bag": _bag}.get(kind, _loose_mcap)
    write(path, topics, timed)
    return path


_Timed = Sequence[tuple[int, int, bytes]]


def _mcap(path: Path, topics: Sequence[Given], timed: _Timed, chunks: int = 1) -> None:
    from mcap.writer import Writer

    with path.open("wb") as stream:
        # A few messages in each chunk.
        writer = Writer(stream, chunk_size=2000, use_chunking=bool(chunks))
        writer.start("ros2", "tests")
        channels: list[int] = []
        for one in topics:
            text = one.definition.encode()
            schema = writer.register_schema(one.type_name, "ros2msg", text)
            channels.append(writer.register_channel(one.topic, "cdr", schema))
        for number, time, data in timed:
            writer.add_message(channels[number], time, data, time)
        writer.finish()


def _loose_mcap(path: Path, topics: Sequence[Given], timed: _Timed) -> None:
    _mcap(path, topics, timed, 0)


def _db3(path: Path, topics: Sequence[Given], timed: _Timed) -> None:
    with closing(sqlite3.connect(path)) as base, base:
        base.executescript(DB3_TABLES)
        for number, one in enumerate(topics):
            row = (number, one.topic, one.type_name, "cdr", "")
            base.execute("insert into topics values (?, ?, ?, ?, ?)", row)
            base.execute(
                "insert into message_definitions values (null, ?, 'ros2msg', ?, '')",
                (one.type_name, one.definition),
            )
        base.executemany("insert into messages values (null, ?, ?, ?)", timed)


def _bag(path: Path, topics: Sequence[Given], timed: _Timed) -> None:
    from rosbags.rosbag1 import Writer

    with Writer(path) as writer:
        writer.chunk_threshold = 2000
        channels = [
            writer.add_connection(
                one.topic, one.type_name, msgdef=one.definition, md5sum="0" * 32
            )
            for one in topics
        ]
        for number, time, data in timed:
            # Messages of ROS 1 have no head that says the order of the bytes.
            writer.write(channels[number], time, data[4:])
