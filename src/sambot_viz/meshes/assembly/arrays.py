"""Reading long lists of numbers quickly, and cutting polygons into triangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.assembly.assemble import Floats, Ints

_Number = TypeVar("_Number", bound=np.generic)
_BLANK = b" \t\r\n\f\v"
_WHOLE = b"0123456789+-" + _BLANK
_DECIMAL = _WHOLE + b".eE"


def parse_floats(text: bytes) -> npt.NDArray[np.float32] | None:
    """Numbers separated by blanks, or None when something else is among them."""
    try:
        # Numpy's own reader is quicker, but older releases only warn about what
        # they do not understand ("nan" included).
        if text.translate(None, _DECIMAL):
            return np.fromiter(map(float, text.split()), dtype=np.float32)
        return _numpy_reader(text, np.float32)
    except ValueError:
        return None


def parse_ints(text: bytes) -> npt.NDArray[np.int64] | None:
    """Whole numbers separated by blanks, or None when something else is among them."""
    if text.translate(None, _WHOLE):
        return None
    try:
        return _numpy_reader(text, np.int64)
    except ValueError:
        return None


def _numpy_reader(text: bytes, dtype: type[_Number]) -> npt.NDArray[_Number]:
    if not text.strip():
        return np.empty(0, dtype=dtype)
    return np.fromstring(text, dtype=dtype, sep=" ")


def triples(count: int) -> npt.NDArray[np.int64]:
    """The numbers 0 1 2, 3 4 5, … as (count, 3)."""
    return np.reshape(np.arange(3 * count, dtype=np.int64), (count, 3))


def table_of(values: npt.NDArray[_Number], width: int) -> npt.NDArray[_Number]:
    """The values as (rows, width); an incomplete last row is dropped."""
    rows = len(values) // width
    return np.reshape(values[: rows * width], (rows, width))


def triangulate(counts: Ints, points: Floats | None = None) -> npt.NDArray[np.int64]:
    """Cut polygons into triangles.

    Args:
        counts: (P,) corners of each polygon; fewer than three give no triangle.
        points: (sum of counts, 3) positions of the corners one after the other.
            When given, polygons that are not convex are cut properly.

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
    dented = _dented(counts, starts, points)
    if not len(dented):
        return fans
    keep = ~np.isin(np.repeat(np.arange(len(counts)), pieces), dented)
    cut = [
        starts[p] + _clip_ears(points[starts[p] : starts[p] + counts[p]])
        for p in dented
    ]
    return np.concatenate([fans[keep], *cut])


def _dented(counts: Ints, starts: Ints, points: npt.NDArray[np.float64]) -> Ints:
    """The polygons that have an inward corner."""
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
    return np.unique(owner[inward])


def _clip_ears(points: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
    """Triangles of one polygon with inward corners, by cutting off ears."""
    normal = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
    keep = np.argsort(np.abs(normal))[:2]
    flat = points[:, np.sort(keep)]
    outline = np.roll(flat, -1, axis=0)
    if np.sum(flat[:, 0] * outline[:, 1] - flat[:, 1] * outline[:, 0]) < 0:
        flat = flat[:, ::-1]
    left = list(range(len(points)))
    triangles: list[tuple[int, int, int]] = []
    while len(left) > 3:
        ear = next((k for k in range(len(left)) if _is_ear(flat, left, k)), 0)
        triangles.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        del left[ear]
    triangles.append((left[0], left[1], left[2]))
    return np.array(triangles, dtype=np.int64)


def _is_ear(flat: Floats, left: Sequence[int], k: int) -> bool:
    ia, ib, ic = left[k - 1], left[k], left[(k + 1) % len(left)]
    a, b, c = flat[ia], flat[ib], flat[ic]
    if _side(a, b, c) <= 0:
        return False
    return not any(
        _side(a, b, p) >= 0 and _side(b, c, p) >= 0 and _side(c, a, p) >= 0
        for p in (flat[i] for i in left if i not in (ia, ib, ic))
        if not (np.array_equal(p, a) or np.array_equal(p, b) or np.array_equal(p, c))
    )


def _side(a: Floats, b: Floats, p: Floats) -> float:
    return float((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]))
