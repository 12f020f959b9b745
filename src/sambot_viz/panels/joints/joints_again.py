"""What a page needs to bring the joints back after the program was started again."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import zip_longest
from typing import Any

from sambot_viz.errors import UsageError
from sambot_viz.panels.gate import checked
from sambot_viz.panels.joints.joints import joint_id
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Answer, Json, Row
from sambot_viz.session import Session

_AGAIN = "joints/again"


class JointsAgainPanel(Panel):
    """Takes the positions of a page that was there before, as long as nothing moved.

    So a user of now is never disturbed, and of two pages that come back the first one
    brings the joints back.

    Args:
        session: whose joints these are.
        row: finds the row of a joint, by its id.
    """

    name = "joints_again"

    def __init__(self, session: Session, row: Callable[[str], Row | None]) -> None:
        signals = session.signals
        self.remade_by = (signals.robot,)
        self.moved_by = (signals.joints,)
        self._session = session
        self._row = row

    def rows(self) -> Sequence[Row]:
        """Where the joints were at first, if not at 0, and how to move them."""
        session = self._session
        if session.joints is None:
            return []
        first = {joint_id(n): q for n, q in session.first_positions.items() if q != 0}
        return [
            Row("joints/first", "", "names", value=first),
            Row(
                _AGAIN,
                "",
                "action",
                value=not session.joints_moved,
                takes=(list, list),
                set=self._bring_back,
            ),
        ]

    def values(self) -> Mapping[str, Json]:
        """Whether nothing has moved a joint yet."""
        return {_AGAIN: not self._session.joints_moved}

    def _bring_back(self, arguments: tuple[list[Any], list[Any]]) -> Answer | None:
        """Move the joints of these rows to these positions."""
        if self._session.joints_moved:
            return None
        positions: dict[str, float] = {}
        for row_id, position in zip_longest(*arguments):
            row = self._row(row_id)
            if row is None or row.kind != "slider" or row.id != joint_id(row.name):
                raise UsageError("this robot does not have these joints")
            positions[row.name] = checked(row, position)
        self._session.set_joint_positions(positions, "Joints as before the restart")
        return Answer("The joints are where they were; Undo puts them at their start")
