"""Recordings of rosbag2 in an sqlite3 file, of all versions.

Nothing is ever written beside the file: a file with messages in a -wal file, which
sqlite3 would merge into it, and a truncated one are copied to a temporary folder. The
rows are found once, without their data: 18 bytes are kept for each.
"""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from sambot_viz import limits
from sambot_viz.messages import Schema
from sambot_viz.sources.bag.block_bag import BlockBag
from sambot_viz.sources.bag.blocks import (
    Block,
    Entries,
    Numbers,
    Places,
    Times,
    sorted_entries,
)
from sambot_viz.sources.bag.db3_file import Database, open_database
from sambot_viz.sources.bag.file_bytes import FileBytes
from sambot_viz.sources.bag.latched import is_latched
from sambot_viz.sources.bag.refusals import not_a_bag, refused
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.sources.qos import parse_qos

_ROWS = 4096
_COST = 25
"""Work of a row: its page has to be read."""


@dataclass(slots=True, eq=False)
class RowBlock(Block):
    """Some thousand rows.

    Attributes:
        entries: their log times, topics and rowids.
    """

    entries: Entries


class Db3Bag(BlockBag):
    """A file of rosbag2 in sqlite3; see `Bag`."""

    def __init__(self, file: FileBytes) -> None:
        """Open the database.

        Raises:
            SourceError: it is not one of rosbag2, or is too damaged.
        """
        super().__init__(file)
        # One connection: a statement at a time.
        self._reading = threading.Lock()
        self._database: Database = open_database(file)
        try:
            self._read_topics()
        except sqlite3.Error as error:
            self._database.close()
            raise self._refusal(error) from error
        except BaseException:
            self._database.close()
            raise

    def _refusal(self, error: sqlite3.Error) -> Exception:
        path = self._file.path
        message = f"{path.name} is a damaged sqlite3 file: {error}"
        if self._database.lacks:
            message = f"{path.name} is cut off ({self._database.lacks})"
        hint = "copy the file again from where it was recorded"
        return refused(path, "file-sqlite-broken", message, hint)

    def _rows(self, query: str, *values: int) -> list[tuple[Any, ...]]:
        with self._reading:
            return self._database.connection.execute(query, values).fetchall()

    def _columns(self, table: str) -> set[str]:
        query = "select type from sqlite_master where name = '{}'"
        if self._rows(query.format(table)) != [("table",)]:
            return set()
        return {str(row[1]) for row in self._rows(f"pragma table_info({table})")}

    def _read_topics(self) -> None:
        columns = self._columns("topics")
        needed = {"topic_id", "timestamp", "data"}
        if not columns >= {"id", "name", "type"} or not (
            self._columns("messages") >= needed
        ):
            why = "it is an sqlite3 file, but not one of rosbag2"
            raise not_a_bag(self._file.path, why)
        definitions = self._read_definitions()
        encoding = _column("serialization_format", columns)
        qos = _column("offered_qos_profiles", columns)
        query = f"select id, name, type, {encoding}, {qos} from topics order by id"
        for row in self._rows(f"{query} limit {limits.CHANNELS.value + 1}"):
            number, name, kind, how, offered = row
            if isinstance(number, int) and isinstance(name, str):
                offers = parse_qos(offered) if isinstance(offered, str) else None
                schema = _definition(str(kind), definitions)
                latched = is_latched(name, schema.name, offers)
                channel = TopicChannel(name, schema, str(how), offers, latched)
                self._add_channel(number, channel)

    def _read_definitions(self) -> dict[str, Schema]:
        """Read the definitions by type; files before Iron have none."""
        wanted = {"topic_type", "encoding", "encoded_message_definition"}
        if not self._columns("message_definitions") >= wanted:
            return {}
        # A character above the limit is enough to see that it is.
        most, left = limits.DEFINITION.value + 1, limits.DEFINITIONS.value
        names = ("topic_type", "encoding", "encoded_message_definition")
        parts = ", ".join(f"substr({name}, 1, {most})" for name in names)
        query = f"select {parts} from message_definitions"
        found: dict[str, Schema] = {}
        with self._reading:
            for row in self._database.connection.execute(query):
                kind, encoding, definition = map(str, row)
                left -= len(kind) + len(definition)
                if left < 0:
                    break
                found[kind] = Schema(kind, encoding, definition)
        return found

    # --- finding --------------------------------------------------------------------

    def _find(self) -> Iterator[int]:
        # For these sqlite3 reads the head of a row and none of its data.
        size = "case typeof(data) when 'blob' then length(data) else 0 end"
        # A truncated file has rows whose data are gone.
        most, data = limits.MESSAGE.value, ""
        if self._database.lacks:
            data = f", case when {size} <= {most} then data end"
        query = (
            f"select rowid, topic_id, timestamp, {size}{data} from messages "
            f"where rowid > ? order by rowid limit {64 if data else _ROWS}"
        )
        last, found = -(2**63), 0
        while True:
            rows, is_broken = self._some_rows(query, last)
            self._add_rows(rows)
            found += len(rows)
            reached = rows[-1][0] if rows else last
            if is_broken or not isinstance(reached, int) or reached <= last:
                break
            last = reached
            yield len(rows) * _COST
        self._say_how_it_ends(found, is_broken)

    def _some_rows(self, query: str, last: int) -> tuple[list[tuple[Any, ...]], bool]:
        """Return the next rows; those before the first that is damaged."""
        rows: list[tuple[Any, ...]] = []
        with self._reading:
            try:
                # Keeps the rows before the first unreadable one.
                for row in self._database.connection.execute(query, (last,)):
                    rows.append(row[:4])
            except sqlite3.ProgrammingError as error:
                raise ValueError("the file was closed") from error
            except sqlite3.Error:
                return rows, True
        return rows, False

    def _add_rows(self, rows: list[tuple[Any, ...]]) -> None:
        table = _numbers(rows)
        known = (table[:, 2] >= 0) & np.isin(table[:, 1], list(self._channels))
        is_large = table[:, 3] > limits.MESSAGE.value
        large = table[known & is_large][:, 1:].tolist()
        fitting = known & ~is_large
        places, channels = table[fitting, 0], table[fitting, 1]
        times: Times = table[fitting, 2].astype(np.uint64)
        entries = sorted_entries(times, channels, places, None, large)
        self._note_large(None, entries)
        if not fitting.any():
            return
        self.damage.add_times(times, channels)
        start, end = int(entries.times[0]), int(entries.times[-1])
        found = frozenset(np.unique(channels).tolist())
        block = RowBlock(self._number(), start, end, found, entries)
        self._add_block(block, entries)

    def _say_how_it_ends(self, found: int, is_broken: bool) -> None:
        if self._database.lacks or is_broken:
            self.damage.end = "sqlite"
            self.damage.lacks = self._database.lacks
        elif self._database.has_wal:
            if not (self._file.path.parent / "metadata.yaml").exists():
                self.damage.end = "unfinished"
                self.damage.in_wal = found

    # --- reading --------------------------------------------------------------------

    def _read(self, block: Block) -> Entries:
        assert isinstance(block, RowBlock)
        return block.entries

    def _message(self, entries: Entries, number: int) -> Recorded | None:
        channel = self._channels.get(int(entries.channels[number]))
        row = int(entries.places[number])
        try:
            found = self._rows("select data from messages where rowid = ?", row)
        except sqlite3.ProgrammingError as error:
            raise ValueError("the file was closed") from error
        except sqlite3.Error:
            found = []
        if channel is None or not found or not isinstance(found[0][0], bytes):
            return None
        time = int(entries.times[number])
        return Recorded(channel.topic, channel, time, None, found[0][0])

    def close(self) -> None:
        """Close the database, and remove its copy."""
        super().close()
        with self._reading:
            self._database.close()


def _numbers(rows: list[tuple[Any, ...]]) -> Places:
    """Return the columns of rows, (N, 4), without rows of other values."""
    table: Numbers = np.array(rows)
    if table.dtype != np.int64:
        whole = [row for row in rows if all(isinstance(one, int) for one in row)]
        table = np.reshape(np.array(whole, np.int64), (len(whole), 4))
    return table


def _definition(kind: str, definitions: dict[str, Schema]) -> Schema:
    """Return the definition of a type; that of an event is its service's."""
    if (known := definitions.get(kind)) is not None:
        return known
    service = definitions.get(kind.removesuffix("_Event"), Schema(kind))
    return Schema(kind, service.encoding, service.text)


def _column(name: str, columns: set[str]) -> str:
    return name if name in columns else "''"
