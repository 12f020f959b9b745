"""Rays through the pixels of a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.geometry import Matrix

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.integer[Any]]


@dataclass(frozen=True, slots=True, eq=False)
class Balls:
    """Some of many balls.

    Attributes:
        index: their numbers, (M,).
        seen: their middles as the eye sees them (`RayGrid.seen`), (M, 3).
        radii: (M,) [m].
    """

    index: Indices
    seen: Array
    radii: Array


@dataclass(frozen=True, eq=False)
class RayGrid:
    """Rays from one eye through the pixels of a rectangle of a picture.

    The ray through column i and row j has the direction ``axes @ (i, j, 1)``, which
    need not have length 1: distances along rays are counted in multiples of it. A
    click is a grid of one ray.

    Attributes:
        origin: the eye, (3,) [m].
        axes: the step from one column to the next, from one row to the next, and the
            first ray, as columns, (3, 3); right-handed.
        columns: number of columns.
        rows: number of rows.
        pixel: size of a pixel of the picture at 1 m [m]; 0 where there is no picture.
    """

    origin: Array
    axes: Array
    columns: int
    rows: int
    pixel: float = 0.0

    @classmethod
    def through(
        cls,
        origin: Array,
        direction: Array,
        pixel: float = 0.0,
        up: Array | None = None,
    ) -> RayGrid:
        """Return a single ray.

        Args:
            origin: the eye, (3,) [m].
            direction: (3,).
            pixel: as the attribute.
            up: the direction up in the picture, (3,); None where it does not matter.
        """
        axes = np.empty((3, 3))
        # Else any two axes across the ray will do.
        some = np.eye(3)[np.argmin(np.abs(direction))]
        right = np.cross(direction, some if up is None else up)
        right = right if right.any() else np.cross(direction, some)
        axes[:, 0] = right / np.linalg.norm(right)
        axes[:, 1] = np.cross(direction, axes[:, 0])
        axes[:, 2] = direction
        return cls(origin, axes, 1, 1, pixel)

    @property
    def is_single(self) -> bool:
        """Whether it is one ray, such as that of a click."""
        return self.columns == self.rows == 1

    def part(self, column: int, row: int, columns: int, rows: int) -> RayGrid:
        """Return a rectangle of these rays that begins with a column and a row."""
        axes: Array = np.copy(self.axes)
        axes[:, 2] = self.axes @ np.array((column, row, 1.0))
        return RayGrid(self.origin, axes, columns, rows, self.pixel)

    def seen(self, points: npt.NDArray[np.floating[Any]], T: Matrix) -> Array:
        """Points as the eye sees them.

        There the ray through column i and row j is (i, j, 1), so that a point (x, y, z)
        is drawn at column x / z and row y / z, and z is the distance along its ray.

        Args:
            points: (…, 3) [m].
            T: (4, 4) affine map from their frame to that of the rays.
        """
        A, b = self._to_eye(T)
        x, y, z = (points[..., axis].astype(np.float64) for axis in range(3))
        seen: Array = np.empty(points.shape)
        # A matrix product of so many points would start threads, and wait for them.
        for axis in range(3):
            seen[..., axis] = A[axis, 0] * x + A[axis, 1] * y + A[axis, 2] * z + b[axis]
        return seen

    def may_meet(
        self,
        points: npt.NDArray[np.floating[Any]],
        T: Matrix,
        radii: Array,
        pixels: float = 0.0,
    ) -> Balls:
        """Return those of some balls that may cover a pixel.

        Args:
            points: their centres, (N, 3) [m].
            T: (4, 4) affine map from their frame to that of the rays.
            radii: (N,), or (1,) for all [m].
            pixels: margin added to the radii [pixels].
        """
        A, b = self._to_eye(T)
        ends = [(c, r) for c in (0, self.columns - 1) for r in (0, self.rows - 1)]
        rays = [self.axes @ np.array((*end, 1.0)) for end in ends]
        aslant = max(float(np.linalg.norm(ray)) for ray in rays)
        # Balls beside the columns are not tested against the rows.
        z = _along(points, A[2], b[2])
        radii = radii + pixels * self.pixel * np.maximum(z, 0.0)
        index: Indices = np.arange(len(points))
        seen: list[Array] = []
        for axis, count in ((0, self.columns), (1, self.rows)):
            at, metres = _along(points, A[axis], b[axis]), self.axes[:, axis]
            beside = np.maximum(-at, at - (count - 1) * z)
            away = beside * float(np.linalg.norm(metres)) > radii * aslant
            # A ball around the eye may cover any pixel.
            near = np.flatnonzero((~away | (z <= radii)) & (z > -radii))
            points, z, index, radii = points[near], z[near], index[near], radii[near]
            seen = [one[near] for one in (*seen, at)]
        return Balls(index, np.stack([*seen, z], axis=1), radii)

    def _to_eye(self, T: Matrix) -> tuple[Array, Array]:
        to_eye = np.linalg.inv(self.axes)
        return to_eye @ T[:3, :3], to_eye @ (T[:3, 3] - self.origin)


def _along(points: npt.NDArray[np.floating[Any]], axis: Array, start: float) -> Array:
    """Return how far points (N, 3) are along an axis (3,), from a start."""
    # A matrix product of so many points would start threads, and wait for them.
    found: Array = points[:, 0].astype(np.float64) * axis[0]
    found += points[:, 1] * axis[1]
    found += points[:, 2] * axis[2]
    return found + start
