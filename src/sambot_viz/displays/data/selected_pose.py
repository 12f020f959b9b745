"""A marker or a pose that is selected, as the Selection panel shows it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sambot_viz.displays.display import numbers
from sambot_viz.displays.picking.rays import Array, Indices
from sambot_viz.displays.picking.selected import DataFacts, Fact, SelectedData
from sambot_viz.geometry import Vector3, Wxyz


def position_text(position: Sequence[float]) -> str:
    """Return a position [m], rounded to micrometres."""
    return f"{numbers([round(value, 6) for value in position])} m"


@dataclass(frozen=True, slots=True, eq=False)
class SelectedPose(SelectedData):
    """Something with a pose, which is shown as its message has it.

    Attributes:
        title: of its rows.
        frame: of the message.
        wxyz: rotation in that frame.
        position: there [m].
        in_fixed_frame: the position there, (3,) [m].
        more: other rows.
    """

    title: str
    frame: str
    wxyz: Wxyz
    position: Vector3
    in_fixed_frame: Array
    more: Sequence[Fact] = ()

    def facts(self, numbers: Indices | None) -> Sequence[DataFacts]:
        """Return its frame, its pose there, and what else there is."""
        del numbers
        rows: list[Fact] = [
            ("Frame", self.frame),
            ("Position", position_text(self.position)),
            ("Orientation", f"{_xyzw_text(self.wxyz)} (xyzw)"),
            *self.more,
        ]
        return (DataFacts(self.title, rows, self.in_fixed_frame),)


def _xyzw_text(wxyz: Wxyz) -> str:
    w, x, y, z = wxyz
    return numbers((x, y, z, w))
