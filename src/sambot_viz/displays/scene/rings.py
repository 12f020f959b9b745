"""Open circles with a head, which show which way something turns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.picking.placed import Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.scene.ribbons import RibbonNode
from sambot_viz.displays.scene.solid_nodes import Solid, SolidsNode, arrow_solids
from sambot_viz.displays.scene.solids import Arrow, Rgb
from sambot_viz.geometry import Matrix

Floats = npt.NDArray[np.float64]
_WHOLE = 32
"""Number of lines of a whole circle."""


@dataclass(frozen=True, slots=True, eq=False)
class Ring:
    """An open circle with a head at its end.

    Attributes:
        middle: (3,) [m].
        to_head: (3,), from there to the head [m].
        to_quarter: (3,), from there to the point a quarter of the circle further; the
            head points that way [m].
        count: of the points of its line, at 11.25° from each other.
        head: length and diameter of the head [m].
        color: 0 to 255.
        alpha: 0 to 1.
    """

    middle: Floats
    to_head: Floats
    to_quarter: Floats
    count: int
    head: tuple[float, float]
    color: Rgb
    alpha: float

    @property
    def points(self) -> Floats:
        """The points of its line, (count, 3) [m]; the last one is at the head."""
        steps = np.arange(_WHOLE + 1 - self.count, _WHOLE + 1)
        angles = (2 * np.pi / _WHOLE) * steps[:, None]
        around = np.cos(angles) * self.to_head + np.sin(angles) * self.to_quarter
        return self.middle + around

    @property
    def tip(self) -> Sequence[Solid]:
        """Its head; none for one without a size."""
        if not np.any(self.to_quarter):
            return ()
        x, y, z = (self.middle + self.to_head).tolist()
        dx, dy, dz = self.to_quarter.tolist()
        arrow = Arrow((x, y, z), (dx, dy, dz), (0.0, 0.0), self.head)
        return arrow_solids(arrow, self.color, self.alpha)


class RingsNode:
    """Rings in two nodes, and solids beside them.

    Args:
        scene: where to draw.
        name: what the names of the nodes begin with.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self._lines = RibbonNode(scene, f"{name}r")
        self._solids = SolidsNode(scene, f"{name}s")

    def draw(
        self, rings: Sequence[Ring], width: float, solids: Sequence[Solid] = ()
    ) -> None:
        """Draw rings and solids, and nothing else.

        Args:
            rings: in the frame of the node above.
            width: of their lines [m].
            solids: likewise.
        """
        self._solids.draw([*solids, *(part for ring in rings for part in ring.tip)])
        if not rings:
            self._lines.remove()
            return
        counts = [ring.count for ring in rings]
        colors = [(*ring.color, 255 * ring.alpha) for ring in rings]
        points = np.concatenate([ring.points for ring in rings])
        self._lines.draw(
            points, width, np.repeat(colors, counts, axis=0), counts=counts
        )

    def placed(
        self, T_fixed_above: Matrix, item: Selectable | None
    ) -> Iterator[Placed]:
        """Yield rings and solids for rays (see `scene.points.PointNode.placed`)."""
        yield from self._lines.placed(T_fixed_above, item)
        yield from self._solids.placed(T_fixed_above, item)

    def remove(self) -> None:
        """Take everything out of the scene."""
        self._lines.remove()
        self._solids.remove()
