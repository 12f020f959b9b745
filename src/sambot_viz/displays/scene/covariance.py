"""The shapes of a 6×6 covariance of a pose, as RViz draws them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.scene.solid_nodes import Kind, Solid
from sambot_viz.displays.scene.solids import AXIS_COLORS, Rgb
from sambot_viz.geometry import (
    IDENTITY,
    Matrix,
    Vector3,
    Wxyz,
    rotation_from_xyzw,
    wxyz_from_matrix,
)
from sambot_viz.meshes.primitives import CONE_TIP

THIN = 0.001
"""Thickness of flat shapes [m]."""
_STEEPEST = math.radians(89)
_X, _Y, _Z = np.eye(3)
_DISCS = (((1, 2), _X, _Z, -_Y), ((0, 2), _Y, _Z, -_X), ((0, 1), _Z, _X, -_Y))
"""Of the discs at +x, +y and +z: the two angles of the covariance, the normal, and the
directions in which the disc is as wide as each of the angles."""
_WEDGE = np.column_stack([_Y, -_Z, -_X])
"""A cone with its tip towards −x, its width along y and its thickness along z."""


@dataclass(frozen=True, slots=True)
class CovarianceLook:
    """What of a covariance is drawn, and how: RViz's properties.

    Attributes:
        has_position: whether the ellipsoid is drawn.
        position_color: its colour.
        position_alpha: 0 to 1.
        position_scale: its semi-axes in standard deviations.
        has_orientation: whether the wedge or the discs are drawn.
        is_local: whether they turn with the pose, or stay with its frame.
        is_rgb: whether they have the colours of the axes.
        orientation_color: their colour if not.
        orientation_alpha: 0 to 1.
        offset: how far they are from the pose [m].
        orientation_scale: their angles in standard deviations.
    """

    has_position: bool = True
    position_color: Rgb = (204, 51, 204)
    position_alpha: float = 0.3
    position_scale: float = 1.0
    has_orientation: bool = True
    is_local: bool = True
    is_rgb: bool = False
    orientation_color: Rgb = (255, 255, 127)
    orientation_alpha: float = 0.5
    offset: float = 1.0
    orientation_scale: float = 1.0


def covariance_solids(
    covariance: npt.ArrayLike,
    wxyz: Wxyz,
    position: Vector3,
    look: CovarianceLook | None = None,
) -> list[Solid]:
    """Return the shapes of a covariance in the frame of its pose.

    Args:
        covariance: (6, 6) or (36,) of x, y, z [m²] and the rotations about them [rad²];
            only the lower triangle is read.
        wxyz: rotation of the pose in its frame.
        position: position of the pose there [m].
        look: the settings of the drawing; by default RViz's.

    Returns:
        A sphere, then a cone if z, roll and pitch are certain, or else three cylinders;
        shapes with a negative variance or NaN are left out.
    """
    look = look or CovarianceLook()
    given: Matrix = np.reshape(np.asarray(covariance, np.float64), (6, 6))
    sigma: Matrix = np.where(np.tri(6, dtype=bool), given, np.transpose(given))
    is_flat = all(sigma[i, i] <= 0 for i in (2, 3, 4))
    found: list[Solid] = []
    if look.has_position:
        color, alpha = look.position_color, look.position_alpha
        part = _ellipsoid(sigma[:3, :3], look.position_scale, is_flat)
        found += _placed([part], (color,), alpha, IDENTITY, position)
    if look.has_orientation:
        turn = wxyz if look.is_local else IDENTITY
        size = look.offset, look.orientation_scale
        parts = [_wedge(sigma[5, 5], *size)] if is_flat else _discs(sigma, *size)
        colors = AXIS_COLORS[2:] if is_flat else AXIS_COLORS
        if not look.is_rgb:
            colors = (look.orientation_color,) * len(parts)
        found += _placed(parts, colors, look.orientation_alpha, turn, position)
    return found


@dataclass(frozen=True, slots=True)
class _PosedSolid:
    """A unit shape at the pose: its rotation (3, 3), middle and sizes, (3,) [m]."""

    kind: Kind
    R: Matrix
    middle: npt.NDArray[np.float64]
    sizes: tuple[float, float, float]


def _placed(
    parts: Sequence[_PosedSolid | None],
    colors: Sequence[Rgb],
    alpha: float,
    wxyz: Wxyz,
    position: Vector3,
) -> list[Solid]:
    """Return parts in the frame in which the pose is given."""
    w, x, y, z = wxyz
    R = _rotation(w, x, y, z)
    found: list[Solid] = []
    for part, color in zip(parts, colors, strict=True):
        if part is None:
            continue
        at = R @ part.middle + position
        turn = wxyz_from_matrix(R @ part.R)
        middle = (float(at[0]), float(at[1]), float(at[2]))
        found.append(Solid(part.kind, turn, middle, part.sizes, color, alpha))
    return found


def _rotation(w: float, x: float, y: float, z: float) -> Matrix:
    """Return the rotation (3, 3) of a quaternion of any length; 0 does not turn."""
    norm = w * w + x * x + y * y + z * z
    if not 0 < norm < math.inf:
        return np.eye(3)
    return np.array(rotation_from_xyzw((x, y, z, w)))


def _spread(block: Matrix) -> tuple[npt.NDArray[np.float64], Matrix] | None:
    """Return standard deviations (n,) and their directions, columns of (n, n).

    None where a variance is negative or not a number.
    """
    if not np.isfinite(block).all():
        return None
    values, vectors = np.linalg.eigh(block)
    # Zeros come out as ±1e-17.
    if values[0] < -1e-12 * max(1e-12, float(values[-1])):
        return None
    return np.sqrt(values.clip(0)), vectors


def _ellipsoid(block: Matrix, scale: float, is_flat: bool) -> _PosedSolid | None:
    size = 2 if is_flat else 3
    found = _spread(block[:size, :size])
    if found is None:
        return None
    R = np.eye(3)
    R[:size, :size] = found[1]
    if np.linalg.det(R) < 0:
        R[:, 0] = -R[:, 0]
    wide = [max(THIN, float(2 * scale * deviation)) for deviation in found[0]]
    sizes = (wide[0], wide[1], THIN if is_flat else wide[2])
    return _PosedSolid("sphere", R, np.zeros(3), sizes)


def _half_width(deviation: float, offset: float, scale: float) -> float:
    """Return how wide an angle is on one side at a distance [m]."""
    return offset * math.tan(min(deviation * scale, _STEEPEST))


def _wedge(variance: float, offset: float, scale: float) -> _PosedSolid | None:
    if not 0 <= variance < math.inf:
        return None
    wide = 2 * _half_width(math.sqrt(variance), offset, scale)
    sizes = (max(THIN, wide), THIN, max(THIN, offset))
    return _PosedSolid("cone", _WEDGE, CONE_TIP * offset * _X, sizes)


def _discs(sigma: Matrix, offset: float, scale: float) -> list[_PosedSolid | None]:
    return [
        _disc(sigma[3:, 3:][np.ix_(angles, angles)], axes, offset, scale)
        for angles, *axes in _DISCS
    ]


def _disc(
    block: Matrix,
    axes: Sequence[npt.NDArray[np.float64]],
    offset: float,
    scale: float,
) -> _PosedSolid | None:
    found = _spread(block)
    if found is None:
        return None
    normal, first, second = axes
    deviations, vectors = found
    along = np.outer(first, vectors[0]) + np.outer(second, vectors[1])
    across = cast("Matrix", np.cross(along[:, 0], along[:, 1]))
    R: Matrix = np.transpose(np.array([along[:, 0], along[:, 1], across], np.float64))
    wide = [max(THIN, 2 * _half_width(float(d), offset, scale)) for d in deviations]
    return _PosedSolid("cylinder", R, offset * normal, (wide[0], wide[1], THIN))
