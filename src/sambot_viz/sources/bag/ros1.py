"""Bags of ROS 1 (format 2.0), also those that are cut off.

A record is a header and data, each with its length in front (u32); a header is a list
of ``name=value``, each with its length in front. Messages are in chunks. The index at
the end says where these are; without it the file is walked from record to record.
"""

from __future__ import annotations

import struct
from array import array
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from sambot_viz import limits
from sambot_viz.messages import Schema
from sambot_viz.sources.bag.block_bag import BlockBag
from sambot_viz.sources.bag.blocks import Block, Entries, sorted_entries
from sambot_viz.sources.bag.compression import (
    BrokenPieceError,
    TooLargeError,
    decompress,
)
from sambot_viz.sources.bag.file_bytes import FileBytes, ReadAhead
from sambot_viz.sources.bag.latched import is_latched
from sambot_viz.sources.message import Recorded, TopicChannel

MAGIC = b"#ROSBAG V2.0\n"

SMALL = 8 * 2**20
"""A file up to this size is read through at opening, so that all damage is known."""

_BAG, _CHUNK, _CHUNK_INFO, _CONNECTION = 3, 5, 6, 7
_U32 = struct.Struct("<I")
_U64 = struct.Struct("<Q")
_TIME = struct.Struct("<II")
_PAIR = struct.Struct("<II")
_STEP = 2**20

_Header = dict[bytes, bytes]


class _LongHeaderError(BrokenPieceError):
    """The header of a record is there, and longer than any is."""


@dataclass(slots=True, eq=False)
class Ros1Block(Block):
    """A chunk.

    Attributes:
        at: where its record begins in the file [bytes].
        counts: messages of each channel, as far as they were counted without reading.
    """

    at: int
    counts: Counter[int] = field(default_factory=Counter[int])


@dataclass(slots=True)
class _Record:
    """A record: its kind, its header, and where its data are."""

    op: int
    header: _Header
    at: int
    size: int

    @property
    def behind(self) -> int:
        return self.at + self.size


