"""MCAP files of any profile, with an index or without.

The file is walked from record header to record header; where the index at its end knows
a chunk, the walk steps over it. So a file whose recorder was killed, whose index is
damaged or which never had one is read in the same way.
"""

from __future__ import annotations

import threading
import zlib
from collections import Counter
from collections.abc import Iterator, Mapping

import numpy as np

from sambot_viz import limits
from sambot_viz.messages import Schema
from sambot_viz.sources.bag.block_bag import NO_SCHEMA, BlockBag
from sambot_viz.sources.bag.blocks import Block, Entries
from sambot_viz.sources.bag.compression import BrokenPieceError
from sambot_viz.sources.bag.damage import SMALLEST_STEP_BACK
from sambot_viz.sources.bag.file_bytes import FileBytes, ReadAhead
from sambot_viz.sources.bag.mcap_blocks import (
    CHUNK_HEAD_SIZE,
    ChunkBlock,
    LooseBlock,
    LooseMessages,
    MetChunk,
)
from sambot_viz.sources.bag.mcap_definitions import channel_of, schema_of
from sambot_viz.sources.bag.mcap_records import (
    CHANNEL,
    CHUNK,
    CHUNK_INDEX,
    DATA_END,
    FOOTER_SIZE,
    HEAD,
    MAGIC,
    MESSAGE,
    MESSAGE_HEAD,
    MESSAGE_INDEX,
    SCHEMA,
    STATISTICS,
    ChunkIndexRecord,
    read_channel,
    read_chunk,
    read_chunk_index,
    read_footer,
    read_message_index,
    read_schema,
    read_statistics,
    records,
)
from sambot_viz.sources.bag.mcap_search import find_record, zeros_end
from sambot_viz.sources.message import Recorded, TopicChannel

SMALL = 8 * 2**20
"""A file up to this size is read through at opening, so that all damage is known."""

_LOOSE = 4096
_MESSAGE_SIZE = HEAD.size + MESSAGE_HEAD.size


