"""Read a file in pieces, from several threads.

It is read, not mapped: mapped pages count as memory of the process.
"""

from __future__ import annotations

import os
import tempfile
import threading
from contextlib import suppress
from pathlib import Path

_LEAST_AHEAD = 4096
_MOST_AHEAD = 2**18


class FileBytes:
    """A file that is open for reading.

    Attributes:
        path: where it is, as the user wrote it.
        content: where its bytes are: itself, or what was decompressed.
        size: how long it was when it was opened [bytes]; a recorder may go on writing.
    """

    def __init__(
        self,
        path: Path,
        folder: tempfile.TemporaryDirectory[str] | None = None,
    ) -> None:
        """Open a file.

        Args:
            path: where it is.
            folder: holds one file with its bytes decompressed, and is removed with it.

        Raises:
            OSError: it cannot be opened.
        """
        self.path = path
        self._folder = folder
        self.content = path if folder is None else next(Path(folder.name).iterdir())
        self._stream = self.content.open("rb", buffering=0)
        self.size = os.fstat(self._stream.fileno()).st_size
        # Seeking and reading belong together; players of several sessions read.
        self._lock = threading.Lock()

    @property
    def is_remote(self) -> bool:
        """Whether it is read over a network."""
        return False

    @property
    def is_unpacked(self) -> bool:
        """Its bytes were decompressed."""
        return self._folder is not None

    def read_at(self, at: int, count: int) -> bytes:
        """Return up to `count` bytes from a place; fewer at the end of the file.

        Raises:
            OSError: the disk, or a web server, does not give them.
            ValueError: the file was closed.
        """
        count = min(count, self.size - at)
        if at < 0 or count <= 0:
            return b""
        with self._lock:
            return self._read(at, count)

    def _read(self, at: int, count: int) -> bytes:
        """Read from the file; the caller holds the lock."""
        self._stream.seek(at)
        data = self._stream.read(count) or b""
        while 0 < len(data) < count:
            more = self._stream.read(count - len(data))
            if not more:
                break
            data += more
        return data

    def close(self) -> None:
        """Close the file; may be called again."""
        with self._lock:
            self._stream.close()
            if self._folder is not None:
                with suppress(OSError):
                    self._folder.cleanup()


class ReadAhead:
    """Reads small pieces in sequence with few reads of the file.

    It reads ahead by 4 kB, and more while the pieces are adjacent, so that large
    messages that are skipped between small ones are not read.
    """

    def __init__(self, file: FileBytes) -> None:
        self._file = file
        self._data = b""
        self._at = 0
        self._ahead: int = _LEAST_AHEAD

    def get(self, at: int, count: int) -> bytes:
        """Return up to `count` bytes from a place; fewer at the end of the file."""
        begin = at - self._at
        if begin < 0 or begin + count > len(self._data):
            is_next = 0 <= begin <= len(self._data)
            ahead = min(2 * self._ahead, _MOST_AHEAD) if is_next else _LEAST_AHEAD
            if count > ahead:
                return self._file.read_at(at, count)
            self._data = self._file.read_at(at, ahead)
            self._at, self._ahead, begin = at, ahead, 0
        return self._data[begin : begin + count]

    def around(self, at: int, count: int) -> tuple[bytes, int]:
        """Return bytes that begin with those at a place, and how far into them.

        At least `count` bytes follow, as far as the file has them; usually more.
        """
        begin = at - self._at
        if begin < 0 or begin + count > len(self._data):
            self.get(at, count)
            begin = at - self._at
        return self._data, begin
