"""Report in the terminal, once, what the command names but does not exist."""

from __future__ import annotations

import threading
from collections.abc import Callable

from sambot_viz.errors import did_you_mean
from sambot_viz.inputs import Inputs
from sambot_viz.outlet import write_err
from sambot_viz.server.sessions import Sessions
from sambot_viz.sources.joined import each_of
from sambot_viz.sources.source import Source

PERIOD = 0.5
"""Time between two looks [s]; an attempt to connect takes longer."""
SETTLED = 10
"""Number of looks after which a live robot has published its frames."""


def write_notes(stop: threading.Event, inputs: Inputs, sessions: Sessions) -> None:
    """Write a line about missing data, as soon as it is certainly missing.

    Args:
        stop: ends the wait when it is set.
        inputs: the sources, and the fixed frame of the command line.
        sessions: the sessions, which know the frames.
    """
    waiting: list[Callable[[], bool]] = []
    if inputs.live is not None:
        lives = [one for one in each_of(inputs.live.source) if one.live is not None]
        waiting += [_SourceNote(one).look for one in lives]
    if inputs.options.names_wheels:
        waiting.append(_WheelsNote(sessions).look)
    if inputs.options.fixed_frame is not None:
        waiting.append(_FrameNote(inputs, sessions).look)
    while waiting and not stop.wait(PERIOD):
        waiting = [look for look in waiting if not look()]


class _SourceNote:
    def __init__(self, source: Source) -> None:
        self._source = source

    def look(self) -> bool:
        """Return whether the source answers, or was reported not to."""
        status = self._source.status
        if status.is_connected:
            return True
        # The time to the next attempt is only known after one has failed.
        if status.retry_s is not None:
            write_err(f"sambot-viz: note: {status.sentence}; the page goes on trying")
        return status.retry_s is not None


class _WheelsNote:
    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions

    def look(self) -> bool:
        """Return whether a robot has the wheels, or was reported not to."""
        for session in self._sessions.all()[:1]:
            if session.robot.model is None:
                return False
            for problem in session.drive.problems:
                write_err(f"sambot-viz: note: wheels to drive with: {problem.message}")
            return True
        return False


class _FrameNote:
    def __init__(self, inputs: Inputs, sessions: Sessions) -> None:
        self._frame = str(inputs.options.fixed_frame)
        self._looks = 1 if inputs.live is None else SETTLED
        self._sessions = sessions

    def look(self) -> bool:
        """Return whether the frame exists, or was reported not to."""
        for session in self._sessions.all()[:1]:
            with session.lock:
                status = session.scene.global_status()
                frames = sorted(session.scene.context.tree.frames)
                chosen = session.scene.context.fixed_frame == self._frame
            if status.level == "Ok" or not chosen:
                return True
            self._looks -= bool(frames)
            if self._looks <= 0:
                offered = did_you_mean(self._frame, frames)
                write_err(
                    f"sambot-viz: note: no fixed frame '{self._frame}' (-f): {offered}"
                )
                return True
        return False