class McapBag(BlockBag):
    """An MCAP file; see `Bag`."""

    def __init__(self, file: FileBytes) -> None:
        super().__init__(file)
        self._schemas: dict[int, Schema] = {}
        # Of records of schemas and channels that were taken: a summary repeats them.
        self._defined: set[int] = set()
        self._is_small = file.size <= SMALL
        self._latest = 0
        self._doubts = 0
        self._unsearched: list[Block] = []
        # The read-ahead of each thread that reads messages outside of chunks.
        self._ahead = threading.local()

    # --- finding --------------------------------------------------------------------

    def _find(self) -> Iterator[int]:
        file = self._file
        end, hints = file.size, dict[int, ChunkIndexRecord]()
        try:
            size = FOOTER_SIZE + len(MAGIC)
            summary, crc = read_footer(file.read_at(file.size - size, size))
        except BrokenPieceError:
            self.damage.end = "unfinished"
        else:
            end -= size
            hints = self._read_summary(summary, crc, end)
            if hints:
                end = summary
        yield 1 + len(hints)
        yield from self._walk(end, hints)

    def _read_summary(self, at: int, crc: int, end: int) -> dict[int, ChunkIndexRecord]:
        """Read the channels of the summary, and where the chunks are.

        Returns:
            place → chunk; empty when not all of their channels are known.
        """
        if not len(MAGIC) <= at < end or end - at > limits.SUMMARY.value:
            return {}
        data = self._file.read_at(at, end - at + FOOTER_SIZE)
        if crc and zlib.crc32(data[: end - at + FOOTER_SIZE - 4]) != crc:
            return {}
        chunks: list[ChunkIndexRecord] = []
        counts: dict[int, int] | None = None
        try:
            for opcode, content in records(data[: end - at]):
                if opcode == CHUNK_INDEX:
                    chunks.append(read_chunk_index(content))
                elif opcode == STATISTICS:
                    counts = read_statistics(content)[1]
                else:
                    self._define(opcode, content, in_summary=True)
        except BrokenPieceError:
            return {}
        chunks.sort(key=lambda chunk: chunk.at)
        free = len(MAGIC)
        for chunk in chunks:
            behind = chunk.at + chunk.length + chunk.index_length
            fits = free <= chunk.at < behind <= at and chunk.start <= chunk.end
            if not fits or not chunk.channels or not self._knows(chunk.channels):
                return {}
            free = behind
        if chunks and not self._is_small:
            if counts is None:
                # The message indexes after the chunks contain the numbers.
                return {}
            self._stated = Counter(counts)
        return {chunk.at: chunk for chunk in chunks}

    def _walk(self, end: int, hints: Mapping[int, ChunkIndexRecord]) -> Iterator[int]:
        """Walk over the records, and add the chunks and messages found.

        Args:
            end: end of the records [bytes].
            hints: known chunks, by their places.
        """
        window = ReadAhead(self._file)
        loose = LooseMessages()
        chunk: MetChunk | None = None
        at, steps, is_behind_data = len(MAGIC), 0, False
        while at < end:
            steps += 1
            if len(loose.times) >= _LOOSE:
                self._add_loose(loose)
                loose = LooseMessages()
            if steps >= _LOOSE:
                yield steps
                steps = 0
            if (hint := hints.get(at)) is not None:
                yield self._add_hint(hint)
                at = hint.at + hint.length + hint.index_length
                continue
            data, begin = window.around(at, _MESSAGE_SIZE)
            opcode, length = HEAD.unpack_from(data, begin) if end - at >= 9 else (0, 0)
            behind = at + HEAD.size + length
            if opcode == MESSAGE and length >= MESSAGE_HEAD.size and behind <= end:
                channel, _, time, _ = MESSAGE_HEAD.unpack_from(data, begin + HEAD.size)
                loose.add(channel, time, at, length - MESSAGE_HEAD.size)
                at = behind
                continue
            if opcode == MESSAGE_INDEX and chunk is not None and behind <= end:
                content = data[begin + HEAD.size : begin + HEAD.size + 6]
                if len(content) == 6:
                    number, count = read_message_index(content)
                    chunk.counts[number] += count
                    chunk.index_length = behind - chunk.at - chunk.length
                at = behind
                continue
            if chunk is not None:
                yield self._add_chunk(chunk)
                chunk = None
            is_sound = opcode != 0 and behind <= end
            if is_sound and opcode == CHUNK:
                chunk = self._chunk_at(window, at, length)
                is_sound = chunk is not None
            elif is_sound and opcode in (SCHEMA, CHANNEL):
                is_sound = self._define_at(window, at, opcode, length)
            is_behind_data = is_behind_data or (is_sound and opcode == DATA_END)
            if is_sound:
                at = behind
                continue
            if is_behind_data or self._is_cut(window, at, opcode, length, end):
                break
            found: int | None = None
            try:
                for place in find_record(self._file, at, end):
                    found = place
                    yield 1000
            except BrokenPieceError as why:
                self.damage.end = "whole"
                self.damage.add_unreadable(at, end, str(why))
                break
            if found is None:
                self._note_end(at, end)
                break
            self.damage.add_unreadable(at, found)
            at = found
        self._add_loose(loose)
        if chunk is not None:
            yield self._add_chunk(chunk)
        yield steps

    def _is_cut(
        self, window: ReadAhead, at: int, opcode: int, length: int, end: int
    ) -> bool:
        """Return whether the walk must end in a record that is not all there."""
        if opcode != CHUNK or at + HEAD.size + length <= end:
            return False
        try:
            head = read_chunk(window.get(at + HEAD.size, CHUNK_HEAD_SIZE))
        except BrokenPieceError:
            return False
        # All its lengths say the same: it is a chunk of which the rest is missing.
        if head.at + head.size == length:
            self._note_end(at, end)
            return True
        return False

    def _note_end(self, at: int, end: int) -> None:
        if self.damage.end == "whole":
            self.damage.add_unreadable(at, end)
            return
        zeros = zeros_end(self._file, at, end)
        self.damage.end = "zeros" if zeros == end else "cut"
        self.damage.end_at = at

    def _chunk_at(self, window: ReadAhead, at: int, length: int) -> MetChunk | None:
        try:
            head = read_chunk(window.get(at + HEAD.size, min(length, CHUNK_HEAD_SIZE)))
        except BrokenPieceError:
            return None
        return MetChunk(at, HEAD.size + length, head.start, head.end)

    def _define_at(self, window: ReadAhead, at: int, opcode: int, length: int) -> bool:
        if length > limits.DEFINITION_RECORD.value:
            self.left_out.add_record(at, length)
            return True
        try:
            self._define(opcode, window.get(at + HEAD.size, length))
        except BrokenPieceError:
            return False
        return True

    def _define(self, opcode: int, content: bytes, *, in_summary: bool = False) -> None:
        """Take a schema or a channel; the same ones may come again."""
        record = hash((opcode, content))
        if record in self._defined:
            return
        if opcode == SCHEMA:
            schema = read_schema(content)
            if schema.id and schema.id not in self._schemas:
                self._schemas[schema.id] = schema_of(schema)
            self._defined.add(record)
        elif opcode == CHANNEL:
            channel = read_channel(content)
            # A summary may have channels without their schemas: the data have both.
            has_schema = not channel.schema or channel.schema in self._schemas
            if channel.id not in self._channels and (has_schema or not in_summary):
                schema = self._schemas.get(channel.schema, NO_SCHEMA)
                self._add_channel(channel.id, channel_of(channel, schema))
            if channel.id in self._channels:
                self._defined.add(record)

    def _add_loose(self, loose: LooseMessages) -> None:
        entries = loose.entries(self.damage, None)
        self._note_large(None, entries)
        if loose.times:
            found = frozenset(np.unique(entries.channels).tolist())
            first, last = int(entries.times[0]), int(entries.times[-1])
            block = LooseBlock(self._number(), first, last, found, entries)
            self._add_block(block, entries)

    def _add_hint(self, hint: ChunkIndexRecord) -> int:
        """Add a chunk that the index knows, and return how much work it was."""
        block = ChunkBlock(
            self._number(),
            hint.start,
            hint.end,
            hint.channels,
            hint.at,
            hint.length,
            hint.index_length,
            self._stated is not None,
        )
        return self._add_chunk_block(block, self._is_small)

    def _add_chunk(self, chunk: MetChunk) -> int:
        """Add a chunk that the walk has met, and return how much work it was."""
        block = ChunkBlock(
            self._number(),
            chunk.start,
            chunk.end,
            frozenset(chunk.counts),
            chunk.at,
            chunk.length,
            chunk.index_length,
        )
        known = chunk.counts and self._knows(chunk.counts)
        must_read = self._is_small or not known
        if not must_read:
            block.is_counted = True
            self._count(chunk.counts)
        return self._add_chunk_block(block, must_read)

    def _add_chunk_block(self, block: ChunkBlock, must_read: bool) -> int:
        if not must_read:
            cost = 1
            if self._latest - block.start >= SMALLEST_STEP_BACK and self._doubts < 4:
                # Its times may go back; those of its channels say it.
                self._doubts += 1
                self._read_or_none(block)
                cost = 1000
            self._latest = max(self._latest, block.end)
            self._unsearched.append(block)
            self._add_block(block, None)
            return cost
        entries, cost = self._read_or_none(block), 0
        if entries is None:
            return 1000
        if len(entries.times):
            block.start, block.end = int(entries.times[0]), int(entries.times[-1])
            block.channels = frozenset(np.unique(entries.channels).tolist())
            cost = self._search_definitions(block.channels)
            self._add_block(block, entries)
        return cost + len(entries.times) + entries.size // 1000

    def _search_definitions(self, channels: frozenset[int]) -> int:
        """Read chunks that were stepped over until some channels are known.

        A writer may define a channel long before its first message.
        """
        cost = 0
        while self._unsearched and not self._knows(channels):
            entries = self._read_or_none(self._unsearched.pop())
            cost += 1 if entries is None else entries.size // 1000
        return cost

    # --- reading --------------------------------------------------------------------

    def _read(self, block: Block) -> Entries:
        if isinstance(block, LooseBlock):
            return block.entries
        assert isinstance(block, ChunkBlock)
        raw, lies = block.content(self._file)
        self.damage.lies += lies
        return self._entries_in(raw)

    def _entries_in(self, raw: bytes | memoryview) -> Entries:
        """Walk through the records of a chunk."""
        loose, at, end = LooseMessages(), 0, len(raw)
        while at < end:
            if end - at < HEAD.size:
                raise BrokenPieceError("it ends in a record")
            opcode, length = HEAD.unpack_from(raw, at)
            behind = at + HEAD.size + length
            if behind > end:
                raise BrokenPieceError("it ends in a record")
            if opcode == MESSAGE:
                if length < MESSAGE_HEAD.size:
                    raise BrokenPieceError("a message has no times")
                channel, _, time, _ = MESSAGE_HEAD.unpack_from(raw, at + HEAD.size)
                loose.add(channel, time, at, length - MESSAGE_HEAD.size)
            elif opcode in (SCHEMA, CHANNEL):
                self._define(opcode, bytes(raw[at + HEAD.size : behind]))
            elif opcode == 0:
                raise BrokenPieceError("it has no records")
            at = behind
        return loose.entries(self.damage if self._is_finding else None, raw)

    def _message(self, entries: Entries, number: int) -> Recorded | None:
        channel = self._channels.get(int(entries.channels[number]))
        if channel is None:
            return None
        at, raw = int(entries.places[number]), entries.raw
        if raw is not None:
            _, length = HEAD.unpack_from(raw, at)
            _, _, log, publish = MESSAGE_HEAD.unpack_from(raw, at + HEAD.size)
            payload = memoryview(raw)[at + _MESSAGE_SIZE : at + HEAD.size + length]
            if len(payload) < len(raw) // 4:
                # A part that is kept would keep all of its chunk.
                payload = bytes(payload)
            return Recorded(channel.topic, channel, log, publish, payload)
        return self._loose_message(channel, at)

    def _loose_message(self, channel: TopicChannel, at: int) -> Recorded | None:
        window: ReadAhead | None = getattr(self._ahead, "window", None)
        if window is None:
            window = self._ahead.window = ReadAhead(self._file)
        head = window.get(at, _MESSAGE_SIZE)
        if len(head) < _MESSAGE_SIZE:
            return None
        _, length = HEAD.unpack_from(head)
        _, _, log, publish = MESSAGE_HEAD.unpack_from(head, HEAD.size)
        size = length - MESSAGE_HEAD.size
        payload = window.get(at + _MESSAGE_SIZE, size)
        if len(payload) < size:
            return None
        return Recorded(channel.topic, channel, log, publish, payload)

    def _place_of(self, block: Block) -> int:
        return block.at if isinstance(block, ChunkBlock) else 0

    def _counts_of(self, block: Block) -> Mapping[int, int]:
        counts = Counter[int]()
        if isinstance(block, ChunkBlock) and block.is_counted:
            at = block.at + block.length
            data = self._file.read_at(at, min(block.index_length, limits.SUMMARY.value))
            try:
                for opcode, content in records(data):
                    if opcode == MESSAGE_INDEX:
                        channel, count = read_message_index(content[:6])
                        counts[channel] += count
            except BrokenPieceError:
                pass
        return counts
