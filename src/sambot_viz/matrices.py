"""Rigid transforms as arrays of numpy, one and many at once."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from sambot_viz.geometry import (
    IDENTITY,
    ORIGIN,
    SHORTEST,
    Matrix,
    Vector3,
    Wxyz,
    rotation_from_xyzw,
    wxyz_from_matrix,
)


def stacked(matrices: Iterable[Matrix]) -> Matrix:
    """Return one (N, 4, 4) array of (4, 4) matrices; there is one at least."""
    # It takes half the time of `np.array`.
    return np.reshape(np.concatenate(tuple(matrices)), (-1, 4, 4))


def wxyzs_from_matrices(T: Matrix) -> list[Wxyz]:
    """Return `wxyz_from_matrix` of each of (N, 4, 4) matrices, to the last digit."""
    # As `xyzw_from_matrix`, where the trace is above 0.
    trace: Matrix = T[:, 0, 0] + T[:, 1, 1] + T[:, 2, 2]
    root = np.sqrt(np.maximum(trace, 0.0) + 1.0)
    s = 0.5 / root
    x, y, z = T[:, 2, 1] - T[:, 1, 2], T[:, 0, 2] - T[:, 2, 0], T[:, 1, 0] - T[:, 0, 1]
    rows: list[list[float]] = np.stack([0.5 * root, s * x, s * y, s * z], 1).tolist()
    found: list[Wxyz] = [(w, x, y, z) for w, x, y, z in rows]
    for row in np.flatnonzero(~(trace > 0.0)).tolist():
        found[row] = wxyz_from_matrix(T[row])
    return found


def unit_wxyzs(wxyzs: Matrix) -> Matrix:
    """Return quaternions (N, 4) as `unit_wxyz` does, each by itself."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        # `hypot`, since squares of the least and of the greatest numbers are none.
        pairs = np.hypot(wxyzs[:, 0::2], wxyzs[:, 1::2])
        norms = np.hypot(pairs[:, :1], pairs[:, 1:])
        has_length = (norms > SHORTEST) & (norms < np.inf)
        return np.where(has_length, wxyzs / norms, IDENTITY)


def matrix_from_wxyz(wxyz: Wxyz, position: Vector3 = ORIGIN) -> Matrix:
    """Return the (4, 4) transform of a rotation and a position [m]."""
    w, x, y, z = wxyz
    T = np.eye(4)
    T[:3, :3] = rotation_from_xyzw((x, y, z, w))
    T[:3, 3] = position
    return T


def inverse_matrix(matrix: Matrix) -> Matrix:
    """Return the inverse of a rigid (4, 4) transform, read-only."""
    # Twelve products of Python floats take half the time of slicing with numpy.
    (a, b, c, x), (d, e, f, y), (g, h, i, z), _ = matrix.tolist()
    inverse = np.array(
        (
            (a, d, g, -(a * x + d * y + g * z)),
            (b, e, h, -(b * x + e * y + h * z)),
            (c, f, i, -(c * x + f * y + i * z)),
            (0.0, 0.0, 0.0, 1.0),
        )
    )
    inverse.flags.writeable = False
    return inverse
