"""Adding and copying displays: the types there are, and what was made last."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sambot_viz.displays.not_shown import NOT_SHOWN, REASON
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.errors import UsageError
from sambot_viz.panels.displays.displays import DisplaysPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Json, Row
from sambot_viz.rviz import DisplayConfig
from sambot_viz.rviz.class_name import row_text
from sambot_viz.session import Session

TYPES: list[Json] = [
    *({"kind": kind, "help": display.help} for kind, display in DISPLAYS.items()),
    *({"kind": kind, "help": help, "why": REASON} for kind, help in NOT_SHOWN.items()),
]
"""`why` says why a type cannot be added."""


class NewDisplaysPanel(Panel):
    """What the Add dialog and Duplicate need.

    Each page sends a mark with what it asks for, and selects the row that comes back
    with its mark.

    Args:
        session: what displays are added to.
        displays: the rows of the displays.
        remake: called when a display was made.
    """

    name = "add"

    def __init__(
        self,
        session: Session,
        displays: DisplaysPanel,
        remake: Callable[[Panel], None],
    ) -> None:
        self._session = session
        self._displays = displays
        self._remake = remake
        self._made: Json = None

    def rows(self) -> Sequence[Row]:
        """Data for the dialog, and the two actions."""
        return [
            Row("displays/types", "", "names", value=TYPES),
            Row("displays/made", "", "names", value=self._made),
            Row(
                "displays/add",
                "",
                "action",
                "Add",
                takes=(str, str, str),
                set=lambda sent: self._add(*sent),
            ),
            Row(
                "displays/duplicate",
                "",
                "action",
                "Duplicate",
                takes=(str, str),
                set=lambda sent: self._duplicate(*sent),
            ),
        ]

    def _add(self, kind: str, name: str, mark: str) -> None:
        """Add a display at the end."""
        if kind not in DISPLAYS:
            raise UsageError(f"displays of type {row_text(kind)} cannot be added")
        self._note(self._session.add_display(kind, name=name.strip() or None), mark)

    def _duplicate(self, row_id: str, mark: str) -> None:
        """Copy a display, behind it."""
        config = self._displays.display_of(row_id)
        self._note(self._session.duplicate_display(config), mark)

    def _note(self, config: DisplayConfig, mark: str) -> None:
        self._made = {"mark": mark, "row": self._displays.id_of(config)}
        self._remake(self)
