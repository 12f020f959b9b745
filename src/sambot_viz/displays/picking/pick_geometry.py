"""What rays meet: a picture's rays, triangles, and the geometry of one display."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from sambot_viz.geometry import Matrix

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.integer[Any]]


@dataclass(frozen=True, eq=False)
class RayGrid:
    """Rays from one eye through the pixels of a rectangle of a picture.

    The ray through column i and row j has the direction ``axes @ (i, j, 1)``, which
    need not have length 1: distances along rays are counted in multiples of it. A
    click is a grid of one ray.

    Attributes:
        origin: the eye, (3,) [m].
        axes: from one column to the next, from one row to the next, and the first ray,
            as columns, (3, 3); right-handed.
        columns: how many.
        rows: how many.
    """

    origin: Array
    axes: Array
    columns: int
    rows: int

    @classmethod
    def through(cls, origin: Array, direction: Array) -> RayGrid:
        """Return a single ray, both (3,)."""
        # Any two axes across the ray will do.
        axes = np.empty((3, 3))
        axes[:, 0] = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
        axes[:, 1] = np.cross(direction, axes[:, 0])
        axes[:, 2] = direction
        return cls(origin, axes, 1, 1)

    def part(self, column: int, row: int, columns: int, rows: int) -> RayGrid:
        """Return a rectangle of these rays that begins with a column and a row."""
        axes: Array = np.copy(self.axes)
        axes[:, 2] = self.axes @ np.array((column, row, 1.0))
        return RayGrid(self.origin, axes, columns, rows)

    def seen(self, points: npt.NDArray[np.floating[Any]], T: Matrix) -> Array:
        """Points as the eye sees them.

        There the ray through column i and row j is (i, j, 1), so that a point (x, y, z)
        is drawn at column x / z and row y / z, and z is the distance along its ray.

        Args:
            points: (…, 3) [m].
            T: (4, 4) affine map from their frame to that of the rays.
        """
        to_eye = np.linalg.inv(self.axes)
        A, b = to_eye @ T[:3, :3], to_eye @ (T[:3, 3] - self.origin)
        x, y, z = (points[..., axis].astype(np.float64) for axis in range(3))
        seen: Array = np.empty(points.shape)
        # A matrix product of so many points would start threads, and wait for them.
        for axis in range(3):
            seen[..., axis] = A[axis, 0] * x + A[axis, 1] * y + A[axis, 2] * z + b[axis]
        return seen


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
    """Triangles of a link or a frame, and where they are.

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
    """A box along axes of its own.

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


@dataclass(frozen=True, slots=True)
class Selectable:
    """Something that can be selected: a link of the robot, or a TF frame."""

    kind: Literal["link", "frame"]
    name: str


@dataclass(frozen=True, slots=True, eq=False)
class Hit:
    """The result of following a ray from the cursor.

    Attributes:
        point: the nearest point of what is drawn, in the fixed frame, (3,) [m]; None
            for the background.
        item: the link or frame; None for the grid and the background.
    """

    point: Array | None
    item: Selectable | None


class PickBuffer:
    """Pixels with what is in front in each, as in a renderer with a depth buffer.

    A ray is followed as a rectangle of one pixel.

    Args:
        pixels: the rays through the pixels.

    Attributes:
        clear: whether what can be seen through is drawn now, which hides nothing, or
            what hides others; None draws all as if it hid others.
        near: (rows, columns), 1 by the distance along the ray, which is counted in
            multiples of its direction; 0 for the background.
    """

    def __init__(self, pixels: RayGrid) -> None:
        self.pixels = pixels
        self.clear: bool | None = None
        self.near: Array = np.zeros((pixels.rows, pixels.columns))
        self._front = np.full(self.near.shape, -1, np.int64)
        self._items: list[Selectable | None] = []
        self._seen_too: set[Selectable | None] = set()

    def takes(self, clear: bool) -> bool:
        """Return whether something is drawn now that can be seen through, or cannot."""
        return self.clear is None or self.clear == clear

    def cover(self, left: int, top: int, near: Array, item: Selectable | None) -> None:
        """Put something in front of what is farther away.

        Args:
            left: the first column of a part of the pixels.
            top: its first row.
            near: how near it is there, (rows, columns), as in the attribute.
            item: what it belongs to; None for what cannot be selected.
        """
        rows, columns = near.shape
        window = np.s_[top : top + rows, left : left + columns]
        nearer = near > self.near[window]
        if self.clear:
            if nearer.any():
                self._seen_too.add(item)
            return
        self.near[window][nearer] = near[nearer]
        self._front[window][nearer] = len(self._items)
        self._items.append(item)

    @property
    def items(self) -> set[Selectable]:
        """The links and frames that have at least one of the pixels."""
        numbers: list[int] = np.unique(self._front).tolist()
        items = {self._items[number] for number in numbers if number >= 0}
        items |= self._seen_too
        return {item for item in items if item is not None}


class PickGeometry:
    """The geometry of one display at one moment.

    It is made with the session locked, and may be asked in another thread afterwards:
    it keeps what it needs and never looks at its display again.
    """

    @property
    def triangles(self) -> int:
        """The number of triangles, to judge how long a ray or a rectangle takes."""
        return 0

    @property
    def clear(self) -> bool:
        """Whether something can be seen through some of it."""
        return False

    def cut_off(self, pixels: RayGrid) -> Iterable[Selectable | None]:
        """Return whatever lies beside the pixels, at least in part."""
        del pixels
        return ()

    def draw(self, buffer: PickBuffer) -> None:
        """Draw all that hides what is behind it."""
        del buffer

    def cast(self, origin: Array, direction: Array, pixel: float) -> float:
        """Follow a ray to what can be pointed at, but seen through, such as lines.

        Args:
            origin: (3,), in the fixed frame [m].
            direction: (3,), of length 1.
            pixel: size of a pixel at 1 m [m].

        Returns:
            The distance [m]; infinite where the ray meets nothing of that kind.
        """
        del origin, direction, pixel
        return np.inf
