"""What the status bar shows to everyone: what is being read."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Row
from sambot_viz.session import Session


class StatusBarPanel(Panel):
    """Data of the status bar; its hint is a row of each browser.

    Args:
        session: what is shown.
    """

    name = "statusbar"

    def __init__(self, session: Session) -> None:
        signals = session.signals
        self.remade_by = (signals.status, signals.robot)
        self._session = session

    def rows(self) -> Sequence[Row]:
        """How many files of how many are read."""
        progress = self._session.context.assets.progress
        return [Row("statusbar/progress", "", "names", value=progress)]
