"""Triangles that rays can meet, and the boxes around them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.cached import cached_property
from sambot_viz.displays.picking.box_lines import box_lines
from sambot_viz.displays.picking.rays import Array, Indices
from sambot_viz.geometry import Matrix

GROUP = 128
"""Neighbouring triangles that share a box; files list neighbours one after another."""
CHUNK = 1 << 18
"""Triangles whose corners are gathered in one go, which bounds the memory."""


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles that rays can meet.

    Attributes:
        vertices: (V, 3) float32 [m].
        faces: (F, 3) indices of vertices, counter-clockwise seen from outside.
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
        """Return a mesh with the box around it."""
        if not len(vertices):
            return cls(vertices, faces, np.zeros(3), np.zeros(3))
        low = vertices.min(axis=0).astype(np.float64)
        return cls(vertices, faces, low, vertices.max(axis=0).astype(np.float64))

    @classmethod
    def box_around(cls, low: npt.ArrayLike, high: npt.ArrayLike) -> TriangleMesh:
        """Return a mesh without triangles that has a box, from its corners (3,) [m]."""
        none = np.zeros((0, 3))
        ends = np.asarray(low, np.float64), np.asarray(high, np.float64)
        return cls(none, none.astype(np.uint32), *ends)

    def both_sides(self) -> TriangleMesh:
        """Return the mesh with the back faces of its triangles added."""
        faces = np.concatenate([self.faces, self.faces[:, ::-1]])
        return TriangleMesh(self.vertices, faces, self.low, self.high)

    def box(self, T: Matrix) -> tuple[Array, Array]:
        """The corners (3,) of the box along the axes around the mesh's own box [m].

        As in RViz, a turned mesh gets the box around its turned box.

        Args:
            T: (4, 4) from the mesh to the frame of the axes; it may scale.
        """
        center = T[:3, :3] @ ((self.low + self.high) / 2) + T[:3, 3]
        half = np.abs(T[:3, :3]) @ ((self.high - self.low) / 2)
        return center - half, center + half

    @cached_property
    def corners(self) -> Array:
        """Return the corners of the box around the vertices, (1, 8, 3) [m]."""
        return _corners(np.array([[self.low, self.high]]))

    @cached_property
    def group_corners(self) -> Array:
        """Return the corners of a box around every `GROUP` triangles, (G, 8, 3) [m].

        Five million triangles take about two seconds, once.
        """
        boxes: list[Array] = []
        for start in range(0, len(self.faces), CHUNK):
            corners = self.vertices[self.faces[start : start + CHUNK]].astype(float)
            begins = np.arange(0, len(corners), GROUP)
            low = np.minimum.reduceat(corners.min(axis=1), begins)
            high = np.maximum.reduceat(corners.max(axis=1), begins)
            boxes.append(np.stack([low, high], axis=1))
        return _corners(np.concatenate(boxes)) if boxes else np.zeros((0, 8, 3))

    def faces_of(self, groups: Indices) -> Indices:
        """Return the faces of some groups, (N, 3)."""
        numbers = (groups[:, None] * GROUP + np.arange(GROUP)).ravel()
        return self.faces[numbers[numbers < len(self.faces)]]


def _corners(ends: Array) -> Array:
    """The corners (N, 8, 3) of boxes, from their lowest and highest, (N, 2, 3)."""
    x, y, z = (axis.ravel() for axis in np.meshgrid((0, 1), (0, 1), (0, 1)))
    return np.stack([ends[:, x, 0], ends[:, y, 1], ends[:, z, 2]], axis=2)


Corners = tuple[Array, Array]
"""The lowest and the highest corner of a box along the axes, (3,) [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """Triangles of what can be selected, and where they are.

    Attributes:
        mesh: the triangles.
        T_fixed_frame: (4, 4) the pose of the link or frame.
        T_frame_shape: (4, 4) their own pose there; it may scale.
    """

    mesh: TriangleMesh
    T_fixed_frame: Matrix
    T_frame_shape: Matrix

    def box(self) -> Corners:
        """Return the box around them along the axes of the fixed frame."""
        return self.mesh.box(self.T_fixed_frame @ self.T_frame_shape)


@dataclass(frozen=True, slots=True, eq=False)
class TurnedBox:
    """An oriented box.

    Attributes:
        T: (4, 4) from these axes to the fixed frame.
        low: its lowest corner along them, (3,) [m].
        high: its highest corner, (3,) [m].
    """

    T: Matrix
    low: Array
    high: Array

    @classmethod
    def around(cls, parts: Sequence[Part]) -> TurnedBox:
        """Return the box around parts, along their axes if they share these.

        Otherwise it is along the axes of the link or frame.
        """
        T_fixed_link = parts[0].T_fixed_frame
        turns = [_rotation(part.T_frame_shape) for part in parts]
        first = turns[0]
        share = first is not None and all(
            turn is not None and np.allclose(turn, first) for turn in turns
        )
        T: Matrix = T_fixed_link if first is None or not share else T_fixed_link @ first
        to_box = np.linalg.inv(T)
        ends = [
            part.mesh.box(to_box @ part.T_fixed_frame @ part.T_frame_shape)
            for part in parts
        ]
        low: Array = np.min([end[0] for end in ends], axis=0)
        high: Array = np.max([end[1] for end in ends], axis=0)
        return cls(T, low, high)

    @property
    def lines(self) -> Array:
        """The edges, (12, 2, 3), begin and end of each in the fixed frame [m]."""
        straight = box_lines(self.low, self.high)
        turned: Array = np.einsum("ij,nkj->nki", self.T[:3, :3], straight)
        return turned + self.T[:3, 3]


def _rotation(T: Matrix) -> Matrix | None:
    """Return how an affine map turns, (4, 4); None when it shears or flattens."""
    sizes = np.linalg.norm(T[:3, :3], axis=0)
    if not sizes.all():
        return None
    turn = np.eye(4)
    turn[:3, :3] = T[:3, :3] / sizes
    angles: Array = np.einsum("ki,kj->ij", turn[:3, :3], turn[:3, :3])
    straight = np.allclose(angles, np.eye(3), atol=1e-6)
    return turn if straight and np.linalg.det(turn) > 0.0 else None
