"""MCAP files made of single records, whatever these say."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import lz4.frame  # type: ignore[import-untyped]
import zstandard

MAGIC = b"\x89MCAP0\r\n"


def string(size: int) -> bytes:
    """A message of std_msgs/String of so many bytes; ROS 1 leaves out the first 4."""
    return b"\0\1\0\0" + struct.pack("<I", size - 8) + b"a" * (size - 9) + b"\0"


def record(opcode: int, content: bytes) -> bytes:
    return bytes([opcode]) + struct.pack("<Q", len(content)) + content


def sized(content: bytes) -> bytes:
    return struct.pack("<I", len(content)) + content


def message(channel: int, time: int) -> bytes:
    return record(5, struct.pack("<HIQQ", channel, 0, time, time) + string(40))


def chunk(content: bytes, says: int, compression: str = "zstd") -> bytes:
    packed = content
    if compression == "zstd":
        packed = zstandard.ZstdCompressor().compress(content)
    elif compression == "lz4":
        packed = bytes(cast(Any, lz4.frame).compress(content))
    head = struct.pack("<QQQI", 1, 2, says, 0) + sized(compression.encode())
    return record(6, head + struct.pack("<Q", len(packed)) + packed)


def mcap_file(
    folder: Path, records: Sequence[bytes], text: bytes = b"string data\n"
) -> Path:
    """Write a file with the topics /a and /b, and these records behind them.

    Args:
        folder: where.
        records: messages and chunks.
        text: the definition of their type.
    """
    schema = struct.pack("<H", 1) + b"".join(
        map(sized, (b"std_msgs/msg/String", b"ros2msg", text))
    )
    channels = [
        record(
            4, struct.pack("<HH", number, 1) + sized(name) + sized(b"cdr") + sized(b"")
        )
        for number, name in ((1, b"/a"), (2, b"/b"))
    ]
    begin = MAGIC + record(1, sized(b"ros2") + sized(b"tests")) + record(3, schema)
    end = record(15, bytes(4)) + record(2, bytes(20)) + MAGIC
    path = folder / "pieces.mcap"
    path.write_bytes(begin + b"".join([*channels, *records]) + end)
    return path
