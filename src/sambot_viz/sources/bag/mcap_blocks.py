"""The blocks of an MCAP file: its chunks, and messages that stand outside of them."""

from __future__ import annotations

import zlib
from array import array
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from sambot_viz import limits
from sambot_viz.sources.bag.blocks import Block, Entries, sorted_entries
from sambot_viz.sources.bag.compression import (
    BrokenPieceError,
    TooLargeError,
    decompress,
)
from sambot_viz.sources.bag.damage import Damage
from sambot_viz.sources.bag.file_bytes import FileBytes
from sambot_viz.sources.bag.mcap_records import CHUNK, HEAD, read_chunk

_ABOUT_CHUNK = 2**16
"""What compression may add to that which cannot be compressed [bytes]."""
CHUNK_HEAD_SIZE = 64
"""Length of the fields before the records of a chunk [bytes]."""


@dataclass(slots=True, eq=False)
class ChunkBlock(Block):
    """A chunk.

    Attributes:
        at: offset of its record in the file [bytes].
        length: length of the whole record [bytes].
        index_length: length of the message indexes after it [bytes].
        is_counted: whether its messages were counted without reading it.
    """

    at: int
    length: int
    index_length: int
    is_counted: bool = False

    def content(self, file: FileBytes) -> tuple[bytes | memoryview, bool]:
        """Its records, decompressed; and whether the record's own length is a lie.

        Raises:
            TooLargeError: it is above the limit of chunks.
            BrokenPieceError: it is not all there, or something else.
        """
        if self.length > limits.CHUNK.value + _ABOUT_CHUNK:
            raise TooLargeError(self.length)
        content = file.read_at(self.at, self.length)
        if len(content) < self.length or self.length < HEAD.size:
            raise BrokenPieceError("the file ends before it")
        opcode, length = HEAD.unpack_from(content)
        if opcode != CHUNK:
            raise BrokenPieceError("there is no chunk")
        inner = memoryview(content)[HEAD.size :]
        head = read_chunk(bytes(inner[:CHUNK_HEAD_SIZE]))
        stored = inner[head.at : head.at + head.size]
        if len(stored) != head.size:
            raise BrokenPieceError("it is shorter than it claims")
        raw = decompress(head.compression, stored, head.raw_size)
        if head.crc and zlib.crc32(raw) != head.crc:
            raise BrokenPieceError("its checksum is wrong")
        # The index was right about where it ends.
        return raw, length + HEAD.size != self.length


@dataclass(slots=True, eq=False)
class LooseBlock(Block):
    """Some thousand messages that stand outside of chunks.

    Attributes:
        entries: where they are.
    """

    entries: Entries


@dataclass(slots=True)
class MetChunk:
    """A chunk whose message indexes, which follow it, are being read."""

    at: int
    length: int
    start: int
    end: int
    counts: Counter[int] = field(default_factory=Counter[int])
    index_length: int = 0


class LooseMessages:
    """Collects messages outside of chunks: 18 bytes for each."""

    def __init__(self) -> None:
        self.channels = array("H")
        self.times = array("Q")
        self.places = array("Q")
        self.large: list[tuple[int, int, int]] = []

    def add(self, channel: int, time: int, place: int, size: int) -> None:
        """Take a message, unless it is too large.

        Args:
            channel: its channel.
            time: its log time [ns].
            place: where its record begins.
            size: of its payload [bytes].
        """
        if size > limits.MESSAGE.value:
            self.large.append((channel, time, size))
            return
        self.channels.append(channel)
        self.times.append(time)
        self.places.append(place)

    def entries(self, damage: Damage | None, raw: bytes | memoryview | None) -> Entries:
        """Return them by log time; tell their order in the file."""
        times = np.array(self.times, np.uint64)
        channels = np.array(self.channels, np.uint16)
        places = np.array(self.places, np.int64)
        if damage is not None:
            damage.add_times(times, channels)
        return sorted_entries(times, channels, places, raw, self.large)
