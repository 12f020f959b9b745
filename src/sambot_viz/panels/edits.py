"""Undo and Redo of one browser."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Row
from sambot_viz.session import Session
from sambot_viz.session.browser import Browser


class UndoPanel(Panel):
    """What can be undone and done again.

    Args:
        session: whose edits these are.
        browser: who made them.
    """

    name = "edit"
    remade_by = frozenset({"edits"})

    def __init__(self, session: Session, browser: Browser) -> None:
        self._edits, self._id = session.edits, browser.client_id

    def rows(self) -> Sequence[Row]:
        """Undo and Redo, with what they would do."""
        undo, redo = self._edits.undo_label(self._id), self._edits.redo_label(self._id)
        return [
            Row(
                "edit/undo",
                "",
                "action",
                "Undo",
                value=undo or "",
                enabled=undo is not None,
                set=lambda _: self._edits.undo(self._id),
            ),
            Row(
                "edit/redo",
                "",
                "action",
                "Redo",
                value=redo or "",
                enabled=redo is not None,
                set=lambda _: self._edits.redo(self._id),
            ),
        ]
