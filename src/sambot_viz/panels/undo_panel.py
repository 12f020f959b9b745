"""Undo and Redo of one browser."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.panels.command import TEXT, command
from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Answer, Data, Json
from sambot_viz.rviz import DisplayConfig
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.undo import History


class UndoPanel(Panel):
    """Offers undo and redo.

    Args:
        client_id: who made the edits.
        history: keeps them.
        document: has what they touched, or no longer.
        displays: the rows that edits touch.
        roles: who may undo what everyone sees.
    """

    name = "edit"

    def __init__(
        self,
        client_id: int,
        history: History,
        document: ShownDocument,
        displays: DisplaysPanel,
        roles: Roles,
    ) -> None:
        self._history, self._id, self._roles = history, client_id, roles
        self.remade_by = (history.state(client_id),)
        self._document, self._displays = document, displays

    def data(self) -> Sequence[Data]:
        """Return what would be undone and done again, and what was touched last."""
        state = self._history.state(self._id).value
        labels = {"undo": state.undo or "", "redo": state.redo or ""}
        return [
            Data("edit/labels", labels),
            Data("edit/touched", self._touched()),
            Data("edit/key", self._history.key(self._id)),
        ]

    @command("edit/undo", name="Undo", client_local=True)
    def _undo(self) -> Answer | None:
        may_edit = self._roles.may_edit(self._id)
        return _said("Undone", self._history.undo(self._id, may_edit=may_edit))

    @command("edit/redo", name="Redo", client_local=True)
    def _redo(self) -> Answer | None:
        may_edit = self._roles.may_edit(self._id)
        return _said("Redone", self._history.redo(self._id, may_edit=may_edit))

    @command("edit/resume", TEXT, client_local=True)
    def _resume(self, key: str) -> None:
        """Take over what the page has done before it was loaded again."""
        self._history.resume(self._id, key)

    def _touched(self) -> Json:
        """Return the row that the page goes to, with another number each time."""
        state = self._history.state(self._id).value
        number, item = state.times, state.touched
        if isinstance(item, DisplayConfig) and self._document.config.holds(item):
            return {"number": number, "row": self._displays.id_of(item)}
        return None


def _said(what: str, label: str | None) -> Answer | None:
    return None if label is None else Answer(f"{what}: {label}")
