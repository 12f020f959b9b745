"""From lists of numbers in a file to triangles: quick tables, polygons cut."""

from __future__ import annotations

import re
import sys
from typing import TypeVar

import mapbox_earcut
import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.assembly.assemble import Floats, Ints
from sambot_viz.meshes.mesh_source import MeshBudget

_Number = TypeVar("_Number", bound=np.generic)
_BLANK = b" \t\r\n\f\v"
_WHOLE = b"0123456789+-" + _BLANK
_DECIMAL = _WHOLE + b".eE"
_ONLY_WARNS = sys.version_info < (3, 11)
"""Numpy 2.2, the newest for Python 3.10, stops at what is not a number, and warns."""
DECIMAL_COMMA = re.compile(rb"[+-]?\d+,\d+")
"""A number as programs write it in the language of many countries."""
WITH_POINTS = "export the mesh again with points in its numbers (0.5), not commas (0,5)"
"""The hint for a file with decimal commas."""


def parse_floats(text: bytes) -> npt.NDArray[np.float32] | None:
    """Read numbers separated by blanks; None when something else is among them."""
    try:
        # Numpy's own reader is quicker, but older releases only warn about what
        # they do not understand ("nan" included).
        if text.translate(None, _DECIMAL):
            return np.fromiter(map(float, text.split()), dtype=np.float32)
        return _numpy_reader(text, np.float32)
    except (ValueError, DeprecationWarning):
        return None


def parse_ints(text: bytes) -> npt.NDArray[np.int64] | None:
    """Read whole numbers separated by blanks; None when others are among them."""
    if text.translate(None, _WHOLE):
        return None
    try:
        return _numpy_reader(text, np.int64)
    except (ValueError, DeprecationWarning):
        return None


def _numpy_reader(text: bytes, dtype: type[_Number]) -> npt.NDArray[_Number]:
    if not text.strip():
        return np.empty(0, dtype=dtype)
    found = np.fromstring(text, dtype=dtype, sep=" ")
    if _ONLY_WARNS and found.size != len(text.split()):
        raise ValueError("something else is among the numbers")
    return found


def triples(count: int) -> npt.NDArray[np.int64]:
    """Return the numbers 0 1 2, 3 4 5, … as (count, 3)."""
    return np.reshape(np.arange(3 * count, dtype=np.int64), (count, 3))


def table_of(values: npt.NDArray[_Number], width: int) -> npt.NDArray[_Number]:
    """Return the values as (rows, width); an incomplete last row is dropped."""
    rows = len(values) // width
    return np.reshape(values[: rows * width], (rows, width))


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
