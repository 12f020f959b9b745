"""Boxes that nothing leads to, in rows from left to right."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.graph.layered import Point, Vertex

_GAP, _ROW_GAP = 24.0, 14.0


def shelves(vertices: Sequence[Vertex], width: float) -> list[Point]:
    """Return the centres of boxes, in rows that are as wide as the widest box at least.

    Args:
        vertices: the boxes.
        width: of a row; the next box after it begins another one.
    """
    centres: list[Point] = []
    x = y = height = 0.0
    for vertex in vertices:
        if x and x + vertex.width > width:
            x, y, height = 0.0, y + height + _ROW_GAP, 0.0
        centres.append((x + vertex.width / 2, y + vertex.height / 2))
        x += vertex.width + _GAP
        height = max(height, vertex.height)
    return centres
