"""Displays that draw triangles, and how rays and rectangles meet these."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.displays.picking.pick_geometry import PickGeometry
from sambot_viz.displays.picking.placed import PlacedMesh, PlacedShapes
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.triangle_mesh import Part, TriangleMesh
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.geometry import Matrix
from sambot_viz.rviz import DisplayConfig


class Triangles(Protocol):
    """Triangles in arrays, as a mesh file or a unit shape has them."""

    @property
    def vertices(self) -> npt.NDArray[np.float32]:
        """(V, 3) [m]."""
        ...

    @property
    def faces(self) -> npt.NDArray[np.uint32]:
        """(F, 3) indices of vertices, counter-clockwise seen from outside."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class DrawnTriangles:
    """Triangles that are on the screen.

    Attributes:
        triangles: the same object as long as they do not change.
        T_frame_shape: (4, 4) their pose at their frame; it may scale.
        frame: the frame they are drawn at; None for the fixed frame.
        item: what a click on them selects; None when that is nothing.
        solid: False for lines, which can be seen through.
        color: of its material, 0 to 255; None for what is no shape of a robot.
        is_clear: whether what is behind them can be seen through them.
    """

    triangles: Triangles
    T_frame_shape: Matrix
    frame: str | None
    item: Selectable | None = None
    solid: bool = True
    color: Rgb | None = None
    is_clear: bool = False


class TriangleDisplay(Display):
    """Base of displays that draw triangles."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._meshes: dict[int, tuple[Triangles, TriangleMesh]] = {}

    def drawn(self) -> Iterator[DrawnTriangles]:
        """Yield what is on the screen; only called while the display is shown."""
        raise NotImplementedError

    def pick_geometry(self) -> PickGeometry:
        """Return what is on the screen now; files are not read for it."""
        shapes = [shape for shape in self.drawn() if shape.solid]
        used = {id(shape.triangles) for shape in shapes}
        for key in [key for key in self._meshes if key not in used]:
            del self._meshes[key]
        return PlacedShapes(tuple(self._placed(shapes)))

    def parts(
        self, of: Callable[[Selectable | None], bool]
    ) -> Iterator[tuple[Selectable | None, Part]]:
        """Yield the shapes that belong to some items."""
        shapes = (shape for shape in self.drawn() if of(shape.item))
        for shape, T_fixed_frame in self._with_poses(shapes):
            mesh = self._mesh(shape.triangles)
            yield shape.item, Part(mesh, T_fixed_frame, shape.T_frame_shape)

    def _placed(self, shapes: Iterable[DrawnTriangles]) -> Iterator[PlacedMesh]:
        for shape, T_fixed_frame in self._with_poses(shapes):
            T = T_fixed_frame @ shape.T_frame_shape
            mesh = self._mesh(shape.triangles)
            yield PlacedMesh(shape.item, mesh, T, shape.color, shape.is_clear)

    def _with_poses(
        self, shapes: Iterable[DrawnTriangles]
    ) -> Iterator[tuple[DrawnTriangles, Matrix]]:
        poses: dict[str | None, Matrix | None] = {}
        for shape in shapes:
            if shape.frame not in poses:
                poses[shape.frame] = self.context.pose(shape.frame)
            T_fixed_frame = poses[shape.frame]
            if T_fixed_frame is not None:
                yield shape, T_fixed_frame

    def _mesh(self, triangles: Triangles) -> TriangleMesh:
        """Return the same triangles with what is computed of them once."""
        # They are kept beside the mesh: their id is used again when they are gone.
        known = self._meshes.get(id(triangles))
        if known is None:
            mesh = TriangleMesh.of(triangles.vertices, triangles.faces)
            known = self._meshes[id(triangles)] = (triangles, mesh)
        return known[1]
