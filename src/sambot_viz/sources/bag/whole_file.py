"""Files that rosbag2 has compressed as a whole, with ``--compression-mode file``."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from sambot_viz.sources.bag.file_bytes import FileBytes
from sambot_viz.sources.bag.refusals import not_a_bag, refused

ZSTD = b"\x28\xb5\x2f\xfd"

_PIECE = 2**20
_SPARE = 2**28
"""Space that is left free on the disk [bytes]."""


def unpacked(file: FileBytes) -> tempfile.TemporaryDirectory[str]:
    """Decompress a file into a temporary folder, and close it.

    Of a truncated file the part before the cut is kept. The size is limited by the free
    space on the disk.

    Raises:
        SourceError: the file cannot be decompressed, or the disk has no room.
    """
    import zstandard

    folder = tempfile.TemporaryDirectory(prefix="sambot-viz-")
    try:
        free = shutil.disk_usage(folder.name).free - _SPARE
        decompressor = zstandard.ZstdDecompressor().decompressobj()
        target, at = Path(folder.name) / "content", 0
        with target.open("wb") as stream:
            while data := file.read_at(at, _PIECE // 16):
                at += len(data)
                try:
                    free -= stream.write(decompressor.decompress(data))
                except zstandard.ZstdError:
                    break
                if free < 0:
                    message = f"{file.path.name} is too large to be decompressed here"
                    hint = "set TMPDIR to a folder with room"
                    raise refused(file.path, "file-unreadable", message, hint)
                if decompressor.eof:
                    break
            if not stream.tell():
                raise not_a_bag(file.path, "it cannot be decompressed")
    except BaseException:
        folder.cleanup()
        raise
    file.close()
    return folder
