"""Points of a cloud that are selected, as the Selection panel shows them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sambot_viz.displays.data.cloud.cloud import Cloud, Values
from sambot_viz.displays.data.selected_pose import position_text
from sambot_viz.displays.picking.rays import Array, Indices
from sambot_viz.displays.picking.selected import (
    Cubes,
    DataFacts,
    Fact,
    SelectedData,
)
from sambot_viz.geometry import Matrix

DOT = 0.004
"""Edge of the box around a point that has a size on the screen [m], as in RViz."""
COLORS = ("rgb", "rgba")
"""Fields with a colour in four bytes."""


@dataclass(frozen=True, slots=True, eq=False)
class SelectedPoints(SelectedData):
    """Points of one message.

    Attributes:
        cloud: the points.
        T_fixed_cloud: (4, 4), where they are drawn.
        name: of their display.
        frame: in which their positions are shown.
        message: which one it is.
        edge: of the box around each [m].
        is_by_depth: whether that is at z = 1 m, and grows with z.
    """

    cloud: Cloud
    T_fixed_cloud: Matrix
    name: str
    frame: str
    message: Sequence[Fact]
    edge: float
    is_by_depth: bool = False

    def facts(self, numbers: Indices | None) -> Sequence[DataFacts]:
        """Return the position and the fields of some points."""
        if numbers is None:
            return ()
        places = self._in_fixed_frame(numbers)
        return [
            DataFacts(f"Point {number} [{self.name}]", [*self._rows(row)], place)
            for number, row, place in zip(
                numbers.tolist(),
                self.cloud.rows_of(numbers).tolist(),
                places,
                strict=True,
            )
        ]

    def cubes(self, numbers: Indices) -> Cubes:
        """Return a box around each of some points."""
        edges = np.full(len(numbers), self.edge)
        if self.is_by_depth:
            edges *= np.abs(self.cloud.points[self.cloud.rows_of(numbers), 2])
        return Cubes(self._in_fixed_frame(numbers), edges)

    def _in_fixed_frame(self, numbers: Indices) -> Array:
        points = self.cloud.points[self.cloud.rows_of(numbers)].astype(np.float64)
        T = self.T_fixed_cloud
        found: Array = np.einsum("ij,nj->ni", T[:3, :3], points) + T[:3, 3]
        return found

    def _rows(self, row: int) -> Iterator[Fact]:
        yield from self.message
        yield "Frame", self.frame
        yield "Position", position_text(self.cloud.points[row].tolist())
        for name, values in self.cloud.fields.items():
            label, value = f"{self.cloud.number_of(name)}: {name}", values[row]
            if name in COLORS and value.dtype.itemsize == 4:
                alpha, red, green, blue = _channels(value)
                yield label, (red, green, blue)
                yield "alpha", f"{alpha / 255:.5g}"
            elif np.issubdtype(value.dtype, np.integer):
                yield label, str(value)
            else:
                yield label, f"{value:.6g}"


def stamp_text(stamp_ns: int | None) -> str:
    """Return a stamp [ns] in seconds, all digits of it; None is the latest time."""
    seconds, rest = divmod(stamp_ns or 0, 1_000_000_000)
    return f"{seconds}.{rest:09d} s"


def _channels(value: Values) -> tuple[int, int, int, int]:
    """Return alpha, red, green and blue out of four bytes, 0 to 255."""
    packed = int.from_bytes(value.tobytes(), "little")
    return (packed >> 24, packed >> 16 & 255, packed >> 8 & 255, packed & 255)
