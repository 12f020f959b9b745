"""What the displays have drawn, as triangles that rays can meet, and the grids."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.displays.drawn_shape import DrawnShape, Triangles
from sambot_viz.displays.grid import GridDisplay
from sambot_viz.geometry import Matrix
from sambot_viz.tools.picking.hit import Hit, Selectable
from sambot_viz.tools.picking.rasterise import covered, nearness
from sambot_viz.tools.picking.rays import Array, RayGrid, TriangleMesh

NORMALS = {"XY": (0.0, 0.0, 1.0), "XZ": (0.0, 1.0, 0.0), "YZ": (1.0, 0.0, 0.0)}

NEAR_LINE = 3.0
"""A line of a grid is met from so far [pixels]."""

Corners = tuple[Array, Array]
"""The lowest and the highest corner of a box along the axes, (3,) [m]."""


@dataclass(frozen=True, slots=True)
class PlacedMesh:
    """Triangles with their pose, and the link or frame they belong to.

    Attributes:
        item: the link or frame; None for what is not selectable.
        mesh: the triangles.
        T: (4, 4) from them to the fixed frame; it may scale.
    """

    item: Selectable | None
    mesh: TriangleMesh
    T: Matrix


@dataclass(frozen=True, slots=True)
class PlacedGrid:
    """The lines of a grid, in the plane z = 0 or another pair of axes of its frame.

    Attributes:
        T: (4, 4) from the grid's frame to the fixed frame.
        normal: which axis of that frame is across the plane, (3,).
        offset: middle of the square in that frame, (3,) [m].
        cells: how many cells there are along each side.
        cell: side of a cell [m].
        thickness: of a line [m].
    """

    T: Matrix
    normal: Array
    offset: Array
    cells: int
    cell: float
    thickness: float = 0.0

    def cast(self, origin: Array, direction: Array, pixel: float) -> float:
        """How far along a ray a line is; inf where the ray passes between them.

        Args:
            origin: (3,), in the fixed frame [m].
            direction: (3,), of length 1.
            pixel: size of a pixel at 1 m [m]; a line is met from `NEAR_LINE` of them.
        """
        o = (origin - self.T[:3, 3]) @ self.T[:3, :3] - self.offset
        d = direction @ self.T[:3, :3]
        towards = float(d @ self.normal)
        if towards == 0.0:
            return np.inf
        t = -float(o @ self.normal) / towards
        if t < 0.0:
            return np.inf
        reach = max(NEAR_LINE * pixel * t, self.thickness / 2)
        half = self.cells * self.cell / 2
        place, along = (o + t * d)[self.normal == 0], d[self.normal == 0]
        # From each coordinate to the nearest line across it, in the plane …
        line = np.round((place + half) / self.cell).clip(0, self.cells)
        aside = np.abs(place - (line * self.cell - half))
        # … and between the ray and that line, which is less at a flat angle.
        apart = aside * abs(towards) / np.sqrt(1.0 - along[::-1] ** 2)
        inside = np.abs(place[::-1]) <= half + reach
        return t if bool(np.any((apart <= reach) & inside)) else np.inf


@dataclass(frozen=True, slots=True)
class PickSnapshot:
    """What is drawn at one moment; rays can be followed without any lock.

    Attributes:
        placed: what covers what is behind it.
        grids: what can only be pointed at.
    """

    placed: tuple[PlacedMesh, ...]
    grids: tuple[PlacedGrid, ...]

    @property
    def triangles(self) -> int:
        """How many triangles there are."""
        return sum(len(placed.mesh.faces) for placed in self.placed)

    def first_hit(self, origin: Array, direction: Array, pixel: float) -> Hit:
        """What one ray meets first.

        A grid is lines, and what is behind it is seen through it: it only counts
        where the ray meets nothing else.

        Args:
            origin: (3,), in the fixed frame [m].
            direction: (3,), of length 1.
            pixel: size of a pixel at 1 m [m].
        """
        near, owner = self._draw(RayGrid.through(origin, direction))
        if near[0, 0] > 0.0:
            item = self.placed[int(owner[0, 0])].item
            return Hit(origin + direction / near[0, 0], item)
        on_grids = (grid.cast(origin, direction, pixel) for grid in self.grids)
        nearest = min(on_grids, default=np.inf)
        if not np.isfinite(nearest):
            return Hit(None, None)
        return Hit(origin + nearest * direction, None)

    def items_met(self, pixels: RayGrid) -> set[Selectable]:
        """The links and frames that have at least one of some pixels."""
        _, owner = self._draw(pixels)
        items = {self.placed[int(i)].item for i in np.unique(owner) if i >= 0}
        return {item for item in items if item is not None}

    def _draw(self, pixels: RayGrid) -> tuple[Array, Array]:
        """Which mesh is in front in each pixel, as a renderer with a depth buffer.

        Returns:
            Both (rows, columns): 1 by the distance, 0 for the background; and the
            number of the mesh, −1 for the background.
        """
        near = np.zeros((pixels.rows, pixels.columns))
        owner = np.full(near.shape, -1.0)
        boxes = covered(pixels, pixels.seen(self._corners(), np.eye(4)))
        for number, left, right, top, bottom in boxes:
            placed = self.placed[number]
            part = pixels.part(left, top, right - left + 1, bottom - top + 1)
            drawn = nearness(part, placed.mesh, placed.T)
            window = np.s_[top : bottom + 1, left : right + 1]
            nearer = drawn > near[window]
            near[window][nearer] = drawn[nearer]
            owner[window][nearer] = number
        return near, owner

    def _corners(self) -> Array:
        """The corners of the boxes of all meshes in the fixed frame, (M, 8, 3) [m]."""
        if not self.placed:
            return np.zeros((0, 8, 3))
        T = np.stack([placed.T for placed in self.placed])
        corners = np.concatenate([placed.mesh.corners for placed in self.placed])
        turned: Array = np.einsum("mij,mkj->mki", T[:, :3, :3], corners)
        return turned + T[:, None, :3, 3]


class PickScene:
    """Knows what the displays of a session draw; read it with the session locked.

    Args:
        context: what the displays draw with.
        displays: returns the displays of the session.
    """

    def __init__(
        self, context: DisplayContext, displays: Callable[[], Sequence[Display]]
    ) -> None:
        self._context = context
        self._displays = displays
        self._meshes: dict[int, tuple[Triangles, TriangleMesh]] = {}

    def snapshot(self) -> PickSnapshot:
        """Everything that is drawn now; files are not read for it."""
        shapes = [shape for shape in self._drawn() if shape.solid]
        used = {id(shape.triangles) for shape in shapes}
        for key in [key for key in self._meshes if key not in used]:
            del self._meshes[key]
        return PickSnapshot(tuple(self._placed(shapes)), tuple(self._grids()))

    def boxes_of(self, items: Iterable[Selectable]) -> dict[Selectable, Corners]:
        """The boxes around the shapes of links and the axes of frames.

        Args:
            items: which; one that is not drawn now has no box.
        """
        wanted = set(items)
        shapes = (s for s in self._drawn() if _item_of(s) in wanted) if wanted else ()
        boxes: dict[Selectable, Corners] = {}
        for one in self._placed(shapes):
            if one.item is not None:
                boxes[one.item] = _union(one.mesh.box(one.T), boxes.get(one.item))
        return {item: boxes[item] for item in wanted if item in boxes}

    def robot_box(self) -> Corners | None:
        """The box around all links that are drawn, or else around all that is drawn.

        Returns:
            None when nothing is drawn.
        """
        shapes = list(self._drawn())
        links = [s for s in shapes if s.owner is not None and s.owner[0] == "link"]
        box: Corners | None = None
        for one in self._placed(links or shapes):
            box = _union(one.mesh.box(one.T), box)
        return box

    def _drawn(self) -> Iterator[DrawnShape]:
        for display in self._displays():
            if display.shown:
                yield from display.drawn_shapes()

    def _placed(self, shapes: Iterable[DrawnShape]) -> Iterator[PlacedMesh]:
        poses: dict[str | None, Matrix | None] = {None: np.eye(4)}
        for shape in shapes:
            if shape.frame not in poses:
                poses[shape.frame] = self._pose(str(shape.frame))
            T_fixed_frame = poses[shape.frame]
            if T_fixed_frame is not None:
                T = T_fixed_frame @ shape.T_frame_shape
                yield PlacedMesh(_item_of(shape), self._mesh(shape.triangles), T)

    def _mesh(self, triangles: Triangles) -> TriangleMesh:
        """The same triangles with what is computed of them once."""
        known = self._meshes.get(id(triangles))
        if known is None:
            mesh = TriangleMesh.of(triangles.vertices, triangles.faces)
            known = self._meshes[id(triangles)] = (triangles, mesh)
        return known[1]

    def _grids(self) -> Iterator[PlacedGrid]:
        for display in self._displays():
            if not (display.shown and isinstance(display, GridDisplay)):
                continue
            get = display.config.get
            T = self._pose(self._context.frame(get("Reference Frame")))
            if T is not None:
                normal = NORMALS.get(str(get("Plane")), NORMALS["XY"])
                ribbons = get("Line Style") == "Billboards"
                yield PlacedGrid(
                    T,
                    np.array(normal),
                    np.array(get("Offset")),
                    int(get("Plane Cell Count")),
                    float(get("Cell Size")),
                    float(get("Line Style/Line Width")) if ribbons else 0.0,
                )

    def _pose(self, frame: str) -> Matrix | None:
        """T_fixed_frame, (4, 4); None when the frame cannot be placed."""
        tree, fixed = self._context.tree, self._context.fixed_frame
        if frame == fixed:
            return np.eye(4)
        return (
            tree.lookup(fixed, frame).matrix if tree.can_lookup(fixed, frame) else None
        )


def _item_of(shape: DrawnShape) -> Selectable | None:
    return None if shape.owner is None else Selectable(*shape.owner)


def _union(one: Corners, other: Corners | None) -> Corners:
    """The box around two boxes."""
    if other is None:
        return one
    return np.minimum(one[0], other[0]), np.maximum(one[1], other[1])
