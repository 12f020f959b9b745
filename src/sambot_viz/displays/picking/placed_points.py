"""Points as they are drawn, for rays: squares, discs, boxes, tiles and texts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.picking.pick_buffer import PickBuffer
from sambot_viz.displays.picking.pick_geometry import Nearby
from sambot_viz.displays.picking.placed import HERE, Parts, Placed
from sambot_viz.displays.picking.rasterise import Covered, blocks, ranges
from sambot_viz.displays.picking.rays import Array, Balls, Indices, RayGrid
from sambot_viz.displays.picking.selectable import Hit, Selectable, Selection
from sambot_viz.displays.picking.triangle_mesh import Part, TriangleMesh
from sambot_viz.geometry import Matrix, Vector3
from sambot_viz.matrices import inverse_matrix

NEAR_POINT = 3.0
"""A point is meant from so far, where nothing else is met [pixels]."""
LAYER = 0.02
"""Points whose distances differ by less than this part are equally near."""
CHUNK = 1 << 16
"""Points that are looked at in one go, which the cache of a processor holds."""
PIXELS = 200_000
"""Pixels that points may cover, and that are looked at in one go."""
SMALL = 0.75
"""Half the size of a point [pixels] that has the pixel nearest to it, and no other."""
Outline = Literal["dot", "square", "disc", "tile", "box", "text"]


@dataclass(frozen=True, slots=True)
class PointOutline:
    """The outline of each of some points.

    Attributes:
        outline: a disc of a size on the screen; a square or a disc that faces the eye;
            a tile in a fixed plane; a box along the axes of the node; a rectangle that
            faces the view.
        size: along x, y and z [m]; of dots the diameter [pixels], first.
        normal: of tiles, in the frame of the node.
        up: there: the direction of their y, and of that of squares and discs.
        is_by_depth: whether the size is that at z = 1 m, and grows with z.
    """

    outline: Outline
    size: Vector3
    normal: Vector3 = (0.0, 0.0, 1.0)
    up: Vector3 = (0.0, 1.0, 0.0)
    is_by_depth: bool = False

    @property
    def radius(self) -> tuple[float, float]:
        """Half its largest extent: metres, and pixels in addition."""
        x, y, z = self.size
        if self.outline == "dot":
            return 0.0, x / 2
        depth = z if self.outline == "box" else 0.0
        return float(np.linalg.norm((x, y, depth))) / 2, 0.0


@dataclass(frozen=True, slots=True, eq=False)
class PlacedPoints(Placed):
    """Points with their outline and their pose.

    Attributes:
        item: their item; None if they cannot be selected.
        points: (N, 3) [m].
        T: (4, 4) from them to the fixed frame.
        look: their outline.
        numbers: (N,), rising, their numbers in a selection; None if they are selected
            together.
        is_clear: whether they are transparent.
    """

    item: Selectable | None
    points: npt.NDArray[np.float32]
    T: Matrix
    look: PointOutline
    numbers: Indices | None = None
    is_clear: bool = False

    @property
    def count(self) -> int:
        """The number of points."""
        return len(self.points)

    @property
    def triangles(self) -> int:
        """As many triangles as take the time of the points."""
        return len(self.points)

    def selection(self, numbers: Indices) -> Selection:
        """Return the item, with the numbers of the points if they have their own."""
        if self.item is None:
            return {}
        return {self.item: None if self.numbers is None else self.numbers[numbers]}

    def position(self, number: int) -> Array | None:
        """Return the point that a mark which faces the eye stands for."""
        if self.look.outline not in ("dot", "square", "disc"):
            return None
        found: Array = self.T[:3, :3] @ self.points[number] + self.T[:3, 3]
        return found

    def draw(self, buffer: PickBuffer) -> None:
        """Draw the points."""
        pixels = buffer.pixels
        for start, balls in self._met(pixels, *self.look.radius):
            if len(balls.index):
                self._draw(buffer, balls, balls.index + start)

    def _met(
        self, pixels: RayGrid, radius: float, more: float
    ) -> Iterator[tuple[int, Balls]]:
        """Yield the points that may cover pixels, from some start.

        Args:
            pixels: the rays.
            radius: radius of the balls around the points [m].
            more: margin added to it [pixels].
        """
        for start in range(0, len(self.points), CHUNK):
            some = self.points[start : start + CHUNK]
            radii = radius * self._growth(some)
            yield start, pixels.may_meet(some, self.T, radii, more)

    def _growth(self, points: npt.NDArray[np.floating[Any]]) -> Array:
        """Return what the sizes of points are multiplied by, (N,) or (1,)."""
        if not self.look.is_by_depth or self.look.outline == "dot":
            return np.ones(1)
        return np.abs(points[:, 2].astype(np.float64))

    def _draw(self, buffer: PickBuffer, balls: Balls, numbers: Indices) -> None:
        """Draw points that may cover pixels; their numbers are (M,)."""
        pixels, seen, radii = buffer.pixels, balls.seen, balls.radii
        z = seen[:, 2]
        small = np.zeros(len(z), bool)
        low, high = np.zeros((2, len(z))), np.zeros((2, len(z)))
        for axis, count in enumerate((pixels.columns, pixels.rows)):
            metres = float(np.linalg.norm(pixels.axes[:, axis]))
            with np.errstate(divide="ignore", invalid="ignore"):
                at, half = seen[:, axis] / z, radii / (metres * (z - radii))
            # The eye is in it, or its outline is larger aslant.
            half = np.where(z > radii, 1.5 * half, np.inf)
            at = np.where(z > radii, at, 0.0)
            if not pixels.is_single and axis == 0:
                small = half < 1.5 * SMALL
            nearest = np.rint(at)
            low[axis] = np.where(small, nearest, np.ceil(np.maximum(at - half, 0)))
            last = np.floor(np.minimum(at + half, count - 1))
            high[axis] = np.where(small, nearest, last)
            small &= (nearest >= 0) & (nearest < count)
        kept = ((low <= high) & (low >= 0)).all(axis=0)
        kept &= (high < ((pixels.columns,), (pixels.rows,))).all(axis=0)
        index = np.flatnonzero(kept)
        ends = low[0], high[0], low[1], high[1]
        may = Covered(index, *(end[index].astype(np.int64) for end in ends))
        for some in blocks(may, PIXELS):
            self._fill(buffer, may.pick(some), balls, small, numbers)

    def _fill(
        self,
        buffer: PickBuffer,
        may: Covered,
        balls: Balls,
        small: npt.NDArray[np.bool_],
        numbers: Indices,
    ) -> None:
        """Draw points into the pixels that they may cover."""
        in_row, row = ranges(may.top, may.bottom)
        of_span, column = ranges(may.left[in_row], may.right[in_row])
        which, row = may.index[in_row][of_span], row[of_span]
        depth, radii = balls.seen[which, 2], balls.radii[which]
        # What is behind something else already is not looked at.
        pixel = row * buffer.pixels.columns + column
        front = buffer.near.ravel()[pixel]
        may_be = np.flatnonzero((front * (depth - radii) < 1.0) | (depth <= radii))
        which, row, column, pixel = (one[may_be] for one in (which, row, column, pixel))
        with np.errstate(divide="ignore"):
            near: Array = 1.0 / balls.seen[which, 2]
        large = np.flatnonzero(~small[which])
        if len(large):
            some = which[large]
            near[large] = self._near(
                buffer.pixels,
                column[large],
                row[large],
                balls.seen[some],
                numbers[some],
            )
        met = near > 0.0
        buffer.cover_pixels(pixel[met], near[met], self, numbers[which][met])

    def _near(
        self,
        pixels: RayGrid,
        column: Indices,
        row: Indices,
        seen: Array,
        numbers: Indices,
    ) -> Array:
        """Return how near each of some points is in a pixel, (F,); 0 beside it."""
        look = self.look
        if look.outline == "dot":
            return _near_dots(pixels, column, row, seen, look.size[0])
        to_node = inverse_matrix(self.T)
        rays = np.stack([column, row, np.ones(len(row))], axis=1)
        ray: Array = rays @ np.transpose(to_node[:3, :3] @ pixels.axes)
        eye: Array = to_node[:3, :3] @ pixels.origin + to_node[:3, 3]
        at = self.points[numbers].astype(np.float64)
        begin, sizes = eye - at, np.array(look.size) * self._growth(at)[:, None]
        if look.outline == "box":
            return _near_boxes(begin, ray, sizes / 2)
        if look.outline == "text":
            right, up = (to_node[:3, :3] @ pixels.axes[:, i] for i in (0, 1))
            right = np.broadcast_to(right / np.linalg.norm(right), ray.shape)
            up = np.broadcast_to(up / np.linalg.norm(up), ray.shape)
        else:
            towards = begin
            if look.outline == "tile":
                towards = np.broadcast_to(np.array(look.normal), ray.shape)
            right, up = _across(towards, np.array(look.up))
        return _near_flat(begin, ray, right, up, sizes, look.outline == "disc")

    def nearby(self, ray: RayGrid) -> Nearby | None:
        """Return the point that the ray goes past within some pixels.

        Of those in the nearest layer it is the one with the least distance to the ray.
        """
        if self.look.outline in ("box", "tile", "text"):
            return None
        found: list[tuple[Array, Array, Indices]] = []
        to_metres = np.linalg.norm(ray.axes[:, :2], axis=0)
        for start, balls in self._met(ray, 0.0, NEAR_POINT):
            aside = np.linalg.norm(balls.seen[:, :2] * to_metres, axis=1)
            depth = balls.seen[:, 2]
            near = (aside <= balls.radii) & (depth > 0.0)
            found.append((depth[near], aside[near], balls.index[near] + start))
        parts = zip(*found, strict=True)
        depth, aside, numbers = (np.concatenate(part) for part in parts)
        if not len(depth):
            return None
        layer = np.flatnonzero(depth <= depth.min() * (1 + LAYER))
        best = layer[np.argmin(aside[layer] / depth[layer])]
        number = int(numbers[best])
        own = None if self.numbers is None else int(self.numbers[number])
        hit = Hit(self.position(number), self.item, own)
        return Nearby(float(depth[best]), hit)

    def parts(self, of: Callable[[Selectable | None], bool]) -> Parts:
        """Yield a box around the points."""
        if of(self.item):
            half = np.array(self.look.size) / 2
            half = np.zeros(3) if self.look.outline == "dot" else half
            low, high = self.points.min(axis=0) - half, self.points.max(axis=0) + half
            yield self.item, Part(TriangleMesh.box_around(low, high), HERE, self.T)


def _near_dots(
    pixels: RayGrid, column: Indices, row: Indices, seen: Array, size: float
) -> Array:
    """Return how near dots of a size on the screen [pixels] are, (F,)."""
    z = seen[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.stack([seen[:, 0] / z - column, seen[:, 1] / z - row], axis=1)
        off *= np.linalg.norm(pixels.axes[:, :2], axis=0)
        metres = np.linalg.norm(off, axis=1)
        found: Array = np.where(
            (z > 0.0) & (metres <= size / 2 * pixels.pixel), 1.0 / z, 0.0
        )
    return found


def _across(towards: Array, up: Array) -> tuple[Array, Array]:
    """Return right and up of squares that face a direction, (F, 3) of length 1."""
    right = np.cross(up, towards)
    length = np.linalg.norm(right, axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        right = np.where(length > 0.0, right / length, (1.0, 0.0, 0.0))
        above = np.cross(towards, right)
        above /= np.linalg.norm(above, axis=1, keepdims=True)
    return right, above


def _near_flat(
    begin: Array,
    ray: Array,
    right: Array,
    up: Array,
    sizes: Array,
    is_round: bool,
) -> Array:
    """Return how near flat outlines are, (F,); all others (F, 3), or sizes (1, 3)."""
    normal = np.cross(right, up)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = -_dot(begin, normal) / _dot(ray, normal)
        at = begin + t[:, None] * ray
        x, y = _dot(at, right) / sizes[:, 0], _dot(at, up) / sizes[:, 1]
        if is_round:
            inside = x * x + y * y <= 0.25
        else:
            inside = np.maximum(np.abs(x), np.abs(y)) <= 0.5
        found: Array = np.where(inside & (t > 0.0), 1.0 / t, 0.0)
    return found


def _near_boxes(begin: Array, ray: Array, half: Array) -> Array:
    """Return how near the fronts of boxes are, (F,); from inside one sees nothing."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (-half - begin) / ray, (half - begin) / ray
    enters = np.fmin(one, other).max(axis=1)
    leaves = np.fmax(one, other).min(axis=1)
    with np.errstate(divide="ignore"):
        found: Array = np.where((enters > 0.0) & (enters <= leaves), 1.0 / enters, 0.0)
    return found


def _dot(a: Array, b: Array) -> Array:
    found: Array = np.einsum("ij,ij->i", a, b)
    return found
