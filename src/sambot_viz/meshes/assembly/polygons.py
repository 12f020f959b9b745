"""Cutting polygons into triangles."""

from __future__ import annotations

import mapbox_earcut
import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.assembly.arrays import triples
from sambot_viz.meshes.assembly.assemble import Floats, Ints
from sambot_viz.meshes.source import MeshBudget

_Triangles = npt.NDArray[np.int64]


def triangulate(
    counts: Ints, points: Floats | None = None, budget: MeshBudget | None = None
) -> _Triangles:
    """Cut polygons into triangles.

    Convex polygons become fans, as in Assimp. The others are cut by mapbox_earcut,
    whose time stays reasonable for outlines that cross themselves.

    Args:
        counts: (P,) corners of each polygon; fewer than three give no triangle.
        points: (sum of counts, 3) positions of the corners one after the other.
            When given, polygons that are not convex are cut properly.
        budget: pays for that; polygons beyond it become fans.

    Returns:
        (M, 3) indices into the list of corners.
    """
    counts = counts.astype(np.int64)
    if len(counts) and np.all(counts == 3):
        return triples(len(counts))
    starts = np.cumsum(counts) - counts
    pieces = np.maximum(counts - 2, 0)
    first = np.repeat(starts, pieces)
    step = np.arange(len(first)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    fans = np.column_stack([first, first + step + 1, first + step + 2])
    if points is None or not np.any(counts > 3):
        return fans
    points = np.nan_to_num(points.astype(np.float64))
    outline = _Outlines(counts, starts, points)
    cut: list[_Triangles] = []
    done: list[int] = []
    for polygon in outline.dented:
        if budget is not None and not budget.may_cut(int(counts[polygon])):
            break
        triangles = outline.cut(int(polygon))
        if len(triangles):
            cut.append(triangles)
            done.append(int(polygon))
    keep = ~np.isin(np.repeat(np.arange(len(counts)), pieces), done)
    return np.concatenate([fans[keep], *cut])


class _Outlines:
    """Polygons seen along their normals.

    Attributes:
        dented: the polygons that have an inward corner.
    """

    def __init__(
        self, counts: Ints, starts: Ints, points: npt.NDArray[np.float64]
    ) -> None:
        owner = np.repeat(np.arange(len(counts)), counts)
        index = np.arange(len(owner))
        following = index + 1
        following[(starts + counts - 1)[counts > 0]] = starts[counts > 0]
        before = np.empty_like(index)
        before[following] = index
        turn = np.cross(points - points[before], points[following] - points)
        normal = np.zeros((len(counts), 3))
        np.add.at(normal, owner, np.cross(points, points[following]))
        bend = np.einsum("ij,ij->i", turn, normal[owner])
        size = np.einsum("ij,ij->i", normal, normal)[owner]
        inward = (bend < -1e-6 * size) & (counts[owner] > 3)
        self.dented = np.unique(owner[inward])
        self._counts, self._starts = counts, starts
        # The plane of two axes in which each polygon is largest; y, z for x and so on.
        across = np.argmax(np.abs(normal), axis=1)
        self._turned = normal[np.arange(len(normal)), across] < 0
        self._flat = np.column_stack(
            [points[index, (across[owner] + k) % 3] for k in (1, 2)]
        )

    def cut(self, polygon: int) -> _Triangles:
        """Return the triangles of one polygon, facing as the polygon does."""
        start, count = self._starts[polygon], self._counts[polygon]
        flat = self._flat[start : start + count]
        corners = mapbox_earcut.triangulate_float64(
            flat, np.array([count], dtype=np.uint32)
        )
        triangles = start + np.reshape(corners, (-1, 3)).astype(np.int64)
        return triangles[:, ::-1] if self._turned[polygon] else triangles
