"""How the connection to a live robot is, for the line below the view."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Data
from sambot_viz.session.data.robot_data import LiveData
from sambot_viz.topics.live_reasons import lagging


class SourcePanel(Panel):
    """Says what is connected, what is missing, and what was lost.

    Args:
        live: the messages of the robot.
    """

    name = "source"

    def __init__(self, live: LiveData) -> None:
        self.remade_by = (live.status,)
        self._live = live

    def data(self) -> Sequence[Data]:
        """Return the sentence of the source, and whether messages can come."""
        robot = self._live.live
        if robot is None:
            return []
        status, sentence = robot.source.status, robot.sentence
        behind = lagging(status.dropped + self._live.lost, "this computer")
        if behind is not None:
            sentence += f"; {behind.text}"
        return [
            Data(
                "source/status",
                {
                    "name": robot.name,
                    "connected": status.is_connected,
                    "sentence": sentence,
                },
            )
        ]
