"""The panel of what was sent to a live robot: when, by whom, where and what."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json, Row
from sambot_viz.publishing.publisher import Publisher
from sambot_viz.publishing.sent_lines import SentLines
from sambot_viz.session.signals import Signal
from sambot_viz.text import text


class SentPanel(Panel):
    """The last messages that went to the robot; empty where nothing may be sent.

    Args:
        publisher: the way to the robot.
        sent: the last messages.
        sending: something was sent.
        driven: there is another robot, or none.
    """

    name = "sent"
    period = 0.5

    def __init__(
        self,
        publisher: Publisher,
        sent: SentLines,
        sending: Signal[Any],
        driven: Signal[Any],
    ) -> None:
        self.remade_by = (driven,)
        self._publisher, self._sent, self._sending = publisher, sent, sending

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """That something was sent."""
        return (self._sending,)

    def rows(self) -> Sequence[Row]:
        """Return a note, so that there is a tab; the lines are data."""
        if not self._publisher.sends_anything:
            return []
        return [Row("sent/note", "", "note", value="The newest is at the top.")]

    def data(self) -> Sequence[Data]:
        """Return the lines, the newest first."""
        if not self._publisher.sends_anything:
            return []
        return [Data("sent/lines", self._lines())]

    def values(self) -> Mapping[str, Json]:
        """Return the lines, a moment after something was sent."""
        return {"sent/lines": self._lines()} if self._publisher.sends_anything else {}

    def _lines(self) -> Json:
        return [
            {
                "time": round(one.time, 1),
                "who": text(one.who, 60),
                "topic": text(one.topic, 80),
                "type": text(one.type_name, 80),
                "values": one.values,
                "count": one.count,
            }
            for one in self._sent.newest_first
        ]
