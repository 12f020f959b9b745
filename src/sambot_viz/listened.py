"""Record a robot on the network for some seconds, for commands that look once."""

from __future__ import annotations

import tempfile
import threading
import time
from collections.abc import Collection, Mapping
from pathlib import Path
from types import MappingProxyType

from sambot_viz.errors import Problem, SourceError
from sambot_viz.outlet import write_err
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.sources.recorder import SourceRecorder
from sambot_viz.sources.websocket.runner import LONGEST_SILENCE
from sambot_viz.topics.live_files import fetch_files
from sambot_viz.topics.source_robot import SourceRobot

CONNECTED_WITHIN = LONGEST_SILENCE + 2.0
"""Time without topics after which a robot counts as absent; by then it is known whether
the peer uses another protocol [s]."""

QUIET = 1.0
"""A robot that does not answer for so long is waited for with a note [s]."""


class Listened:
    """Records all topics of a live robot: the result is a recording like any other.

    Args:
        live: the robot, not connected yet; its connection is closed afterwards.
        seconds: duration, from the time when its topics are known [s].
        at: the time to look at [s from the first message]; None takes all.

    Attributes:
        topics: name → topic of the source.
        recorded: the recording; None if no message came.
        packages: a folder with the files of the robot that its source serves.
        missing: the problems of these files.
        lost: a sentence if the robot left before the time was over.
        seconds: as given.

    Raises:
        SourceError: there is no robot, or this computer cannot store its messages.
    """

    def __init__(self, live: SourceRobot, seconds: float, at: float | None) -> None:
        self.seconds = seconds
        self.topics: Mapping[str, SourceTopic] = MappingProxyType({})
        self.recorded: SourceRobot | None = None
        self.missing: tuple[Problem, ...] = ()
        self.lost: tuple[Problem, ...] = ()
        self._folder = tempfile.TemporaryDirectory(prefix="sambot-viz-live-")
        self.packages = Path(self._folder.name, "packages")
        try:
            path = Path(self._folder.name, "messages.mcap")
            if self._listen(live, path):
                types = live.decoding.types
                heard = RecordingPlayback(open_recording(path), live.name)
                self.recorded = SourceRobot(
                    heard, types, at=at, published=self._published()
                )
                text = self.recorded.description or ""
                self.missing = fetch_files(live.source, text, self.packages)
        except BaseException:
            self.close()
            raise
        finally:
            live.close()

    def close(self) -> None:
        """Forget what came; a second call does nothing."""
        if self.recorded is not None:
            self.recorded.close()
        self._folder.cleanup()

    def _published(self) -> Collection[str]:
        """Return the topics of the robot that have a publisher, as far as is known."""
        return [
            one.name
            for one in self.topics.values()
            if one.publishers is None or one.publishers
        ]

    def _listen(self, live: SourceRobot, path: Path) -> bool:
        """Write what comes to a file; False when that is nothing."""
        source, changed = live.source, threading.Event()
        live.on_status.append(changed.set)
        live.on_topics.append(changed.set)
        recorder = SourceRecorder(source, None, changed.set, lambda text: None)
        # Before there are topics, so that nothing is missed.
        recorder.start(path)
        source.open()
        try:
            self._wait_for_topics(live, changed)
            begin = time.monotonic()
            while (left := begin + self.seconds - time.monotonic()) > 0:
                if not source.status.is_connected:
                    heard = time.monotonic() - begin
                    self.lost = (_left(live.name, heard, source.status.sentence),)
                    break
                changed.wait(left)
                changed.clear()
        finally:
            recorder.close()
        self.topics = source.topics()
        status = recorder.status
        assert status is not None
        if status.messages and status.trouble:
            raise SourceError(f"{live.name}: {status.trouble}")
        return status.messages > 0

    def _wait_for_topics(self, live: SourceRobot, changed: threading.Event) -> None:
        source, begin = live.source, time.monotonic()
        until, told = begin + CONNECTED_WITHIN, begin + QUIET
        # It may have left already: then what it said until then is shown.
        while not source.topics():
            left = until - time.monotonic()
            if left <= 0:
                none = "; it has no topic" if source.status.is_connected else ""
                raise SourceError(f"{source.status.sentence}{none}")
            if time.monotonic() >= told and not source.status.is_connected:
                told = until
                write_err(f"{source.status.sentence}; trying for {left:.0f} s more …")
            changed.wait(min(left, QUIET))
            changed.clear()


def _left(name: str, seconds: float, sentence: str) -> Problem:
    """Say that a robot left while it was listened to."""
    message = f"the connection was lost after {seconds:.1f} s: {sentence}"
    hint = "this is what came until then; look at the robot, and run the command again"
    return Problem("warning", "connection-lost", message, hint, name)
