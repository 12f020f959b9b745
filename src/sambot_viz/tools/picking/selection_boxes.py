"""The cyan boxes that RViz draws around a selection."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.picking.rays import Array
from sambot_viz.displays.picking.selectable import Selectable

CYAN = (0, 255, 255)


class SelectionBoxes:
    """One box of lines per selected item, which turns with it.

    RViz's boxes are along the axes of the fixed frame, and up to twice as long.

    Args:
        scene: where they are drawn.
        name: what the names of the nodes begin with.
        color: of the lines.
        thickness: of the lines [pixels].
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        name: str = "selected",
        color: tuple[int, int, int] = CYAN,
        thickness: float = 1.5,
    ) -> None:
        self._scene = scene
        self._name, self._color, self._thickness = name, color, thickness
        self._drawn: dict[Selectable, tuple[bytes, viser.LineSegmentsHandle]] = {}

    def draw(self, boxes: Mapping[Selectable, Array]) -> None:
        """Draw these boxes and no others; a box that has not moved is not sent again.

        Args:
            boxes: item → the edges of its box or boxes, (N, 2, 3) [m].
        """
        for item in [item for item in self._drawn if item not in boxes]:
            self._drawn.pop(item)[1].remove()
        for item, edges in boxes.items():
            lines = edges.astype(np.float32)
            known = self._drawn.get(item)
            if known is None:
                self._drawn[item] = (lines.tobytes(), self._add(lines))
            elif known[0] != lines.tobytes():
                known[1].points = lines
                self._drawn[item] = (lines.tobytes(), known[1])

    def _add(self, lines: npt.NDArray[np.float32]) -> viser.LineSegmentsHandle:
        # Few names: viser keeps the removal of each for some time.
        used = {handle.name for _, handle in self._drawn.values()}
        names = (f"/~{self._name}{n}" for n in itertools.count(1))
        return self._scene.add_line_segments(
            next(name for name in names if name not in used),
            lines,
            colors=self._color,
            thickness=self._thickness,
            thickness_units="screen",
        )
