"""The rays of a click or a rectangle, and triangles in an array for them to meet."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.geometry import Matrix

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.integer[Any]]


@dataclass(frozen=True, eq=False)
class RayGrid:
    """Rays from one eye through a grid of points of the picture.

    The ray through column i and row j has the direction
    ``axes @ (columns[i], rows[j], 1)``, which need not have length 1: distances along
    rays are counted in multiples of it. A click is a grid of one ray.

    Attributes:
        origin: the eye, (3,) [m].
        axes: right, down and forward as columns, (3, 3).
        columns: (C,), ascending.
        rows: (R,), ascending.
    """

    origin: Array
    axes: Array
    columns: Array
    rows: Array

    @classmethod
    def through(cls, origin: Array, direction: Array) -> RayGrid:
        """A single ray, both (3,)."""
        # Any two axes across the ray will do.
        axes = np.empty((3, 3))
        axes[:, 0] = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
        axes[:, 1] = np.cross(direction, axes[:, 0])
        axes[:, 2] = direction
        return cls(origin, axes, np.zeros(1), np.zeros(1))

    @cached_property
    def directions(self) -> Array:
        """(R·C, 3), row by row."""
        x, y = (grid.ravel() for grid in np.meshgrid(self.columns, self.rows))
        in_eye = np.stack([x, y, np.ones_like(x)], axis=1)
        return np.einsum("ij,nj->ni", self.axes, in_eye)

    @property
    def count(self) -> int:
        """How many rays there are."""
        return len(self.columns) * len(self.rows)

    def seen_from(self, T: Matrix) -> RayGrid | None:
        """The same rays in coordinates of a frame.

        Args:
            T: (4, 4) affine map from that frame to the frame of the rays.

        Returns:
            The rays, with unchanged distances along them; None when the map has no
            inverse (a shape that is scaled by 0).
        """
        try:
            inverse = np.linalg.inv(T[:3, :3])
        except np.linalg.LinAlgError:
            return None
        origin = inverse @ (self.origin - T[:3, 3])
        return RayGrid(origin, inverse @ self.axes, self.columns, self.rows)


GROUP = 128
"""Neighbouring triangles that share a box; files list neighbours one after another."""
CHUNK = 1 << 18
"""Triangles whose corners are gathered in one go, which bounds the memory."""


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles that rays can meet.

    Attributes:
        vertices: (V, 3) float32 [m].
        faces: (F, 3) indices of vertices.
        low: the lowest corner of the box around the vertices, (3,) [m].
        high: the highest corner, (3,) [m].
    """

    vertices: npt.NDArray[np.floating[Any]]
    faces: Indices
    low: Array
    high: Array

    @classmethod
    def of(
        cls, vertices: npt.NDArray[np.floating[Any]], faces: Indices
    ) -> TriangleMesh:
        """A mesh with the box around it."""
        if not len(vertices):
            return cls(vertices, faces, np.zeros(3), np.zeros(3))
        low = vertices.min(axis=0).astype(np.float64)
        return cls(vertices, faces, low, vertices.max(axis=0).astype(np.float64))

    @cached_property
    def group_corners(self) -> Array:
        """The corners of a box around every `GROUP` triangles, (G, 8, 3) [m].

        Five million triangles take about two seconds, once.
        """
        boxes: list[Array] = []
        for start in range(0, len(self.faces), CHUNK):
            corners = self.vertices[self.faces[start : start + CHUNK]].astype(float)
            begins = np.arange(0, len(corners), GROUP)
            low = np.minimum.reduceat(corners.min(axis=1), begins)
            high = np.maximum.reduceat(corners.max(axis=1), begins)
            boxes.append(np.stack([low, high], axis=1))
        if not boxes:
            return np.zeros((0, 8, 3))
        ends = np.concatenate(boxes)
        x, y, z = (axis.ravel() for axis in np.meshgrid((0, 1), (0, 1), (0, 1)))
        return np.stack([ends[:, x, 0], ends[:, y, 1], ends[:, z, 2]], axis=2)

    def faces_of(self, groups: Indices) -> Indices:
        """The faces of some groups, (N, 3)."""
        numbers = (groups[:, None] * GROUP + np.arange(GROUP)).ravel()
        return self.faces[numbers[numbers < len(self.faces)]]
