"""The sentences about damage in a file of a recording."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Literal

import numpy as np

from sambot_viz.errors import Problem
from sambot_viz.sources.bag.blocks import Numbers, Times

End = Literal["whole", "cut", "zeros", "unfinished", "reindex", "sqlite"]

SMALLEST_STEP_BACK = 10**9
"""Log times fall by less in any recording: several threads write it [ns]."""


class Damage:
    """Collects what was met while a file is read; read again for its sentences.

    Attributes:
        end: how the file ends.
        end_at: where it ends, or where the zeros begin [bytes].
        lies: records that claimed an impossible length, and cost nothing.
        in_wal: messages that stand in the file beside a database.
        lacks: how much of a database is there, when it is not all.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.end: End = "whole"
        self.end_at = 0
        self.lies = 0
        self.in_wal = 0
        self.lacks = ""
        self._broken: list[tuple[int, int]] = []
        self._unreadable: list[tuple[int, int, str]] = []
        self._latest: dict[int, int] = {}
        self._seen = 0
        self._step_back: tuple[int, int, int] | None = None

    def add_broken(self, start: int, end: int) -> None:
        """Note that the messages between two log times [ns] are lost."""
        self._broken.append((start, end))

    def add_unreadable(self, at: int, end: int, why: str = "") -> None:
        """Note that some bytes of the file make no sense, or why they are not read."""
        self._unreadable.append((at, end, f": {why}" if why else ""))

    def add_times(self, times: Times, channels: Numbers) -> None:
        """Note the log times of a stretch that was read, in the order of the file.

        Only the times of one channel can go back: recorders write some topics late.
        """
        latest = self._latest
        if bool(np.all(times[:-1] <= times[1:])) and len(times):
            # Nearly always: later than all before, so that the last ones are enough.
            if int(times[0]) >= max(latest.values(), default=-1):
                latest.update(zip(channels.tolist(), times.tolist(), strict=True))
                self._seen += len(times)
                return
        pairs = zip(channels.tolist(), times.tolist(), strict=True)
        for number, (channel, time) in enumerate(pairs):
            high = latest.get(channel, -1)
            if time > high:
                latest[channel] = time
            elif high - time >= SMALLEST_STEP_BACK:
                self._note_step_back(high, time, self._seen + number)
        self._seen += len(times)

    def _note_step_back(self, high: int, low: int, before: int) -> None:
        known = self._step_back
        if known is None:
            self._step_back = (high, low, before)
        elif high - low > known[0] - known[1]:
            self._step_back = (high, low, known[2])

    def problems(
        self, start: int | None, end: int | None, cause: str = "", remedy: str = ""
    ) -> tuple[Problem, ...]:
        """Return the sentences.

        Args:
            start: log time of the first message [ns], or None.
            end: log time of the last message [ns], or None.
            cause: why nothing may be left to read; empty for no cause.
            remedy: what to do about it.
        """
        found: list[Problem] = []
        if start is None or end is None:
            if self._unreadable and not cause:
                first, last, why = self._unreadable[0]
                cause = f"bytes {first:,} to {last:,} make no sense{why}"
            found.append(no_messages(self.path, cause, remedy))
        else:
            found += self._about_end(start, end)
            found += self._about_step_back(start)
        found += self._about_inside(start or 0)
        return tuple(found)

    def _about_end(self, start: int, end: int) -> list[Problem]:
        name, shown = self.path.name, _seconds(end - start)
        if self.end == "cut":
            message = (
                f"{name} ends in the middle of a record, at byte {self.end_at:,} "
                f"(copied while recording, or the disk was full?): {shown} of it can "
                "be shown"
            )
            hint = "copy the file again from where it was recorded"
            return [Problem("warning", "file-cut", message, hint, str(self.path))]
        if self.end == "reindex":
            message = (
                f"{name} was cut off and has no index: {shown} of it can be shown; "
                "'rosbag reindex' makes the file whole again"
            )
            command = f"rosbag reindex {shlex.quote(str(self.path))}"
            hint = f"run '{command}' where ROS 1 is installed"
            return [Problem("warning", "file-cut", message, hint, str(self.path))]
        if self.end == "sqlite":
            how = f"is cut off ({self.lacks})" if self.lacks else "is damaged"
            message = f"{name} {how}: {shown} of it can be shown"
            command = f"sqlite3 {shlex.quote(str(self.path))} .recover"
            hint = f"copy the file again; '{command}' may find more"
            return [
                Problem("warning", "file-sqlite-broken", message, hint, str(self.path))
            ]
        if self.end == "zeros":
            message = (
                f"{name} has only zeros from byte {self.end_at:,} on (power cut?): "
                f"{shown} before that can be shown"
            )
            hint = "copy the file again if there is another one; the rest is lost"
            return [Problem("warning", "file-zeros", message, hint, str(self.path))]
        if self.end == "unfinished":
            return [self._unfinished()]
        return []

    def _unfinished(self) -> Problem:
        name = self.path.name
        lacks = "no index at its end"
        if not (self.path.parent / "metadata.yaml").exists():
            lacks += ", no metadata.yaml beside it"
        message = (
            f"the recorder did not finish {name} ({lacks}): it was read through once, "
            "nothing is lost but the last moments"
        )
        if self.in_wal:
            message = (
                f"the recorder did not finish {name} (no metadata.yaml beside it): "
                f"{self.in_wal:,} messages were found in {name}-wal"
            )
        hint = "end 'ros2 bag record' with Ctrl-C; 'ros2 bag reindex' repairs a folder"
        return Problem("info", "file-no-index", message, hint, str(self.path))

    def _about_inside(self, start: int) -> list[Problem]:
        name, parts = self.path.name, len(self._broken) + len(self._unreadable)
        if parts:
            times = [
                f"{_seconds(first - start)} to {_seconds(last - start)}"
                for first, last in sorted(self._broken)
            ]
            places = [
                f"bytes {first:,} to {last:,}{why}"
                for first, last, why in sorted(self._unreadable)
            ]
            listed = ", ".join([*times, *places][:5]) + (", …" if parts > 5 else "")
            count = "one part" if parts == 1 else f"{parts:,} parts"
            verb = "is" if parts == 1 else "are"
            message = f"{count} of {name} {verb} damaged and left out ({listed})"
        elif self.lies:
            message = (
                f"{name} is damaged: a record has an impossible length; the index at "
                "its end was used instead and nothing is lost"
            )
        else:
            return []
        hint = "copy the file again if there is another one"
        return [Problem("warning", "file-chunk-broken", message, hint, str(self.path))]

    def _about_step_back(self, start: int) -> list[Problem]:
        if self._step_back is None:
            return []
        high, low, before = self._step_back
        message = (
            f"the log times of {self.path.name} go back by {_seconds(high - low)}"
            f" after message {before:,}: two stretches lie over each other from "
            f"{_seconds(low - start)} to {_seconds(high - start)}"
        )
        hint = "messages are played by log time, as 'ros2 bag play' does"
        return [Problem("warning", "log-back", message, hint, str(self.path))]


def no_messages(path: Path, cause: str, remedy: str) -> Problem:
    """Say that a recording has no message, or none that can be read for a cause."""
    if cause:
        message = f"{path.name} has no message that can be read: {cause}"
        return Problem("error", "file-no-messages", message, remedy, str(path))
    return Problem(
        "error",
        "file-no-messages",
        f"{path.name} has no message: the recorder was stopped before anything came",
        "see with 'ros2 topic list' whether the recorder finds the topics "
        "(ROS_DOMAIN_ID?)",
        str(path),
    )


def _seconds(duration: int) -> str:
    return f"{duration / 1e9:.1f} s"
