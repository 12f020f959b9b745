"""Lists that rows of the page choose from: the frames there are."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Row
from sambot_viz.session import Session


class NamesPanel(Panel):
    """The frames, for every row whose value is a frame.

    Args:
        session: whose frames these are.
    """

    name = "names"
    remade_by = frozenset({"robot", "frames"})

    def __init__(self, session: Session) -> None:
        self._session = session

    def rows(self) -> Sequence[Row]:
        """One list."""
        frames = sorted(self._session.tree.frames)
        return [Row("names/frames", "", "names", value=frames)]
