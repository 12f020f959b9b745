"""What the Add dialog needs: the types of displays, and adding one."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sambot_viz.displays.not_shown import NOT_SHOWN, REASON
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.errors import UsageError
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


class AddDisplayPanel(Panel):
    """The types, and which display was added last.

    Args:
        session: what displays are added to.
        id_of: the id of a display's row.
        remake: called when a display was added.
    """

    name = "add"

    def __init__(
        self,
        session: Session,
        id_of: Callable[[DisplayConfig], str],
        remake: Callable[[Panel], None],
    ) -> None:
        self._session = session
        self._id_of = id_of
        self._remake = remake
        self._added: Json = None

    def rows(self) -> Sequence[Row]:
        """Data for the dialog, and its action."""
        return [
            Row("displays/types", "", "names", value=TYPES),
            Row("displays/added", "", "names", value=self._added),
            Row(
                "displays/add",
                "",
                "action",
                "Add",
                takes=(str, str, str),
                set=lambda sent: self._add(*sent),
            ),
        ]

    def _add(self, kind: str, name: str, mark: str) -> None:
        """Add a display at the end; the page that sent the mark selects it."""
        if kind not in DISPLAYS:
            raise UsageError(f"displays of type {row_text(kind)} cannot be added")
        config = self._session.add_display(kind, name=name.strip() or None)
        self._added = {"mark": mark, "row": self._id_of(config)}
        self._remake(self)
