"""Small facts about files: whether one was saved, where it is, how large, git-LFS."""

from __future__ import annotations

import errno
import glob
import os
import stat
import time
from collections.abc import Generator, Iterable
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from urllib.parse import unquote, urlsplit

_KEPT_SIZE = 1 << 20
"""Larger files are not kept by `each_file_once` [B]."""
_kept: ContextVar[dict[str, bytes] | None] = ContextVar("kept", default=None)
_LONGEST_SAVE = 3600.0
"""A file that another program is still writing is younger [s]."""

Stamp = tuple[int, int, int]
"""Facts that differ after a save: time of change [ns], size [B], inode."""


def stamp(path: Path) -> Stamp | None:
    """Return facts that differ after a save; None if there is no file.

    Links are followed.
    """
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
    # Commands that only read must not wait for it.
    import secrets

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
    _remove_leftovers(target)


def _remove_leftovers(target: Path) -> None:
    """Remove what programs that were killed while they saved have left."""
    beside = f".{glob.escape(target.name[:200])}.{'[0-9a-f]' * 8}"
    long_ago = time.time() - _LONGEST_SAVE
    for left in target.parent.glob(beside):
        with suppress(OSError):
            if left.stat().st_mtime < long_ago:
                left.unlink()


def relative_path(path: str | Path, start: str | Path = os.curdir) -> str:
    """Return a path as seen from a folder; a whole one on another drive of Windows."""
    try:
        return os.path.relpath(path, start)
    except ValueError:
        return os.path.abspath(path)


class FileTooLargeError(OSError):
    """A file with more bytes than the caller allows."""


class NotAFileError(OSError):
    """A folder, a pipe or a device where a file is expected."""


def reason_of(error: OSError | ValueError) -> str:
    """Say why a file cannot be used, to follow a colon in a sentence."""
    if isinstance(error, FileNotFoundError):
        return "there is no such file"
    text = getattr(error, "strerror", None) or str(error) or "it cannot be read"
    return text[:1].lower() + text[1:]


@contextmanager
def each_file_once() -> Generator[None]:
    """Let `read_limited` read each small file once, as long as this lasts.

    Many rules look at the same files, and all of them at one state of these.
    """
    if _kept.get() is not None:
        yield
        return
    before = _kept.set({})
    try:
        yield
    finally:
        _kept.reset(before)


def read_limited(path: Path, largest: int, *, pipe: bool = False) -> bytes:
    """Return the bytes of a regular file, unless there are more than `largest`.

    No more than that is read, whatever the size that the system reports.

    Args:
        path: the file.
        largest: refuse more than this [bytes].
        pipe: take a pipe too, such as the shell's <(…), which has no size and can be
            read only once.

    Raises:
        FileTooLargeError: it has more bytes.
        OSError: it is not a regular file, or cannot be read.
        ValueError: no file can have this name.
    """
    kept, name = _kept.get(), os.path.abspath(path)
    if kept is not None and len(kept.get(name, b"")) <= largest and name in kept:
        return kept[name]
    found = path.stat()
    if not (stat.S_ISREG(found.st_mode) or (pipe and stat.S_ISFIFO(found.st_mode))):
        raise NotAFileError(errno.EINVAL, "it is not a regular file", str(path))
    if found.st_size <= largest:
        with path.open("rb") as stream:
            data = stream.read(largest + 1)
        if len(data) <= largest:
            if kept is not None and len(data) <= _KEPT_SIZE:
                kept[name] = data
            return data
    raise FileTooLargeError(
        errno.EFBIG, f"it has more than {largest:,} bytes", str(path)
    )


def is_below(path: Path, folders: Iterable[Path]) -> bool:
    """Return whether a path, with its links followed, leads into one of these folders.

    Args:
        path: may or may not exist.
        folders: resolved folders.
    """
    try:
        real = path.resolve()
    except (OSError, RuntimeError, ValueError):
        # A ring of links, or a name that no file system can hold.
        return False
    return any(real.is_relative_to(folder) for folder in folders)


def is_lfs_pointer(data: bytes) -> bool:
    """Return whether the first bytes of a file are those of a git-LFS pointer.

    A clone without git-LFS has such a text of three lines in place of each large file.
    """
    return data.startswith(b"version https://git-lfs")


RECORDING_ENDINGS = (".mcap", ".db3", ".bag")
_MAGIC = (b"\x89MCAP0\r\n", b"SQLite format 3\0", b"#ROSBAG V")
"""The first bytes of recordings: MCAP, sqlite3, ROS 1."""
_WEB = ("http://", "https://")
LIVE_SOURCES = (
    "foxglove://HOST:8765, rosbridge://HOST:9090, zenoh://HOST:7447 or dds:?domain=0"
)
"""What `--source` takes beside files: live robots, for help and messages."""


def is_web_address(words: object) -> bool:
    """Return whether something is the address of a file on a web server."""
    if not isinstance(words, str) or not words.lower().startswith(_WEB):
        return False
    try:
        return len(urlsplit(words).path) > 1
    except ValueError:
        return False


def is_web_folder(words: object) -> bool:
    """Return whether something is the address of a folder on a web server."""
    if not isinstance(words, str) or not words.lower().startswith(_WEB):
        return False
    try:
        return urlsplit(words).path.endswith("/")
    except ValueError:
        return False


def name_of_address(address: str) -> str:
    """Return the name of a file on a web server; without one, the server's."""
    parts = urlsplit(address)
    name = unquote(parts.path.rstrip("/").rpartition("/")[2])
    return name or parts.netloc.rpartition("@")[2]


def is_recording(path: Path | str) -> bool:
    """Return whether a file or folder is a recording of ROS, by its bytes or name.

    A folder is one when it has such files or their metadata.yaml, and no package; what
    is on a web server is not asked for.
    """
    if is_web_address(path):
        return urlsplit(str(path)).path.lower().endswith(RECORDING_ENDINGS)
    path = Path(path)
    try:
        if path.is_dir():
            names = os.listdir(path)
            recorded = any(name.endswith(RECORDING_ENDINGS) for name in names)
            return "package.xml" not in names and (
                recorded or _names_recordings(path / "metadata.yaml")
            )
        if not path.is_file():
            return False
        with path.open("rb") as file:
            begin = file.read(16)
    except (OSError, ValueError):
        return False
    return begin.startswith(_MAGIC) or path.suffix.lower() in RECORDING_ENDINGS


def _names_recordings(metadata: Path) -> bool:
    if not metadata.is_file():
        return False
    with metadata.open("rb") as file:
        return b"rosbag2_bagfile_information" in file.read(4096)
