"""Small facts about files: whether one was saved, writing one whole, git-LFS marks."""

from __future__ import annotations

import os
import secrets
import stat
from pathlib import Path

Stamp = tuple[int, int, int]
"""What differs after a save: time of change [ns], size [B], number of the file."""


def stamp(path: Path) -> Stamp | None:
    """What differs after a save; links are followed, None when there is no file."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return (found.st_mtime_ns, found.st_size, found.st_ino)


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file whole or not at all; what was there keeps its permissions.

    The new content is written beside the file and swapped in, so that a crash or a
    full disk leaves the old file. Links are followed.

    Raises:
        OSError: it cannot be written.
    """
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".{target.name[:200]}.{secrets.token_hex(4)}")
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    handle = os.open(temporary, flags, 0o666)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        if target.exists():
            temporary.chmod(stat.S_IMODE(target.stat().st_mode))
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def is_lfs_pointer(data: bytes) -> bool:
    """Whether the first bytes of a file are those of a git-LFS pointer.

    A clone without git-LFS has such a text of three lines in place of each large file.
    """
    return data.startswith(b"version https://git-lfs")
