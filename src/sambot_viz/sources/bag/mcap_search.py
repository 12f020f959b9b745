"""Find the next records of an MCAP file after damaged bytes."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz import limits
from sambot_viz.sources.bag.compression import BrokenPieceError
from sambot_viz.sources.bag.file_bytes import FileBytes, ReadAhead
from sambot_viz.sources.bag.mcap_records import (
    CHUNK,
    HEAD,
    MESSAGE,
    MESSAGE_HEAD,
    read_chunk,
)

_STEP = 2**20
_LIKELY = re.compile(rb"(?=[\x03-\x07].{4}\x00{4})", re.DOTALL)
"""A schema, channel, message, chunk or message index of less than 4 GB."""

_IN_A_ROW = 3
"""Number of consecutive valid records that rule out chance."""


def find_record(file: FileBytes, at: int, end: int) -> Iterator[int | None]:
    """Search for the next place from which records follow each other.

    Args:
        file: the file.
        at: where the walk has ended [bytes].
        end: where the records end [bytes].

    Yields:
        None after each megabyte; at last the place, if there is one.

    Raises:
        BrokenPieceError: more places look like a record than are looked at.
    """
    window, candidates = ReadAhead(file), 0
    begin = at + 1
    while begin < end:
        data = file.read_at(begin, min(_STEP + HEAD.size, end - begin))
        for match in _LIKELY.finditer(data):
            candidates += 1
            if candidates > limits.REPAIRED.value:
                most = limits.REPAIRED.value
                raise BrokenPieceError(f"{most:,} places there look like a record")
            if _is_record(window, begin + match.start(), end):
                yield begin + match.start()
                return
        begin += _STEP
        yield None


def _is_record(window: ReadAhead, at: int, end: int) -> bool:
    """Tell if records follow each other from a place, or a whole chunk is there."""
    for _ in range(_IN_A_ROW):
        if at == end:
            return True
        head = window.get(at, HEAD.size)
        if len(head) < HEAD.size:
            return False
        opcode, length = HEAD.unpack(head)
        behind = at + HEAD.size + length
        if not 1 <= opcode <= 0x0F or behind > end:
            return False
        if opcode == MESSAGE and length < MESSAGE_HEAD.size:
            return False
        if opcode == CHUNK:
            try:
                chunk = read_chunk(window.get(at + HEAD.size, min(length, 64)))
            except BrokenPieceError:
                return False
            return chunk.at + chunk.size == length
        at = behind
    return True


def zeros_end(file: FileBytes, at: int, end: int) -> int:
    """Return where the zeros end that begin at a place."""
    while at < end:
        data = file.read_at(at, min(_STEP, end - at))
        rest = data.lstrip(b"\x00")
        if rest or not data:
            return at + len(data) - len(rest)
        at += len(data)
    return end
