"""Decompress pieces of a file that may claim any length.

No more memory is taken than the caller allows, whatever the header of the data says.
"""

from __future__ import annotations

import bz2
import lzma
import zlib
from typing import Any

from sambot_viz import limits


class BrokenPieceError(Exception):
    """Some bytes of the file that cannot be used; never leaves this package."""


class TooLargeError(BrokenPieceError):
    """A piece of the file that is above the limit of chunks."""

    def __init__(self, size: int) -> None:
        super().__init__(f"says that it holds {limits.CHUNK.said(size)}")


def decompress(name: str, data: bytes | memoryview, size: int) -> bytes | memoryview:
    """Decompress a piece of a file.

    Args:
        name: "", "none", "lz4", "zstd" or "bz2".
        data: the compressed bytes.
        size: number of bytes once decompressed, according to the file.

    Raises:
        TooLargeError: it is above the limit of chunks.
        BrokenPieceError: it is damaged, or has another length.
    """
    if size > limits.CHUNK.value:
        raise TooLargeError(size)
    try:
        raw = _decompress(name, data, size)
    except (MemoryError, OSError, RuntimeError, ValueError, EOFError) as error:
        raise BrokenPieceError("it cannot be decompressed") from error
    except (zlib.error, lzma.LZMAError) as error:
        raise BrokenPieceError("it cannot be decompressed") from error
    if len(raw) != size:
        raise _other_size(size, len(raw))
    return raw


def _other_size(size: int, held: int) -> BrokenPieceError:
    return BrokenPieceError(f"it says that it holds {size:,} bytes, and holds {held:,}")


def _decompress(name: str, data: bytes | memoryview, size: int) -> bytes | memoryview:
    if name in ("", "none"):
        return data
    if name == "zstd":
        return _zstd(data, size)
    if name == "lz4":
        return _lz4(data, size)
    if name == "bz2":
        return bz2.BZ2Decompressor().decompress(bytes(data), size)
    raise BrokenPieceError(f"its compression {name[:40]!r} is not known")


def _zstd(data: bytes | memoryview, size: int) -> bytes:
    import zstandard

    try:
        # The header of the frame may claim any size, and memory would be taken for it.
        claimed = zstandard.get_frame_parameters(data).content_size
        if claimed not in (size, zstandard.CONTENTSIZE_UNKNOWN):
            raise _other_size(size, claimed)
        return zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    except zstandard.ZstdError as error:
        raise BrokenPieceError("it cannot be decompressed") from error


def _lz4(data: bytes | memoryview, size: int) -> bytes:
    import lz4.frame  # type: ignore[import-untyped]

    frame: Any = lz4.frame
    # With a limit it takes no more memory, whatever the header of the frame claims.
    return frame.LZ4FrameDecompressor().decompress(data, max_length=size)
