"""What is drawn, as shapes that rays can meet: the robot, axes of frames, the grid."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.displays.grid import GridDisplay
from sambot_viz.displays.robot_model.robot_entries import BOX
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.displays.tf.tf import AXES_DIAMETER, AXES_LENGTH, TfDisplay
from sambot_viz.geometry import Matrix
from sambot_viz.meshes.mesh import Mesh
from sambot_viz.robot.model import Cylinder, MeshFile, Robot, Shape, Sphere
from sambot_viz.robot.shape_files import asset_of
from sambot_viz.tools.picking.hit import Hit, Selectable
from sambot_viz.tools.picking.raycast import Collider, bounds, cast, cast_plane
from sambot_viz.tools.picking.rays import Array, RayGrid, TriangleMesh

FRAME_RADIUS = 0.1
"""A frame is selected within this part of the Marker Scale around its origin."""
NORMALS = {"XY": (0.0, 0.0, 1.0), "XZ": (0.0, 1.0, 0.0), "YZ": (1.0, 0.0, 0.0)}


@dataclass(frozen=True, slots=True)
class PlacedCollider:
    """A shape with its pose, and the link or frame it belongs to.

    Attributes:
        item: the link or frame.
        collider: the shape.
        T: (4, 4) from the shape's frame to the fixed frame; it scales a mesh.
        part: "drawn" is on the screen; "handle" is a larger shape around something
            thin, so that it is easy to select; "both" is for what is large enough.
    """

    item: Selectable
    collider: Collider
    T: Matrix
    part: Literal["drawn", "handle", "both"] = "both"


@dataclass(frozen=True, slots=True)
class PlacedGrid:
    """The square of a grid: the plane is z = 0 or another pair of axes of its frame.

    Attributes:
        T: (4, 4) from the grid's frame to the fixed frame.
        normal: which axis of that frame is across the plane, (3,).
        offset: middle of the square in that frame, (3,) [m].
        half: half of a side [m].
    """

    T: Matrix
    normal: Array
    offset: Array
    half: float

    def cast(self, origin: Array, direction: Array) -> float:
        """How far along a ray the square is, inf beside it."""
        o = (origin - self.T[:3, 3]) @ self.T[:3, :3]
        d = direction @ self.T[:3, :3]
        t = float(cast_plane(o[None], d[None], self.offset, self.normal)[0])
        if not np.isfinite(t):
            return np.inf
        beside = np.abs(o + t * d - self.offset) * (self.normal == 0)
        return t if np.all(beside <= self.half) else np.inf


@dataclass(frozen=True, slots=True)
class PickSnapshot:
    """What is drawn at one moment; rays can be followed without any lock.

    Attributes:
        placed: what can be selected.
        grids: what can only be pointed at.
    """

    placed: tuple[PlacedCollider, ...]
    grids: tuple[PlacedGrid, ...]

    @property
    def triangles(self) -> int:
        """How many triangles the meshes have together."""
        meshes = (one.collider for one in self.placed)
        return sum(len(m.faces) for m in meshes if isinstance(m, TriangleMesh))

    def first_hit(self, origin: Array, direction: Array) -> Hit:
        """What one ray meets first.

        A grid is lines, and what is behind it is seen through it: it only counts
        where the ray meets nothing else.

        Args:
            origin: (3,), in the fixed frame [m].
            direction: (3,), of length 1.
        """
        rays = RayGrid.through(origin, direction)
        nearest, reach = np.inf, np.inf
        item: Selectable | None = None
        for placed in self.placed:
            t = float(cast(placed.collider, placed.T, rays)[0])
            if placed.part != "handle":
                nearest = min(nearest, t)
            if placed.part != "drawn" and t < reach:
                reach, item = t, placed.item
        if not np.isfinite(nearest):
            on_grids = (grid.cast(origin, direction) for grid in self.grids)
            nearest = min(on_grids, default=np.inf)
        if not np.isfinite(nearest):
            return Hit(None, item)
        return Hit(origin + nearest * direction, item)

    def items_met(self, rays: RayGrid) -> set[Selectable]:
        """The links and frames that some of the rays meet first."""
        nearest = np.full(rays.count, np.inf)
        owner = np.full(rays.count, -1)
        for index, placed in enumerate(self.placed):
            if placed.part == "drawn":
                continue
            t = cast(placed.collider, placed.T, rays)
            nearer = t < nearest
            nearest[nearer], owner[nearer] = t[nearer], index
        return {self.placed[int(i)].item for i in np.unique(owner) if i >= 0}


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
        self._meshes: dict[Path, tuple[Mesh, tuple[TriangleMesh, ...]]] = {}

    def snapshot(self) -> PickSnapshot:
        """Everything that is drawn now; files are not read for it."""
        placed = tuple(self._placed())
        kept = {id(one.collider) for one in placed}
        for path, (_, parts) in list(self._meshes.items()):
            if not any(id(part) in kept for part in parts):
                del self._meshes[path]
        return PickSnapshot(placed, tuple(self._grids()))

    def box_of(self, item: Selectable) -> tuple[Array, Array] | None:
        """The corners of the box around a link's shapes or a frame's axes [m]."""
        boxes = [bounds(one.collider, one.T) for one in self._placed(item)]
        if not boxes:
            return None
        lows, highs = zip(*boxes, strict=True)
        return np.min(lows, axis=0), np.max(highs, axis=0)

    def _placed(self, only: Selectable | None = None) -> Iterator[PlacedCollider]:
        for display in self._displays():
            if not display.shown:
                continue
            if isinstance(display, RobotModelDisplay):
                yield from self._links(display, only)
            elif isinstance(display, TfDisplay) and display.config.get("Show Axes"):
                yield from self._frames(display, only)

    def _links(
        self, display: RobotModelDisplay, only: Selectable | None
    ) -> Iterator[PlacedCollider]:
        robot, get = self._context.robot, display.config.get
        if robot is None or get("Description Source") == "File":
            return
        entries = display.entries_of(robot)
        for link, shapes in _shapes(
            robot, get("Visual Enabled"), get("Collision Enabled")
        ):
            item = Selectable("link", link)
            if only not in (None, item):
                continue
            own = entries.link(link)
            T_fixed_link = self._pose(display.frame_of(link))
            alpha = own.get("Alpha") * get("Alpha")
            if not own.get(BOX) or alpha == 0 or T_fixed_link is None:
                continue
            for shape in shapes:
                T = T_fixed_link @ shape.origin.matrix
                yield from self._colliders(item, shape, T)

    def _colliders(
        self, item: Selectable, shape: Shape, T: Matrix
    ) -> Iterator[PlacedCollider]:
        geometry = shape.geometry
        if not isinstance(geometry, MeshFile):
            yield PlacedCollider(item, geometry, T)
            return
        for mesh in self._triangles(shape):
            yield PlacedCollider(item, mesh, T * (*geometry.scale, 1.0))

    def _triangles(self, shape: Shape) -> tuple[TriangleMesh, ...]:
        """The parts of a shape's mesh file; none while it is being read."""
        robot, assets = self._context.robot, self._context.assets
        asset = None if robot is None else asset_of(shape, robot.file_roots)
        mesh = None if asset is None else assets.known(asset)
        if asset is None or not isinstance(mesh, Mesh):
            return ()
        known = self._meshes.get(asset.path)
        if known is None or known[0] is not mesh:
            parts = (TriangleMesh.of(part.vertices, part.faces) for part in mesh.parts)
            known = self._meshes[asset.path] = (mesh, tuple(parts))
        return known[1]

    def _frames(
        self, display: TfDisplay, only: Selectable | None
    ) -> Iterator[PlacedCollider]:
        scale = float(display.config.get("Marker Scale"))
        axis = Cylinder(AXES_DIAMETER * scale / 2, AXES_LENGTH * scale)
        for frame in self._context.tree.frames:
            item = Selectable("frame", frame)
            if only not in (None, item):
                continue
            T = self._pose(frame)
            if T is None:
                continue
            yield PlacedCollider(item, Sphere(FRAME_RADIUS * scale), T, "handle")
            if only is None:
                for T_frame_axis in _axes(axis.length):
                    yield PlacedCollider(item, axis, T @ T_frame_axis, "drawn")

    def _grids(self) -> Iterator[PlacedGrid]:
        for display in self._displays():
            if not (display.shown and isinstance(display, GridDisplay)):
                continue
            get = display.config.get
            T = self._pose(self._context.frame(get("Reference Frame")))
            if T is not None:
                normal = NORMALS.get(str(get("Plane")), NORMALS["XY"])
                half = float(get("Plane Cell Count")) * float(get("Cell Size")) / 2
                yield PlacedGrid(T, np.array(normal), np.array(get("Offset")), half)

    def _pose(self, frame: str) -> Matrix | None:
        """T_fixed_frame, (4, 4); None when the frame cannot be placed."""
        tree, fixed = self._context.tree, self._context.fixed_frame
        if frame == fixed:
            return np.eye(4)
        return (
            tree.lookup(fixed, frame).matrix if tree.can_lookup(fixed, frame) else None
        )


def _axes(length: float) -> Iterator[Matrix]:
    """The poses of cylinders (along their z) that are the axes of a frame."""
    for column in range(3):
        T = np.eye(4)
        # Rolling the columns brings z to x, y or z and keeps the system right-handed.
        T[:3, :3] = np.roll(np.eye(3), column - 2, axis=1)
        T[:3, 3] = T[:3, 2] * length / 2
        yield T


def _shapes(
    robot: Robot, visual: bool, collision: bool
) -> Iterator[tuple[str, tuple[Shape, ...]]]:
    for link in robot.links.values():
        shapes = (link.visuals if visual else ()) + (
            link.collisions if collision else ()
        )
        yield link.name, shapes
