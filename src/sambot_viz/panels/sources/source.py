"""How the connection to a live robot is, for the line below the view."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sambot_viz.panels.command import command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json
from sambot_viz.session.data.robot_data import RobotData
from sambot_viz.session.signals import Signal
from sambot_viz.topics.live_reasons import lagging

CLOCK = "source/clock"


class SourcePanel(Panel):
    """Says what is connected, missing, lost and recorded; starts and stops recordings.

    Args:
        data: the messages of a live robot.
        offers_recording: whether users of this session may record, if the command
            line has named a folder for it.
    """

    name = "source"
    period = 1.0

    def __init__(self, data: RobotData, offers_recording: bool = False) -> None:
        self.remade_by = (data.status,)
        self._data = data
        self._offers_recording = offers_recording
        self._recorder = data.moved_by.recorder

    def data(self) -> Sequence[Data]:
        """Return the sentence of the source, and whether messages can come."""
        robot = self._data.moved_by
        status, sentence = robot.source.status, robot.sentence
        if status.retry_s is not None and not status.is_connected:
            sentence += f"; next attempt in {max(1, round(status.retry_s))} s"
        if self._data.doubt is not None:
            sentence += f"; {self._data.doubt.text}"
        behind = lagging(status.dropped + self._data.inbox.lost, "this computer")
        if behind is not None:
            sentence += f"; {behind.text}"
        return [
            Data(
                "source/status",
                {
                    "name": robot.name,
                    "connected": status.is_connected,
                    "sentence": sentence,
                    "recording": self._recording(),
                },
            ),
            Data(CLOCK, self._clock()),
        ]

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The clock of the robot, when a page cannot know it by itself."""
        return (self._data.clock.state,)

    def values(self) -> dict[str, Json]:
        """Return the time of the robot."""
        return {CLOCK: self._clock()}

    def _clock(self) -> Json:
        state = self._data.clock.state.value
        return {"simulated": state.simulated, "time": state.time, "rate": state.rate}

    def _recording(self) -> Json:
        """Return how the present or last recording is; None without one."""
        status = None if self._recorder is None else self._recorder.status
        if status is None:
            return None
        return {
            "name": status.name,
            "running": status.is_running,
            "seconds": int(status.seconds),
            "size": status.size,
            "trouble": status.trouble or status.missing,
        }

    def offers(self, command_id: str) -> bool:
        """Offer to begin, or to end, what the command line allows to record."""
        recorder = self._recorder
        if recorder is None or recorder.folder is None or not self._offers_recording:
            return False
        status = recorder.status
        is_running = status is not None and status.is_running
        return is_running == (command_id == "source/stop")

    @command("source/record", name="Record")
    def _record(self) -> None:
        if self._recorder is not None:
            self._recorder.start()

    @command("source/stop", name="Stop recording")
    def _stop(self) -> None:
        if self._recorder is not None:
            self._recorder.stop(wait=False)
