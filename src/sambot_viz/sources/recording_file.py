"""One file of a recording on its disk, while it is written."""

from __future__ import annotations

import os
from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, Protocol

from sambot_viz.sources.bag.compression import BrokenPieceError
from sambot_viz.sources.cut_recording import finish_cut
from sambot_viz.sources.mcap_file import McapFile
from sambot_viz.sources.message import Recorded

LONGEST_PERIOD = 10.0
"""Longest time between flushes: a killed program loses what came after the last [s]."""
_GROWTH = 0.003
"""Of the length of a recording is the pause between flushes: each is in the index."""


class RecordingTarget(Protocol):
    """Takes the messages of one recording, in one thread; methods raise OSError."""

    @property
    def name(self) -> str:
        """The name of the file or folder."""
        ...

    @property
    def size(self) -> int:
        """Bytes on the disk."""
        ...

    def begin(self) -> None:
        """Write what comes before the first message."""
        ...

    def write(self, message: Recorded, log_ns: int) -> bool:
        """Add a message; see `McapFile.write`."""
        ...

    def keep(self, seconds: float) -> None:
        """Write out what has come, if that is due.

        Args:
            seconds: time since the recording began [s].
        """
        ...

    def finish(self) -> None:
        """Write what comes after the last message."""
        ...

    def close(self) -> None:
        """Close the open file; may be called again."""
        ...

    def rescue(self) -> int:
        """Repair what a full disk has cut off; return how many messages are left."""
        ...

    def remove(self) -> None:
        """Remove a recording without messages."""
        ...


class RecordingFile:
    """Implements `RecordingTarget` as one MCAP file.

    Args:
        path: the file.
        stream: the same, new and open.
        period: between flushes at first [s].

    Attributes:
        path: as given.
        counts: number of messages of each topic.
        span: the first and the last log time [ns]; None without messages.
    """

    def __init__(self, path: Path, stream: BinaryIO, period: float) -> None:
        self.path = path
        self.counts = Counter[str]()
        self.span: tuple[int, int] | None = None
        self._stream = stream
        self._period = period
        self._flushed_at = 0.0
        self._file: McapFile | None = None

    @property
    def name(self) -> str:
        """The name of the file."""
        return self.path.name

    @property
    def size(self) -> int:
        """Bytes on the disk."""
        with suppress(OSError):
            return os.path.getsize(self.path)
        return 0

    @property
    def content(self) -> McapFile:
        """The messages; only after `begin`."""
        assert self._file is not None
        return self._file

    def begin(self) -> None:
        """Write the head of the file."""
        self._file = McapFile(self._stream)

    def write(self, message: Recorded, log_ns: int) -> bool:
        """Add a message; see `McapFile.write`."""
        if not self.content.write(message, log_ns):
            return False
        self.counts[message.topic] += 1
        first, last = self.span or (log_ns, log_ns)
        self.span = min(first, log_ns), max(last, log_ns)
        return True

    def keep(self, seconds: float) -> None:
        """Flush, the longer the recording the less often."""
        period = min(LONGEST_PERIOD, max(self._period, seconds * _GROWTH))
        if seconds - self._flushed_at >= period:
            self._flushed_at = seconds
            self.content.flush()

    def finish(self) -> None:
        """Write the index."""
        self.content.finish()

    def close(self) -> None:
        """Close the file; may be called again."""
        self._stream.close()

    def rescue(self) -> int:
        """Truncate after the last whole chunk, and write the index."""
        if self._file is not None:
            with suppress(OSError, BrokenPieceError):
                return finish_cut(self.path, self._file.flushed, self._file.definitions)
        return self.counts.total()

    def remove(self) -> None:
        """Remove a file without messages, which would be in the way of the next try."""
        with suppress(OSError):
            self.path.unlink()
