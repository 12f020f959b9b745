"""Rasterise triangles as a renderer does: the covered pixels, and their nearness.

Only front faces are drawn, as in a page. Groups of neighbouring triangles whose box is
beside the pixels, or falls between them, are dropped first, then triangles of the other
groups by the same test. The rest is filled row by row. Nothing is clipped: inside of a
triangle, the edge functions and the inverse of the distance are linear in column and
row, also for a triangle that reaches behind the eye.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np

from sambot_viz.displays.picking.rays import Array, Indices, RayGrid
from sambot_viz.displays.picking.triangle_mesh import TriangleMesh
from sambot_viz.geometry import Matrix

GROUPS = 2000
"""Groups of triangles that are looked at in one go, which bounds the memory."""
PIXELS = 1_000_000
"""Pixels of the boxes around triangles that are filled in one go, likewise."""
MARGIN = 1e-6
"""Rounding of projected points [pixels]."""


@dataclass(frozen=True, slots=True)
class Covered:
    """The pixels that some boxes or triangles may cover; all (M,).

    Attributes:
        index: their numbers.
        left: the first column.
        right: the last column.
        top: the first row.
        bottom: the last row.
    """

    index: Indices
    left: Indices
    right: Indices
    top: Indices
    bottom: Indices

    def __iter__(self) -> Iterator[tuple[int, int, int, int, int]]:
        """Number, left, right, top and bottom of each."""
        ends = (self.index, self.left, self.right, self.top, self.bottom)
        yield from zip(*(end.tolist() for end in ends), strict=True)

    def pick(self, some: Indices) -> Covered:
        """Return only some of them."""
        ends = (self.left, self.right, self.top, self.bottom)
        return Covered(self.index[some], *(end[some] for end in ends))


def nearness(grid: RayGrid, mesh: TriangleMesh, T: Matrix) -> Array:
    """Return how near a mesh is in each pixel.

    Args:
        grid: the pixels.
        mesh: what to draw.
        T: (4, 4) affine map from the mesh to the frame of the rays.

    Returns:
        (rows, columns), 1 by the distance along the ray, which is counted in multiples
        of its direction; 0 where nothing is met.
    """
    near = np.zeros((grid.rows, grid.columns))
    # A mirrored mesh shows the sides that its file has outside, as it is drawn.
    outside = -1.0 if np.linalg.det(T[:3, :3]) >= 0.0 else 1.0
    groups = covered(grid, grid.seen(mesh.group_corners, T)).index
    for start in range(0, len(groups), GROUPS):
        faces = mesh.faces_of(groups[start : start + GROUPS])
        corners = grid.seen(mesh.vertices[faces], T)
        may = covered(grid, corners)
        edges = _edges(corners[may.index], outside)
        may, edges = may.pick(edges.shown), edges.faces[edges.shown]
        for some in blocks(may):
            _fill(near, may.pick(some), edges[some])
    return near


def covered(grid: RayGrid, points: Array) -> Covered:
    """Find the pixels that M boxes or triangles, each with K corners, may cover.

    Args:
        grid: the pixels.
        points: the corners as the eye sees them (`RayGrid.seen`), (M, K, 3).
    """
    depth = points[..., 2]
    keep = _each_corner(np.maximum, depth) > 0.0
    # What crosses the plane of the eye has no outline in the picture.
    crossing = keep & (_each_corner(np.minimum, depth) <= 0.0)
    ends: list[Array] = []
    for axis, count in ((0, grid.columns), (1, grid.rows)):
        with np.errstate(divide="ignore", invalid="ignore"):
            at = points[..., axis] / depth
        low, high = _each_corner(np.minimum, at), _each_corner(np.maximum, at)
        low = np.ceil(np.maximum(low - MARGIN, 0))
        high = np.floor(np.minimum(high + MARGIN, count - 1))
        low[crossing], high[crossing] = 0, count - 1
        keep &= low <= high
        ends += [low, high]
    index = np.flatnonzero(keep)
    return Covered(index, *(end[index].astype(np.int64) for end in ends))


def _each_corner(choose: np.ufunc, values: Array) -> Array:
    """Return the lowest or highest of the values of all corners, (M, K) → (M,).

    As `choose.reduce` along the second axis, in a tenth of its time.
    """
    corners = [values[:, corner] for corner in range(values.shape[1])]
    chosen: Array = reduce(choose, corners)
    return chosen


@dataclass(frozen=True, slots=True)
class _Edges:
    """Triangles as linear functions of column and row.

    Attributes:
        faces: (M, 4, 3): for each edge a function that is not negative on the inner
            side, then the nearness; ``f · (column, row, 1)``.
        shown: the numbers of those that are seen from outside, (S,).
    """

    faces: Array
    shown: Indices


def _edges(corners: Array, outside: float) -> _Edges:
    """Return the functions of triangles (M, 3, 3), given as the eye sees them.

    Args:
        corners: (M, 3, 3).
        outside: the sign that the volume between the eye and a triangle has when the
            triangle is seen from outside.
    """
    a, b, c = (corners[:, i] for i in range(3))
    # Two triangles at an edge get opposite functions for it, so that no pixel on the
    # edge is left out.
    across = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    volume = outside * np.einsum("ij,ij->i", a, across[:, 0])
    across *= outside
    shown = np.flatnonzero(volume > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        near = across.sum(axis=1) / volume[:, None]
    return _Edges(np.concatenate([across, near[:, None]], axis=1), shown)


def blocks(may: Covered, most: int = PIXELS) -> Iterator[Indices]:
    """Yield parts of what may cover pixels, each with about `most` pixels."""
    pixels = (may.right - may.left + 1) * (may.bottom - may.top + 1)
    block = np.cumsum(pixels) // most
    cuts = np.flatnonzero(np.diff(block)) + 1
    yield from np.split(np.arange(len(block)), cuts)


def _fill(near: Array, may: Covered, faces: Array) -> None:
    """Draw triangles (M, 4, 3) into the pixels that they may cover."""
    which, row = ranges(may.top, may.bottom)
    first = may.left[which].astype(np.float64)
    last = may.right[which].astype(np.float64)
    in_row = np.ones(len(which), bool)
    for edge in range(3):
        slope, up, start = (faces[:, edge, i][which] for i in range(3))
        rest = up * row + start
        with np.errstate(divide="ignore", invalid="ignore"):
            at = -rest / slope
        first = np.where(slope > 0.0, np.maximum(first, np.ceil(at)), first)
        last = np.where(slope < 0.0, np.minimum(last, np.floor(at)), last)
        in_row &= (slope != 0.0) | (rest >= 0.0)
    span = np.flatnonzero(in_row & (first <= last))
    which, row = which[span], row[span]
    begin = first[span].astype(np.int64)
    of_span, column = ranges(begin, last[span].astype(np.int64))
    slope, up, start = (faces[:, 3, i][which] for i in range(3))
    value = slope[of_span] * column + (up * row + start)[of_span]
    pixel = (row * near.shape[1])[of_span] + column
    np.maximum.at(near.ravel(), pixel, value)


def ranges(first: Indices, last: Indices) -> tuple[Indices, Indices]:
    """Return all numbers of some ranges: of which range, and the number, both (N,)."""
    count = last - first + 1
    which = np.repeat(np.arange(len(count)), count)
    offset = first - (np.cumsum(count) - count)
    return which, np.arange(len(which)) + offset[which]
