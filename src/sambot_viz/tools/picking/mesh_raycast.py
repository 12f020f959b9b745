"""Where a grid of rays meets a mesh: fast for a few rays and millions of triangles.

All rays of a click come from one eye, so boxes and triangles are projected onto the
picture, as a renderer does. Groups of neighbouring triangles whose box lies beside the
rays, or falls between them, are dropped first; then the same is done with the triangles
of the other groups. Only what is left is tested exactly.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.tools.picking.rays import Array, Indices, RayGrid, TriangleMesh

GROUPS = 2000
"""Groups of triangles that are looked at in one go, which bounds the memory."""
PAIRS = 1_000_000
"""Pairs of a ray and a triangle that are tested in one go, for the same reason."""
MARGIN = 1e-12
"""Rounding of projected points, as a part of their distance from the eye."""


@dataclass(frozen=True, slots=True)
class _Covered:
    """Which boxes or triangles may cover which columns and rows of the rays.

    Attributes:
        index: their numbers, (M,); the other arrays have the same length.
    """

    index: Indices
    first_column: Indices
    end_column: Indices
    first_row: Indices
    end_row: Indices


def cast_mesh(rays: RayGrid, mesh: TriangleMesh) -> Array:
    """How far along each ray the mesh is met first, from either side of a triangle.

    Args:
        rays: R·C rays in the coordinates of the mesh.
        mesh: what to meet.

    Returns:
        (R·C,) distances in multiples of the direction, inf where nothing is met.
    """
    nearest = np.full(rays.count, np.inf)
    groups = _covered(rays, _seen_by_eye(rays, mesh.group_corners)).index
    for start in range(0, len(groups), GROUPS):
        faces = mesh.faces_of(groups[start : start + GROUPS])
        corners = _seen_by_eye(rays, mesh.vertices[faces])
        covered = _covered(rays, corners)
        for triangle, ray in _pairs(covered, len(rays.columns)):
            _meet(rays, corners[triangle], ray, nearest)
    return nearest


def _seen_by_eye(rays: RayGrid, points: npt.NDArray[np.floating[Any]]) -> Array:
    """Points (M, K, 3) in the axes of the eye.

    There a ray is (column, row, 1), so the third number is the distance along it.
    """
    to_eye = np.linalg.inv(rays.axes)
    seen: Array = (points - rays.origin) @ np.transpose(to_eye)
    return seen


def _covered(rays: RayGrid, points: Array) -> _Covered:
    """What of M boxes or triangles, each with K corners (M, K, 3), rays may meet."""
    depth = points[..., 2]
    keep = (depth > 0.0).any(axis=1)
    # What crosses the plane of the eye has no outline in the picture.
    crossing = keep & (depth <= 0.0).any(axis=1)
    ranges: list[tuple[Array, Array]] = []
    for axis, at in ((0, rays.columns), (1, rays.rows)):
        with np.errstate(divide="ignore", invalid="ignore"):
            picture = points[..., axis] / depth
        margin = MARGIN * (1.0 + float(np.abs(at).max()))
        low, high = picture.min(axis=1) - margin, picture.max(axis=1) + margin
        low[crossing], high[crossing] = -np.inf, np.inf
        keep &= (low <= at[-1]) & (high >= at[0])
        ranges.append((low, high))
    index = np.flatnonzero(keep)
    ends: list[Indices] = []
    for (low, high), at in zip(ranges, (rays.columns, rays.rows), strict=True):
        ends.append(np.searchsorted(at, low[index], "left"))
        ends.append(np.searchsorted(at, high[index], "right"))
    met = (ends[1] > ends[0]) & (ends[3] > ends[2])
    return _Covered(index[met], *(end[met] for end in ends))


def _pairs(covered: _Covered, columns: int) -> Iterator[tuple[Indices, Indices]]:
    """Each triangle with each of its rays, in blocks.

    Yields:
        The numbers of the triangles and those of the rays, both (P,).
    """
    width = covered.end_column - covered.first_column
    count = width * (covered.end_row - covered.first_row)
    block = np.cumsum(count) // PAIRS
    for number in np.unique(block):
        some = np.flatnonzero(block == number)
        which = np.repeat(some, count[some])
        begin = np.cumsum(count[some]) - count[some]
        k = np.arange(len(which)) - np.repeat(begin, count[some])
        row = covered.first_row[which] + k // width[which]
        column = covered.first_column[which] + k % width[which]
        yield covered.index[which], row * columns + column


def _meet(rays: RayGrid, corners: Array, ray: Indices, nearest: Array) -> None:
    """Test triangles (P, 3, 3) with their rays exactly; keep the nearest distances."""
    columns = len(rays.columns)
    direction = np.stack(
        [rays.columns[ray % columns], rays.rows[ray // columns], np.ones(len(ray))], 1
    )
    a, b, c = (corners[:, i] for i in range(3))
    # Volumes between the ray and the edges: all of one sign means inside. The two
    # triangles at an edge get opposite numbers for it, so no ray slips through.
    normal = np.cross(b, c)
    volumes = np.stack(
        [
            np.einsum("ij,ij->i", direction, across)
            for across in (normal, np.cross(c, a), np.cross(a, b))
        ]
    )
    inside = (volumes >= 0.0).all(axis=0) | (volumes <= 0.0).all(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.einsum("ij,ij->i", a, normal) / volumes.sum(axis=0)
    met = inside & np.isfinite(t) & (t >= 0.0)
    np.minimum.at(nearest, ray[met], t[met])
