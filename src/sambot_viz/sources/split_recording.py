"""A recording as a folder of files, as ``ros2 bag record --max-bag-duration`` makes it.

Each file is whole once `metadata.yaml` names it, and begins with the latched messages
that hold: so who reads the last one alone has the robot, and others can follow a
recording over any web server while it is made.
"""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from sambot_viz.sources.bag.folder import ENDED, METADATA, RUNNING, STATE
from sambot_viz.sources.latched_state import LatchedState
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.recording_file import RecordingFile

_VERSION = 6
"""Of metadata.yaml: the first one with `custom_data`, read by rosbag2 since Iron."""


class SplitRecording:
    """Implements `RecordingTarget` as a folder of MCAP files, and their list.

    Args:
        folder: an empty folder, whose name the files get.
        part_s: after this time a file is closed, and the next one begun [s].
        period: between flushes of a file [s].
    """

    def __init__(self, folder: Path, part_s: float, period: float) -> None:
        self._folder = folder
        self._part_s, self._period = part_s, period
        self._begun_at = 0.0
        self._held = LatchedState()
        self._files: list[dict[str, Any]] = []
        self._topics: dict[str, dict[str, Any]] = {}
        self._counts = Counter[str]()
        self._closed_size = 0
        self._file: RecordingFile | None = None

    @property
    def name(self) -> str:
        """The name of the folder."""
        return self._folder.name

    @property
    def size(self) -> int:
        """Bytes on the disk, without the list."""
        return self._closed_size + (self._file.size if self._file else 0)

    def begin(self) -> None:
        """Write an empty list, and begin the first file."""
        self._begin_file()
        self._write_list(RUNNING)

    def write(self, message: Recorded, log_ns: int) -> bool:
        """Add a message; the first one of a file comes after the latched ones."""
        file = self._open_file
        self._held.take(message)
        if file.span is None and self._files:
            for latched in self._held.without(message):
                file.write(latched, log_ns)
        return file.write(message, log_ns)

    def keep(self, seconds: float) -> None:
        """Close a file that is old enough, and begin the next one."""
        file = self._open_file
        if seconds - self._begun_at < self._part_s:
            file.keep(seconds - self._begun_at)
            return
        # A file in which nothing came is no part: it goes on.
        self._begun_at = seconds
        if file.span is not None:
            file.finish()
            file.close()
            self._list(file)
            # If the next one cannot be created, this one is listed already.
            self._file = None
            self._begin_file()
            self._write_list(RUNNING)

    def finish(self) -> None:
        """Close the last file, and say in the list that it is the last."""
        file = self._open_file
        file.finish()
        file.close()
        self._end(file)

    def close(self) -> None:
        """Close the open file; may be called again."""
        if self._file is not None:
            self._file.close()

    def rescue(self) -> int:
        """Make the last file whole; those before are."""
        file, left = self._file, self._counts.total()
        if file is not None:
            left += file.rescue()
            # Without room for a list the previous one stays, with the files before.
            with suppress(OSError):
                self._end(file)
        return left

    def remove(self) -> None:
        """Remove the folder of a recording without messages."""
        if self._file is not None:
            self._file.remove()
        with suppress(OSError):
            (self._folder / METADATA).unlink()
        with suppress(OSError):
            self._folder.rmdir()

    @property
    def _open_file(self) -> RecordingFile:
        assert self._file is not None
        return self._file

    def _begin_file(self) -> None:
        path = self._folder / f"{self._folder.name}_{len(self._files)}.mcap"
        self._file = RecordingFile(path, open(path, "xb"), self._period)
        self._file.begin()

    def _end(self, file: RecordingFile) -> None:
        if file.span is None:
            file.remove()
        else:
            self._list(file)
        self._write_list(ENDED)

    def _list(self, file: RecordingFile) -> None:
        """Add a closed file to the list."""
        assert file.span is not None
        self._closed_size += file.size
        self._counts.update(file.counts)
        self._topics |= _topics_of(file)
        self._files.append(
            {
                "path": file.name,
                **_times(*file.span),
                "message_count": file.counts.total(),
            }
        )

    def _write_list(self, state: str) -> None:
        """Write metadata.yaml; readers get the previous one or this, each complete."""
        new = self._folder / f".{METADATA}.new"
        new.write_text("\n".join(self._lines(state)), "utf-8")
        os.replace(new, self._folder / METADATA)

    def _lines(self, state: str) -> Iterator[str]:
        """Yield the lines of metadata.yaml; its values are JSON, which is YAML."""
        starts = [_start_of(one) for one in self._files]
        ends = [_start_of(one) + one["duration"]["nanoseconds"] for one in self._files]
        counts = self._counts
        values: dict[str, Any] = {
            "version": _VERSION,
            "storage_identifier": "mcap",
            **_times(min(starts, default=0), max(ends, default=0)),
            "message_count": counts.total(),
            "topics_with_message_count": [
                {"topic_metadata": topic, "message_count": counts[name]}
                for name, topic in self._topics.items()
            ],
            "compression_format": "",
            "compression_mode": "",
            "custom_data": {STATE: state},
        }
        yield "rosbag2_bagfile_information:"
        yield from (f"  {key}: {json.dumps(value)}" for key, value in values.items())
        for key, rows in (
            ("relative_file_paths", [one["path"] for one in self._files]),
            ("files", self._files),
        ):
            yield f"  {key}:{'' if rows else ' []'}"
            yield from (f"    - {json.dumps(row)}" for row in rows)
        yield ""


def _times(start: int, end: int) -> dict[str, Any]:
    return {
        "starting_time": {"nanoseconds_since_epoch": start},
        "duration": {"nanoseconds": end - start},
    }


def _start_of(file: dict[str, Any]) -> int:
    return file["starting_time"]["nanoseconds_since_epoch"]


def _topics_of(file: RecordingFile) -> dict[str, dict[str, Any]]:
    """Return the topics of a file as rosbag2 lists them."""
    from mcap.records import Channel, Schema

    types: dict[int, str] = {}
    topics: dict[str, dict[str, Any]] = {}
    for record in file.content.definitions:
        if isinstance(record, Schema):
            types[record.id] = record.name
        elif isinstance(record, Channel):
            topics[record.topic] = {
                "name": record.topic,
                "type": types.get(record.schema_id, ""),
                "serialization_format": record.message_encoding,
                "offered_qos_profiles": record.metadata["offered_qos_profiles"],
            }
    return topics
