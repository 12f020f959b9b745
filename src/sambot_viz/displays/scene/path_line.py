"""A line on the floor that grows at its end, such as the way of a robot."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import viser

from sambot_viz.displays.scene.node_cache import any_gone, remove_all

COLOR = (255, 170, 0)
WIDTH = 0.012
HEIGHT = 0.004
"""Height above the floor, so that the grid does not hide the line [m]."""
PIECE = 200
"""Points of one node: only the newest node is sent again."""


class PathLine:
    """Draws a growing list of points.

    Args:
        scene: where to draw.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._pieces: list[viser.LineSegmentsHandle] = []
        self._drawn = 1

    def draw(self, above: str | None, points: Sequence[tuple[float, float]]) -> bool:
        """Draw what is new; a list that became shorter is drawn from the start.

        Args:
            above: the node of the frame that the points are in; None draws nothing.
            points: x, y [m].

        Returns:
            Whether something was sent.
        """
        forgotten = False
        if any_gone(self._pieces) or len(points) < self._drawn:
            self.remove()
            forgotten = True
        if above is None or len(points) == self._drawn:
            return forgotten
        first = (self._drawn - 1) // PIECE
        for number in range(first, (len(points) - 2) // PIECE + 1):
            start = number * PIECE
            piece = np.array(points[start : start + PIECE + 1], np.float32)
            self._draw_piece(f"{above}/~drive{number}", number, piece)
        self._drawn = len(points)
        return True

    def remove(self) -> None:
        """Remove the line from the scene."""
        remove_all(self._pieces)
        self._pieces.clear()
        self._drawn = 1

    def _draw_piece(self, name: str, number: int, piece: np.ndarray) -> None:
        flat = np.column_stack([piece, np.full(len(piece), HEIGHT, np.float32)])
        segments = np.stack([flat[:-1], flat[1:]], axis=1)
        if number < len(self._pieces):
            self._pieces[number].points = segments
        else:
            node = self._scene.add_line_segments(
                name, segments, colors=COLOR, thickness=WIDTH
            )
            self._pieces.append(node)
