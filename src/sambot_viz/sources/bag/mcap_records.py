"""The records of an MCAP file, taken out of bytes that may be anything.

All numbers are little-endian; a string has its length in front (u32), a map its length
in bytes. A record is an opcode (u8), the length of its content (u64) and the content;
extra bytes at the end of a content are to be ignored. What does not fit its own bytes
raises `BrokenPieceError`.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sambot_viz.sources.bag.compression import BrokenPieceError

MAGIC = b"\x89MCAP0\r\n"
"""What every MCAP file begins and ends with."""

FOOTER = 0x02
SCHEMA = 0x03
CHANNEL = 0x04
MESSAGE = 0x05
CHUNK = 0x06
MESSAGE_INDEX = 0x07
CHUNK_INDEX = 0x08
STATISTICS = 0x0B
DATA_END = 0x0F

HEAD = struct.Struct("<BQ")
"""Before the content of each record: its opcode, the length of the content."""

MESSAGE_HEAD = struct.Struct("<HIQQ")
"""Before the payload of a message: channel, sequence, log time, publish time."""

FOOTER_SIZE = HEAD.size + 20
CHUNK_FIXED = 32
"""Where the name of the compression begins in a chunk [bytes]."""

_CHUNK = struct.Struct("<QQQII")
_INDEX = struct.Struct("<QQQQ")
_COMPRESSIONS = ("", "lz4", "zstd")
_PAIRS = np.dtype([("channel", "<u2"), ("at", "<u8")])
_COUNTS = np.dtype([("channel", "<u2"), ("count", "<u8")])


class Fields:
    """Takes the fields of one content one after the other."""

    def __init__(self, data: bytes | memoryview, at: int = 0) -> None:
        self._data = data
        self._at = at

    def take(self, layout: struct.Struct) -> tuple[int, ...]:
        """Return the numbers of a layout."""
        try:
            numbers = layout.unpack_from(self._data, self._at)
        except struct.error as error:
            raise BrokenPieceError("a record ends in the middle of a number") from error
        self._at += layout.size
        return numbers

    def bytes(self, count: int) -> bytes:
        """Return the next bytes."""
        if count > len(self._data) - self._at:
            raise BrokenPieceError("a record is shorter than it claims")
        self._at += count
        return bytes(self._data[self._at - count : self._at])

    def sized(self) -> bytes:
        """Return bytes with their length in front."""
        return self.bytes(self.take(_U32)[0])

    def text(self) -> str:
        """Return a string; bytes that are not UTF-8 are replaced."""
        return self.sized().decode("utf-8", "replace")

    def map(self) -> dict[str, str]:
        """Return a map from strings to strings."""
        inner = self.sized()
        fields, found = Fields(inner), dict[str, str]()
        while fields._at < len(inner):
            name = fields.text()
            found[name] = fields.text()
        return found


_U16 = struct.Struct("<H")
_U32 = struct.Struct("<I")
_U64 = struct.Struct("<Q")
_TWO_IDS = struct.Struct("<HH")
_FOOTER = struct.Struct("<QQI")
_STATISTICS = struct.Struct("<QHIIIIQQ")


class SchemaRecord(NamedTuple):
    """A definition of messages: its number, name, encoding and text."""

    id: int
    name: str
    encoding: str
    data: bytes


class ChannelRecord(NamedTuple):
    """A channel; its schema has the number 0 when there is none."""

    id: int
    schema: int
    topic: str
    encoding: str
    metadata: dict[str, str]


@dataclass(frozen=True, slots=True)
class ChunkRecord:
    """The fields before the records of a chunk.

    Attributes:
        start: log time of the first message [ns].
        end: log time of the last message [ns].
        raw_size: length of its records once decompressed [bytes].
        crc: checksum of them, or 0.
        compression: "", "lz4" or "zstd".
        at: offset of its records from the start of the content [bytes].
        size: length of its records in the file, compressed [bytes].
    """

    start: int
    end: int
    raw_size: int
    crc: int
    compression: str
    at: int
    size: int


@dataclass(frozen=True, slots=True)
class ChunkIndexRecord:
    """Where a chunk is, and which channels have messages in it.

    Attributes:
        start: log time of the first message [ns].
        end: log time of the last message [ns].
        at: offset of the chunk's record in the file [bytes].
        length: length of the whole record, with its opcode [bytes].
        channels: the channels whose message indexes it locates; empty without any.
        index_length: length of the message indexes after it [bytes].
    """

    start: int
    end: int
    at: int
    length: int
    channels: frozenset[int]
    index_length: int


def read_schema(content: bytes) -> SchemaRecord:
    """Read the content of a schema record."""
    fields = Fields(content)
    (number,) = fields.take(_U16)
    return SchemaRecord(number, fields.text(), fields.text(), fields.sized())


def read_channel(content: bytes) -> ChannelRecord:
    """Read the content of a channel record."""
    fields = Fields(content)
    number, schema = fields.take(_TWO_IDS)
    topic, encoding = fields.text(), fields.text()
    return ChannelRecord(number, schema, topic, encoding, fields.map())


def read_chunk(content: bytes) -> ChunkRecord:
    """Read the fields before the records of a chunk."""
    fields = Fields(content)
    start, end, raw, crc, _ = fields.take(_CHUNK)
    compression = Fields(content, CHUNK_FIXED - 4).text()
    if compression not in _COMPRESSIONS:
        raise BrokenPieceError("its compression is not known")
    at = CHUNK_FIXED + len(compression)
    (size,) = Fields(content, at).take(_U64)
    if start > end:
        raise BrokenPieceError("it ends before it begins")
    return ChunkRecord(start, end, raw, crc, compression, at + 8, size)


def read_message_index(content: bytes) -> tuple[int, int]:
    """Read of which channel a message index is, and how many messages it names."""
    fields = Fields(content)
    (channel,) = fields.take(_U16)
    (length,) = fields.take(_U32)
    return channel, length // 16


def read_chunk_index(content: bytes) -> ChunkIndexRecord:
    """Read the content of a chunk index record."""
    fields = Fields(content)
    start, end, at, length = fields.take(_INDEX)
    pairs = np.frombuffer(_whole(fields.sized(), _PAIRS), _PAIRS)
    (index_length,) = fields.take(_U64)
    channels = frozenset(map(int, pairs["channel"]))
    return ChunkIndexRecord(start, end, at, length, channels, index_length)


def read_statistics(content: bytes) -> tuple[int, dict[int, int]]:
    """Read how many messages there are, and how many of each channel."""
    fields = Fields(content)
    total = fields.take(_STATISTICS)[0]
    counts = np.frombuffer(_whole(fields.sized(), _COUNTS), _COUNTS)
    return total, dict(counts.tolist())


def read_footer(data: bytes) -> tuple[int, int]:
    """Read where the summary begins (0: there is none) and its checksum (0: none).

    Args:
        data: the last bytes of the file, the footer and the magic.
    """
    if len(data) < FOOTER_SIZE + len(MAGIC) or not data.endswith(MAGIC):
        raise BrokenPieceError("the file does not end as an MCAP file")
    at = len(data) - FOOTER_SIZE - len(MAGIC)
    opcode, length = HEAD.unpack_from(data, at)
    if opcode != FOOTER or length != 20:
        raise BrokenPieceError("the file has no footer")
    summary, _, crc = _FOOTER.unpack_from(data, at + HEAD.size)
    return summary, crc


def records(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield opcode and content of records that follow each other."""
    at = 0
    while at < len(data):
        if len(data) - at < HEAD.size:
            raise BrokenPieceError("the last record is cut")
        opcode, length = HEAD.unpack_from(data, at)
        at += HEAD.size
        if length > len(data) - at:
            raise BrokenPieceError("a record is longer than what it is in")
        yield opcode, data[at : at + length]
        at += length


def _whole(data: bytes, layout: np.dtype[np.void]) -> bytes:
    return data[: len(data) - len(data) % layout.itemsize]