class Ros1Bag(BlockBag):
    """A ROS 1 bag; see `Bag`."""

    def __init__(self, file: FileBytes) -> None:
        super().__init__(file)
        self._is_small = file.size <= SMALL

    # --- finding --------------------------------------------------------------------

    def _find(self) -> Iterator[int]:
        ahead = ReadAhead(self._file)
        try:
            blocks = self._read_index(ahead)
        except BrokenPieceError:
            self.damage.end = "reindex"
            yield from self._walk(ahead)
            return
        for block in blocks:
            yield self._add(block)

    def _read_index(self, ahead: ReadAhead) -> list[Ros1Block]:
        """Read the connections and where the chunks are from the end of the file."""
        head = self._record(ahead, len(MAGIC))
        if head.op != _BAG:
            raise BrokenPieceError("there is no header of the bag")
        at = _number(head.header, b"index_pos", _U64)
        expected = _number(head.header, b"chunk_count", _U32)
        if not head.behind <= at <= self._file.size:
            raise BrokenPieceError("there is no index")
        blocks: list[Ros1Block] = []
        while at < self._file.size:
            record = self._record(ahead, at)
            if record.op == _CONNECTION:
                self._connect(ahead, record)
            elif record.op == _CHUNK_INFO:
                blocks.append(self._block(ahead, record))
            at = record.behind
        if len(blocks) != expected or not all(self._knows(b.channels) for b in blocks):
            raise BrokenPieceError("the index does not name all")
        return sorted(blocks, key=lambda block: block.at)

    def _block(self, ahead: ReadAhead, record: _Record) -> Ros1Block:
        header = record.header
        data = ahead.get(record.at, min(record.size, limits.DEFINITION_RECORD.value))
        counts = Counter[int]()
        for channel, count in _PAIR.iter_unpack(data[: len(data) // 8 * 8]):
            counts[channel] += count
        start, end = _time(header, b"start_time"), _time(header, b"end_time")
        if start > end and counts:
            raise BrokenPieceError("a chunk ends before it begins")
        at = _number(header, b"chunk_pos", _U64)
        return Ros1Block(self._number(), start, end, frozenset(counts), at, counts)

    def _walk(self, ahead: ReadAhead) -> Iterator[int]:
        """Go from record to record and add the chunks."""
        at = len(MAGIC)
        while at < self._file.size:
            try:
                record = self._record(ahead, at)
                if record.op == _CONNECTION:
                    self._connect(ahead, record)
            except BrokenPieceError as error:
                found = self._next_chunk(at)
                why = f"{error}" if isinstance(error, _LongHeaderError) else ""
                if why:
                    self.damage.add_unreadable(at, found or self._file.size, why)
                if found is None:
                    break
                if not why:
                    self.damage.add_unreadable(at, found)
                at = found
                continue
            if record.op == _CHUNK:
                # When it begins and ends stands only in the index that is missing.
                block = Ros1Block(self._number(), 0, 0, frozenset(), at)
                yield self._add(block, must_read=True)
            at = record.behind
            yield 1

    def _next_chunk(self, at: int) -> int | None:
        """Search for the next chunk after damaged bytes."""
        begin, ahead = at + 1, ReadAhead(self._file)
        word = b"compression="
        while begin < self._file.size:
            data = self._file.read_at(begin, _STEP + len(word))
            found = data.find(word)
            while found >= 0:
                place = begin + found - 8
                try:
                    if place > at and self._record(ahead, place).op == _CHUNK:
                        return place
                except BrokenPieceError:
                    pass
                found = data.find(word, found + 1)
            begin += _STEP
        return None

    def _add(self, block: Ros1Block, *, must_read: bool = False) -> int:
        """Add a chunk, and return how much work it was."""
        if not must_read and not self._is_small:
            self._count(block.counts)
            self._add_block(block, None)
            return 1
        block.counts.clear()
        entries = self._read_or_none(block)
        if entries is None:
            return 1000
        if len(entries.times):
            block.start, block.end = int(entries.times[0]), int(entries.times[-1])
            block.channels = frozenset(np.unique(entries.channels).tolist())
            self._add_block(block, entries)
        return len(entries.times) + entries.size // 1000

    def _connect(self, ahead: ReadAhead, record: _Record) -> None:
        # Of one that is too large the topic is known, and that its type is not.
        is_large = record.size > limits.DEFINITION_RECORD.value
        if is_large and _number(record.header, b"conn", _U32) not in self._channels:
            self.left_out.add_record(record.at, record.size)
        data = b"" if is_large else ahead.get(record.at, record.size)
        self._define(record.header, data)

    def _define(self, header: _Header, data: bytes) -> None:
        """Take a connection; the same ones come again."""
        number = _number(header, b"conn", _U32)
        if number in self._channels:
            return
        about = _header(data)
        topic = _text(header.get(b"topic") or about.get(b"topic", b""))
        schema = Schema(
            _text(about.get(b"type", b"")),
            "ros1msg",
            _text(about.get(b"message_definition", b"")),
        )
        latching = _text(about.get(b"latching", b""))
        latched = is_latched(topic, schema.name, None, latching)
        channel = TopicChannel(topic, schema, "ros1", None, latched)
        self._add_channel(number, channel)

    # --- reading --------------------------------------------------------------------

    def _record(self, ahead: ReadAhead, at: int) -> _Record:
        """Read the header of a record, and see where its data are."""
        length = ahead.get(at, 4)
        if len(length) < 4:
            raise BrokenPieceError("the file ends")
        (size,) = _U32.unpack(length)
        if limits.BAG_HEADER.value < size <= self._file.size - at:
            said = limits.BAG_HEADER.said(size)
            raise _LongHeaderError(f"a header has {said}")
        if size > limits.BAG_HEADER.value:
            raise BrokenPieceError("the file ends")
        data = ahead.get(at + 4, size + 4)
        if len(data) < size + 4:
            raise BrokenPieceError("the file ends")
        header = _header(data[:size])
        (count,) = _U32.unpack_from(data, size)
        begin = at + 4 + size + 4
        if begin + count > self._file.size:
            raise BrokenPieceError("the file ends")
        return _Record(header.get(b"op", b"\0")[0], header, begin, count)

    def _read(self, block: Block) -> Entries:
        assert isinstance(block, Ros1Block)
        record = self._record(ReadAhead(self._file), block.at)
        if record.op != _CHUNK:
            raise BrokenPieceError("there is no chunk")
        size = _number(record.header, b"size", _U32)
        if max(size, record.size) > limits.CHUNK.value:
            raise TooLargeError(max(size, record.size))
        stored = self._file.read_at(record.at, record.size)
        name = _text(record.header.get(b"compression", b""))
        return self._entries_in(bytes(decompress(name, stored, size)))

    def _entries_in(self, raw: bytes) -> Entries:
        """Walk through the records of a chunk."""
        times, channels, places = array("Q"), array("L"), array("Q")
        large: list[tuple[int, int, int]] = []
        at, end = 0, len(raw)
        while at < end:
            if end - at < 8:
                raise BrokenPieceError("it ends in a record")
            begin = at + 4 + _U32.unpack_from(raw, at)[0]
            if begin + 4 > end:
                raise BrokenPieceError("it ends in a record")
            header = _header(raw[at + 4 : begin])
            behind = begin + 4 + _U32.unpack_from(raw, begin)[0]
            if behind > end:
                raise BrokenPieceError("it ends in a record")
            op = header.get(b"op")
            if op == b"\x02":
                channel, time = _number(header, b"conn", _U32), _time(header, b"time")
                size = behind - begin - 4
                if size > limits.MESSAGE.value:
                    large.append((channel, time, size))
                else:
                    channels.append(channel)
                    times.append(time)
                    places.append(begin)
            elif op == b"\x07":
                self._define(header, raw[begin + 4 : behind])
            at = behind
        found = np.array(times, np.uint64), np.array(channels, np.uint32)
        if self._is_finding:
            self.damage.add_times(*found)
        return sorted_entries(*found, np.array(places, np.int64), raw, large)

    def _message(self, entries: Entries, number: int) -> Recorded | None:
        channel = self._channels.get(int(entries.channels[number]))
        raw = entries.raw
        if channel is None or raw is None:
            return None
        at = int(entries.places[number])
        (size,) = _U32.unpack_from(raw, at)
        payload = memoryview(raw)[at + 4 : at + 4 + size]
        if len(payload) < len(raw) // 4:
            # A part that is kept would keep all of its chunk.
            payload = bytes(payload)
        time = int(entries.times[number])
        return Recorded(channel.topic, channel, time, None, payload)

    def _place_of(self, block: Block) -> int:
        return block.at if isinstance(block, Ros1Block) else 0

    def _counts_of(self, block: Block) -> Mapping[int, int]:
        return block.counts if isinstance(block, Ros1Block) else {}


def _header(data: bytes) -> _Header:
    """Take the fields of a header."""
    found: _Header = {}
    at, end = 0, len(data)
    while at < end:
        if end - at < 4:
            raise BrokenPieceError("a header is cut")
        begin = at + 4
        at = begin + _U32.unpack_from(data, at)[0]
        name, equals, value = data[begin:at].partition(b"=")
        if at > end or not equals:
            raise BrokenPieceError("a header makes no sense")
        found[name] = value
    if b"op" in found and len(found[b"op"]) != 1:
        raise BrokenPieceError("a record has no kind")
    return found


def _number(header: _Header, name: bytes, layout: struct.Struct) -> int:
    value = header.get(name, b"")
    if len(value) != layout.size:
        raise BrokenPieceError("a header lacks a number")
    return layout.unpack(value)[0]


def _time(header: _Header, name: bytes) -> int:
    value = header.get(name, b"")
    if len(value) != _TIME.size:
        raise BrokenPieceError("a header lacks a time")
    seconds, nanoseconds = _TIME.unpack(value)
    return seconds * 1_000_000_000 + nanoseconds


def _text(value: bytes) -> str:
    return value.decode("utf-8", "replace")
