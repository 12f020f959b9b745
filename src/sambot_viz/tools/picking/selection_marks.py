"""The cyan boxes around what is selected (spec/rviz-views-tools.md §2.6)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.tools.picking.raycast import Array
from sambot_viz.tools.tool import Thing

CYAN = (0, 255, 255)
CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
EDGES = np.array(
    [
        (a, b)
        for a in range(8)
        for b in range(a + 1, 8)
        if np.abs(CORNERS[a] - CORNERS[b]).sum() == 1
    ]
)


class SelectionMarks:
    """One box of lines per selected thing, along the axes of the fixed frame."""

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._drawn: dict[Thing, tuple[bytes, viser.LineSegmentsHandle]] = {}
        self._count = 0

    def draw(self, boxes: Mapping[Thing, tuple[Array, Array]]) -> None:
        """Bring the boxes in line; a box that has not moved is not sent again."""
        for thing in [thing for thing in self._drawn if thing not in boxes]:
            self._drawn.pop(thing)[1].remove()
        for thing, (low, high) in boxes.items():
            lines = box_lines(low, high)
            known = self._drawn.get(thing)
            if known is None:
                self._count += 1
                handle = self._scene.add_line_segments(
                    f"/~selected{self._count}",
                    lines,
                    colors=CYAN,
                    thickness=1.5,
                    thickness_units="screen",
                )
                self._drawn[thing] = (lines.tobytes(), handle)
            elif known[0] != lines.tobytes():
                known[1].points = lines
                self._drawn[thing] = (lines.tobytes(), known[1])


def box_lines(low: Array, high: Array) -> npt.NDArray[np.float32]:
    """The twelve edges of a box, (12, 2, 3) float32 [m]."""
    points = low + CORNERS * (high - low)
    return points[EDGES].astype(np.float32)
