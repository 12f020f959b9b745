"""Open an sqlite3 file so that nothing is ever written beside it."""

from __future__ import annotations

import shutil
import sqlite3
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.sources.bag.file_bytes import FileBytes
from sambot_viz.sources.bag.refusals import refused, unreadable

MAGIC = b"SQLite format 3\0"

_SPARE = 2**26
"""Free space that a copy leaves on the disk [bytes]."""


@dataclass(slots=True)
class Database:
    """A database that is open for reading.

    Attributes:
        connection: to it, or to its copy.
        has_wal: messages are in the -wal file: the recorder did not finish.
        lacks: how much is there when the file is cut off, else "".
        folder: where the copy is, if there is one.
    """

    connection: sqlite3.Connection
    has_wal: bool
    lacks: str
    folder: tempfile.TemporaryDirectory[str] | None

    def close(self) -> None:
        """Close it and remove the copy; may be called again."""
        self.connection.close()
        if self.folder is not None:
            with suppress(OSError):
                self.folder.cleanup()


def open_database(file: FileBytes) -> Database:
    """Open an sqlite3 file for reading.

    Raises:
        SourceError: the disk has no room for a copy that is needed.
        OSError: the file cannot be read.
    """
    path = file.content
    beside = [path.with_name(path.name + end) for end in ("-wal", "-journal")]
    pending = [other for other in beside if _size(other)]
    pages, there = _pages(file)
    lacks = f"{there} of {pages} pages are there" if there < pages else ""
    if not pending and not lacks:
        # Nobody else writes: no lock is taken and no file made, also in a folder that
        # cannot be written.
        address = f"{path.resolve().as_uri()}?mode=ro&immutable=1"
        return Database(_connect(path, address), False, "", None)
    folder = _copied(path, pending)
    copy = Path(folder.name) / "copy.db3"
    if lacks and not pending:
        with copy.open("r+b") as stream:
            stream.truncate(pages * (file.size // max(1, there)))
    try:
        connection = _connect(path, copy.as_uri())
    except BaseException:
        folder.cleanup()
        raise
    return Database(connection, bool(pending), "" if pending else lacks, folder)


def _connect(path: Path, address: str) -> sqlite3.Connection:
    try:
        connection = sqlite3.connect(address, uri=True, check_same_thread=False)
        # Names of topics may be any bytes.
        connection.text_factory = _text
        connection.execute("pragma trusted_schema = off")
    except sqlite3.Error as error:
        raise unreadable(path, OSError(str(error))) from error
    return connection


def _text(data: bytes) -> str:
    return data.decode("utf-8", "replace")


def _copied(path: Path, pending: list[Path]) -> tempfile.TemporaryDirectory[str]:
    """Copy a file and those beside it to a temporary folder."""
    folder = tempfile.TemporaryDirectory(prefix="sambot-viz-")
    try:
        needed = sum(map(_size, [path, *pending])) + _SPARE
        if shutil.disk_usage(folder.name).free < needed:
            message = (
                f"{path.name} was not finished and must be copied to be read, but "
                f"{folder.name} has not the {needed / 1e9:.1f} GB for it"
            )
            hint = "set TMPDIR to a folder with room, or run 'ros2 bag reindex'"
            raise refused(path, "file-unreadable", message, hint)
        shutil.copyfile(path, Path(folder.name) / "copy.db3")
        for other in pending:
            end = other.name[len(path.name) :]
            shutil.copyfile(other, Path(folder.name) / f"copy.db3{end}")
    except BaseException:
        folder.cleanup()
        raise
    return folder


def _pages(file: FileBytes) -> tuple[int, int]:
    """Return how many pages the header claims, and how many are there."""
    head = file.read_at(0, 100)
    size = int.from_bytes(head[16:18], "big")
    size = 65536 if size == 1 else size
    claimed = int.from_bytes(head[28:32], "big")
    # The number holds only when it was written with the last change.
    if size < 512 or size & (size - 1) or head[24:28] != head[92:96]:
        return 0, 0
    return min(claimed, 2**32 - 2), file.size // size


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0
