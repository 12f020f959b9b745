"""Make a recording whole that a full disk has ended: whole chunks, and their index.

A file without an index opens here, and in few other programs. The index gets the room
of the chunk that was cut off; if that is not enough, the last whole chunks give theirs.
"""

from __future__ import annotations

import os
import zlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from io import FileIO
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.sources.bag.mcap_records import (
    CHUNK,
    HEAD,
    MAGIC,
    MESSAGE_INDEX,
    ChunkRecord,
    read_chunk,
    read_message_index,
)

if TYPE_CHECKING:
    from mcap.records import McapRecord

_CHUNK_HEAD = 64
"""More than a chunk has in front of its records [bytes]."""
_MOST_GIVEN_UP = 8
"""Maximum number of whole chunks dropped to make room for the index."""


@dataclass(slots=True)
class _WholeChunk:
    """A chunk with its message indexes.

    Attributes:
        at: where it begins.
        length: of its record.
        head: what it says of itself.
        end: where the last of its message indexes ends.
        indexes: where they are, by channel.
        counts: how many messages each channel has.
    """

    at: int
    length: int
    head: ChunkRecord
    end: int
    indexes: dict[int, int] = field(default_factory=dict[int, int])
    counts: Counter[int] = field(default_factory=Counter[int])


def finish_cut(path: Path, flushed: int, definitions: Sequence[McapRecord]) -> int:
    """Truncate a file after its last whole chunk, and write the index.

    Args:
        path: a file of `McapFile`, which may end anywhere.
        flushed: offset up to which it is known to be whole [bytes].
        definitions: its schemas and channels.

    Returns:
        The number of its messages. It gets no index if the space of its last eight
        chunks is not enough for one.

    Raises:
        OSError: the file cannot be read or truncated.
    """
    with FileIO(path, "r+") as stream:
        chunks = _whole_chunks(stream, flushed)
        for kept in (chunks[:count] for count in range(len(chunks), 0, -1)):
            if len(chunks) - len(kept) > _MOST_GIVEN_UP:
                break
            stream.truncate(kept[-1].end)
            stream.seek(kept[-1].end)
            try:
                _write(stream, _summary(kept, definitions))
                return sum(chunk.counts.total() for chunk in kept)
            except OSError:
                stream.truncate(kept[-1].end)
    left = chunks[: max(0, len(chunks) - _MOST_GIVEN_UP)]
    return sum(chunk.counts.total() for chunk in left)


def _write(stream: FileIO, data: bytes) -> None:
    rest = memoryview(data)
    while rest:
        # Without a buffer, a disk that becomes full takes a part.
        rest = rest[stream.write(rest) :]


def _whole_chunks(stream: FileIO, flushed: int) -> list[_WholeChunk]:
    found: list[_WholeChunk] = []
    at, size = len(MAGIC), os.fstat(stream.fileno()).st_size
    while at + HEAD.size <= size:
        stream.seek(at)
        data = stream.read(HEAD.size + _CHUNK_HEAD)
        opcode, length = HEAD.unpack_from(data)
        content, end = data[HEAD.size :], at + HEAD.size + length
        if opcode == CHUNK:
            # Its message indexes are known to be whole when another chunk begins.
            flushed = max(flushed, at)
        if end > size:
            break
        if opcode == CHUNK:
            found.append(_WholeChunk(at, end - at, read_chunk(content), end))
        elif opcode == MESSAGE_INDEX and found:
            channel, count = read_message_index(content)
            found[-1].indexes[channel] = at
            found[-1].counts[channel] += count
            found[-1].end = end
        at = end
    return [chunk for chunk in found if chunk.end <= flushed]


def _summary(chunks: Sequence[_WholeChunk], definitions: Sequence[McapRecord]) -> bytes:
    """Return the records after the last chunk."""
    from mcap.data_stream import RecordBuilder
    from mcap.records import Channel, ChunkIndex, DataEnd, Footer, Statistics

    begin, records = chunks[-1].end, RecordBuilder()
    DataEnd(0).write(records)
    data_end = records.end()
    for record in definitions:
        record.write(records)
    counts = sum((chunk.counts for chunk in chunks), Counter[int]())
    channels = sum(isinstance(record, Channel) for record in definitions)
    Statistics(
        attachment_count=0,
        channel_count=channels,
        channel_message_counts=dict(counts),
        chunk_count=len(chunks),
        message_count=counts.total(),
        message_end_time=max(chunk.head.end for chunk in chunks),
        message_start_time=min(chunk.head.start for chunk in chunks),
        metadata_count=0,
        schema_count=len(definitions) - channels,
    ).write(records)
    for chunk in chunks:
        ChunkIndex(
            chunk_length=chunk.length,
            chunk_start_offset=chunk.at,
            compression=chunk.head.compression,
            compressed_size=chunk.head.size,
            message_end_time=chunk.head.end,
            message_index_length=chunk.end - chunk.at - chunk.length,
            message_index_offsets=chunk.indexes,
            message_start_time=chunk.head.start,
            uncompressed_size=chunk.head.raw_size,
        ).write(records)
    summary, start = records.end(), begin + len(data_end)
    Footer(start, 0, 0).write(records)
    footer = records.end()
    crc = zlib.crc32(summary + footer[:-4]).to_bytes(4, "little")
    return data_end + summary + footer[:-4] + crc + MAGIC
