"""Record all topics of a live source, also those that no display shows."""

from __future__ import annotations

import os
import shlex
import tempfile
import threading
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import BinaryIO

from sambot_viz.errors import UsageError
from sambot_viz.files import reason_of
from sambot_viz.outlet import logger
from sambot_viz.sources.recording_file import RecordingFile, RecordingTarget
from sambot_viz.sources.recording_thread import (
    PERIOD,
    RecordingStatus,
    RecordingThread,
)
from sambot_viz.sources.source import Source
from sambot_viz.sources.split_recording import SplitRecording
from sambot_viz.text import text

_MOST_NAMES = 100

_log = logger(__name__)


@dataclass(frozen=True, slots=True)
class RecordingPlace:
    """Where the recordings go that users of the page start.

    Attributes:
        folder: gets a file for each, or a folder.
        part_s: after this time a file is closed and the next one begun [s]; None for
            one file.
    """

    folder: Path
    part_s: float | None = None


class SourceRecorder:
    """Starts and stops recordings of a source, one at a time.

    It calls the earlier callback of `source.on_topics` too.

    Args:
        source: the source to record.
        place: where recordings go that users of the page start; None if they may not.
        on_change: called once in a period while there is a recording, in its thread;
            must only post.
        on_trouble: called in the same thread with the reason if a recording ends before
            it was stopped; by default it is logged.
        period: between reports, and between flushes at first [s].

    Attributes:
        place: as given.
        ended: the recordings before the present or last one.
    """

    def __init__(
        self,
        source: Source,
        place: RecordingPlace | None,
        on_change: Callable[[], object],
        on_trouble: Callable[[str], object] = _log.error,
        period: float = PERIOD,
    ) -> None:
        self.place = place
        self._period = period
        self._source = source
        self._on_change = on_change
        self._on_trouble = on_trouble
        self._lock = threading.Lock()
        self._recording: RecordingThread | None = None
        self.ended: list[RecordingStatus] = []
        self._is_closed = False
        self._then = source.on_topics
        source.on_topics = self._look

    @property
    def status(self) -> RecordingStatus | None:
        """The present or last recording; None when there was none."""
        recording = self._recording
        return None if recording is None else recording.status

    def start(self, path: Path | None = None) -> None:
        """Begin a recording; nothing happens while there is one.

        Args:
            path: the file; None takes a name with date and time in `place`.

        Raises:
            UsageError: the file is there already, or cannot be written.
        """
        with self._lock:
            last = self._recording
            if self._is_closed or (last is not None and last.status.is_running):
                return
            if path is not None:
                target = RecordingFile(*_created(path), self._period)
            else:
                target = _named(self.place, self._period)
            if last is not None:
                self.ended.append(last.status)
            made = RecordingThread(
                self._source,
                target,
                self._on_change,
                self._on_trouble,
                self._period,
            )
            # Listen for new topics before reading the first list, so that none is lost.
            self._recording = made
            made.start()
        self._on_change()

    def stop(self, wait: bool = True) -> None:
        """End the recording and close its file; may be called twice.

        Args:
            wait: until the file is closed.
        """
        with self._lock:
            recording = self._recording
        if recording is not None:
            recording.stop(wait)

    def close(self) -> None:
        """Stop, and begin no other recording."""
        with self._lock:
            self._is_closed = True
        self.stop()

    def _look(self) -> None:
        # First: what comes after a subscription of others is from before its start.
        recording = self._recording
        if recording is not None:
            recording.subscribe()
        self._then()


def check_file(path: Path) -> None:
    """Refuse a file that a recording cannot become, before there is a robot.

    Raises:
        UsageError: the file is there already, or cannot be made.
    """
    if os.path.lexists(path):
        raise UsageError(_exists(path))
    check_folder(path.parent)
    # Some folders take files and not this name.
    _created(path)[1].close()
    path.unlink()


def check_folder(folder: Path) -> None:
    """Refuse a folder in which no recording can be made.

    Raises:
        UsageError: it is not a folder, or takes no file.
    """
    if not folder.is_dir():
        name = text(str(folder))
        if not os.path.lexists(folder):
            made = shlex.quote(name)
            raise UsageError(f"there is no folder {name}: make it with mkdir -p {made}")
        raise UsageError(f"{name} is not a folder for recordings")
    try:
        # Permissions do not say it all: /proc takes no file of anybody.
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        raise UsageError(
            f"the folder {text(str(folder))} takes no file ({reason_of(error)}); give "
            "another one"
        ) from error


def _named(place: RecordingPlace | None, period: float) -> RecordingTarget:
    """Create a file or folder with date and time as its name, and a number if taken."""
    if place is None:
        raise UsageError("recording is not offered here; start with --record-dir DIR")
    name = f"{datetime.now():%Y-%m-%d_%H-%M-%S}"
    for number in range(1, _MOST_NAMES):
        path = place.folder / f"{name}{f'_{number}' if number > 1 else ''}"
        file = path.with_name(f"{path.name}.mcap")
        if os.path.lexists(path) or os.path.lexists(file):
            continue
        if place.part_s is None:
            return RecordingFile(*_created(file), period)
        return SplitRecording(_created_folder(path), place.part_s, period)
    raise UsageError(
        f"{text(str(place.folder))} has too many recordings of this second"
    )


def _created_folder(path: Path) -> Path:
    """Create a folder that does not exist yet."""
    try:
        path.mkdir()
    except OSError as error:
        raise _unwritable(path, error) from error
    return path


def _created(path: Path) -> tuple[Path, BinaryIO]:
    """Create a file that does not exist yet."""
    try:
        return path, open(path, "xb")
    except FileExistsError as error:
        raise UsageError(_exists(path)) from error
    except OSError as error:
        raise _unwritable(path, error) from error


def _unwritable(path: Path, error: OSError) -> UsageError:
    return UsageError(f"{text(str(path))} cannot be written: {reason_of(error)}")


def _exists(path: Path) -> str:
    return f"{text(str(path))} is there already; give a name for a new file"
