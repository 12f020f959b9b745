"""What a ray can meet in the picture: the robot, the axes of frames, the grid."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.displays.grid import GridDisplay
from sambot_viz.displays.robot_model.link_settings import RobotSettings
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.displays.tf.tf import TfDisplay
from sambot_viz.geometry import Matrix
from sambot_viz.meshes.mesh import MeshError, apply_scale
from sambot_viz.robot.model import Geometry, MeshFile, Robot, Shape, Sphere
from sambot_viz.tools.picking.raycast import (
    Array,
    Solid,
    Triangles,
    bounds,
    cast,
    cast_plane,
)
from sambot_viz.tools.tool import Hit, Rays, Thing, as_vector

AXES_REACH = 0.1
"""A frame is met within this part of the Marker Scale around its origin."""
NORMALS = {"XY": (0.0, 0.0, 1.0), "XZ": (0.0, 1.0, 0.0), "YZ": (1.0, 0.0, 0.0)}


@dataclass(frozen=True, slots=True)
class Placed:
    """A solid with its pose in the fixed frame, and what it belongs to."""

    thing: Thing
    solid: Solid
    T: Matrix


class PickScene:
    """What is drawn at the moment, for rays.

    Args:
        context: what the displays draw with.
        displays: the displays of the session, whenever it is asked.
    """

    def __init__(
        self, context: DisplayContext, displays: Callable[[], Sequence[Display]]
    ) -> None:
        self._context = context
        self._displays = displays
        self._meshes: dict[tuple[object, ...], tuple[object, Triangles]] = {}

    def first_hit(self, origin: Array, direction: Array) -> Hit | None:
        """What one ray meets first; None for the background.

        Args:
            origin: (3,), in the fixed frame [m].
            direction: (3,), of length 1.
        """
        origins, directions = origin[None], direction[None]
        best = np.inf
        thing: Thing | None = None
        for placed in self._placed():
            t = float(cast(placed.solid, placed.T, origins, directions)[0])
            if t < best:
                best, thing = t, placed.thing
        on_grid = self._grid(origins, directions)
        if on_grid < best:
            best, thing = on_grid, None
        if not np.isfinite(best):
            return None
        return Hit(as_vector(origin + best * direction), thing)

    def things_met(self, rays: Rays) -> set[Thing]:
        """What the rays of a rectangle meet first; the grid hides nothing."""
        best = np.full(len(rays.origins), np.inf)
        owner = np.full(len(rays.origins), -1)
        placed = list(self._placed())
        for index, one in enumerate(placed):
            t = cast(one.solid, one.T, rays.origins, rays.directions)
            nearer = t < best
            best[nearer], owner[nearer] = t[nearer], index
        met = {int(index) for index in owner if index >= 0}
        return {placed[index].thing for index in met}

    def box_of(self, thing: Thing) -> tuple[Array, Array] | None:
        """The corners of the box around a link's shapes or a frame's axes [m]."""
        boxes = [bounds(placed.solid, placed.T) for placed in self._placed(thing)]
        if not boxes:
            return None
        lows, highs = zip(*boxes, strict=True)
        return np.min(lows, axis=0), np.max(highs, axis=0)

    def _placed(self, only: Thing | None = None) -> Iterator[Placed]:
        for display in self._displays():
            if not display.shown:
                continue
            if isinstance(display, RobotModelDisplay):
                yield from self._links(display, only)
            elif isinstance(display, TfDisplay) and display.config.get("Show Axes"):
                yield from self._frames(display, only)

    def _links(
        self, display: RobotModelDisplay, only: Thing | None
    ) -> Iterator[Placed]:
        robot, get = self._context.robot, display.config.get
        if robot is None or get("Description Source") == "File":
            return
        settings = RobotSettings(display.config, robot)
        for link, shapes in _shapes(
            robot, get("Visual Enabled"), get("Collision Enabled")
        ):
            if only not in (None, Thing("link", link)):
                continue
            own = settings.link(link)
            T_fixed_link = self._pose(display.frame_of(link))
            if not own.enabled or own.alpha * get("Alpha") == 0 or T_fixed_link is None:
                continue
            for shape in shapes:
                T = T_fixed_link @ shape.origin.matrix
                for solid in self._solids(shape.geometry):
                    yield Placed(Thing("link", link), solid, T)

    def _frames(self, display: TfDisplay, only: Thing | None) -> Iterator[Placed]:
        reach = AXES_REACH * float(display.config.get("Marker Scale"))
        for frame in self._context.tree.frames:
            if only not in (None, Thing("frame", frame)):
                continue
            T = self._pose(frame)
            if T is not None:
                yield Placed(Thing("frame", frame), Sphere(reach), T)

    def _solids(self, geometry: Geometry) -> Iterator[Solid]:
        if not isinstance(geometry, MeshFile):
            yield geometry
            return
        if geometry.path is None:
            return
        try:
            mesh = self._context.meshes.get(geometry.path, self._roots())
        except MeshError:
            # What cannot be drawn cannot be met; its display says why.
            return
        for number, part in enumerate(mesh.parts):
            key = (geometry.path, geometry.scale, number)
            known = self._meshes.get(key)
            if known is None or known[0] is not part:
                scaled = apply_scale(part, geometry.scale)
                vertices = np.asarray(scaled.vertices, np.float64)
                known = (part, Triangles(vertices, np.asarray(scaled.faces)))
                self._meshes[key] = known
            yield known[1]

    def _roots(self) -> tuple[Path, ...] | None:
        robot = self._context.robot
        return None if robot is None else robot.file_roots

    def _pose(self, frame: str) -> Matrix | None:
        tree, fixed = self._context.tree, self._context.fixed_frame
        if frame == fixed:
            return np.eye(4)
        return (
            tree.lookup(fixed, frame).matrix if tree.can_lookup(fixed, frame) else None
        )

    def _grid(self, origins: Array, directions: Array) -> float:
        """How far the nearest shown grid is along the first ray [m]."""
        best = np.inf
        for display in self._displays():
            if not (display.shown and isinstance(display, GridDisplay)):
                continue
            get = display.config.get
            T = self._pose(self._context.frame(get("Reference Frame")))
            if T is None:
                continue
            o = (origins - T[:3, 3]) @ T[:3, :3]
            d = directions @ T[:3, :3]
            normal = np.array(NORMALS.get(str(get("Plane")), NORMALS["XY"]))
            offset = np.asarray(get("Offset"), np.float64)
            t = float(cast_plane(o, d, offset, normal)[0])
            if not np.isfinite(t):
                continue
            half = float(get("Plane Cell Count")) * float(get("Cell Size")) / 2
            in_plane = np.abs(o[0] + t * d[0] - offset) * (normal == 0)
            if np.all(in_plane <= half):
                best = min(best, t)
        return best


def _shapes(
    robot: Robot, visual: bool, collision: bool
) -> Iterator[tuple[str, tuple[Shape, ...]]]:
    for link in robot.links.values():
        shapes = (link.visuals if visual else ()) + (
            link.collisions if collision else ()
        )
        yield link.name, shapes
