"""The Selection panel of one client: facts about the selected items."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from sambot_viz.displays.picking.selected import Fact
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Json, Row
from sambot_viz.panels.selection.entries import SelectedEntries, SelectedEntry
from sambot_viz.rviz import FIXED_FRAME, TfFrameProperty
from sambot_viz.session.clients.client import Client
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Signal

SHOWN = 30
"""At most this many selected items are listed."""
SHORT = 3
"""Number of items from which their rows begin folded."""
IN_TABLE = 10
"""At most this many items are in the table of distances; more points have none."""
_GAP = 2
"""Spaces between the columns of the table, at least."""
_FRAME = TfFrameProperty(
    "Relative to",
    default=FIXED_FRAME,
    help="The frame in which the poses of links and frames are shown.",
)


class SelectionPanel(Panel):
    """Lists the selection, and how far the selected items are apart.

    Args:
        client: whose selection it is.
        remake: called when another frame was chosen.
    """

    name = "selection"
    # As often as RViz.
    period = 0.2

    def __init__(
        self,
        client: Client,
        scene: Scene,
        robot: RobotState,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (scene.frames, robot.changed, client.tools.changed)
        self._client = client
        self._scene = scene
        self._robot = robot
        self._remake = remake
        self._frame: str = FIXED_FRAME
        self._entries = SelectedEntries(client.tools, scene, robot)

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The poses of what is selected, and messages where data is."""
        items = self._client.tools.selection
        signals: list[Signal[Any]] = [self._robot.positions] if items else []
        if any(item.is_data for item in items):
            signals.append(self._scene.data)
        return signals

    def rows(self) -> Sequence[Row]:
        """Return the frame of the poses, then a row per item with its facts."""
        items, count = self._client.tools.selection, self._entries.count
        if not items:
            return [Row("selection/none", "", "note", value=_NOTHING)]
        made: list[Row] = []
        if not all(item.is_data for item in items):
            made.append(self._frame_row())
        entries = self._shown()
        made.extend(self._distances(entries, count))
        for one in entries:
            expanded = count < SHORT
            made.append(
                Row(one.id, "", "group", one.title, icon=one.kind, expanded=expanded)
            )
            made.extend(_fact_rows(one.id, one.id, one.facts))
        if count > SHOWN:
            more = f"and {count - SHOWN} more"
            made.append(Row("selection/more", "", "note", value=more))
        return made

    def values(self) -> dict[str, Json]:
        """Return the values that a motion or a message may have changed."""
        entries = self._shown()
        made = [*self._distances(entries, self._entries.count)]
        for one in entries:
            made.extend(_fact_rows(one.id, "", one.facts))
        return {row.id: row.value for row in made}

    def _shown(self) -> list[SelectedEntry]:
        return self._entries.first(SHOWN, self._scene.context.frame(self._frame))

    def _frame_row(self) -> Row:
        return Row(
            "selection/frame",
            "",
            "frame",
            _FRAME.name,
            value=self._frame,
            options=(FIXED_FRAME,),
            help=_FRAME.help,
            client_local=True,
            set=self._set_frame,
        )

    def _set_frame(self, frame: str) -> None:
        self._frame = _FRAME.coerce(frame)
        self._remake(self)

    def _distances(self, entries: Sequence[SelectedEntry], count: int) -> Iterator[Row]:
        """Yield how far two items are apart, or a table of more of them."""
        if len(entries) == 2:
            yield from _fact_rows("apart", "", self._entries.apart(*entries))
        is_data = any(one.position is not None for one in entries)
        if len(entries) < SHORT or (is_data and count > IN_TABLE):
            return
        yield Row("apart", "", "group", "Distances [m]", expanded=True)
        # A link and its frame are at one place.
        places = {(one.name, one.position is None): one for one in entries[:IN_TABLE]}
        table = self._table([*places.values()])
        copied = {"copy": True}
        yield Row("apart/table", "apart", "lines", "Distances", table, extra=copied)
        if count > IN_TABLE:
            said = f"of the first {IN_TABLE} items"
            yield Row("apart/more", "apart", "note", value=said)

    def _table(self, entries: Sequence[SelectedEntry]) -> str:
        """Return the distances of all pairs [m], the columns by number."""
        width = max(len(one.name) for one in entries)
        rows = [
            [str(number) for number in range(1, len(entries) + 1)],
            *(
                [self._entries.length(one, other) for other in entries]
                for one in entries
            ),
        ]
        # Of small distances four digits are longer than those of others.
        cell = _GAP + max(len(part) for row in rows for part in row)
        heads, *parts = ["".join(f"{part:>{cell}}" for part in row) for row in rows]
        names = [
            f"{number:>2} {one.name:<{width}}" for number, one in enumerate(entries, 1)
        ]
        lines = [name + row for name, row in zip(names, parts, strict=True)]
        return "\n".join([" " * (width + 3) + heads, *lines])


def _fact_rows(prefix: str, parent: str, facts: Iterable[Fact]) -> Iterator[Row]:
    """Yield the rows of some facts; names such as "Visual" may occur twice."""
    for number, (name, value) in enumerate(facts):
        kind = "readonly" if isinstance(value, str) else "color"
        yield Row(f"{prefix}/{number}", parent, kind, name, value)


_NOTHING = (
    "Nothing is selected. Choose Select (S), then click on a link, a frame, a point or "
    "a marker, or drag a rectangle. Shift adds, Ctrl takes away."
)
