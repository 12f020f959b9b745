"""What displays draw, at its pose, for rays: the base, meshes, and all of a display."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.picking.pick_buffer import PickBuffer
from sambot_viz.displays.picking.pick_geometry import Nearby, PickGeometry
from sambot_viz.displays.picking.rasterise import covered, nearness
from sambot_viz.displays.picking.rays import Array, Indices, RayGrid
from sambot_viz.displays.picking.selectable import Selectable, Selection
from sambot_viz.displays.picking.triangle_mesh import Part, TriangleMesh
from sambot_viz.geometry import Matrix

Parts: TypeAlias = "Iterator[tuple[Selectable | None, Part]]"
HERE = np.eye(4)


class Placed:
    """A drawn object at its pose; the base of all that are one item.

    Attributes:
        item: the item that a click selects; None for nothing.
        is_clear: whether it is transparent.
    """

    item: Selectable | None
    is_clear: bool

    @property
    def count(self) -> int:
        """One: it has no numbers."""
        return 1

    @property
    def triangles(self) -> int:
        """The number of triangles, to judge how long a ray takes."""
        return 0

    @property
    def selects(self) -> bool:
        """Whether a click on it selects something."""
        return self.item is not None

    def selection(self, numbers: Indices) -> Selection:
        """Return its item."""
        del numbers
        return {} if self.item is None else {self.item: None}

    def position(self, number: int) -> Array | None:
        """Return None: a ray hits its surface."""
        del number

    def cut_off(self, pixels: RayGrid) -> Iterator[Selectable]:
        """Yield what lies beside the pixels in part."""
        del pixels
        yield from ()

    def draw(self, buffer: PickBuffer) -> None:
        """Draw it."""
        raise NotImplementedError

    def nearby(self, ray: RayGrid) -> Nearby | None:
        """Return the point of it that a ray goes past, if it consists of points."""
        del ray

    def parts(self, of: Callable[[Selectable | None], bool]) -> Parts:
        """Yield what it shows of some items, for the boxes around them."""
        raise NotImplementedError


@dataclass(frozen=True, slots=True, eq=False)
class PlacedMesh(Placed):
    """Triangles with their pose and their item.

    Attributes:
        item: the link, frame or marker; None if not selectable.
        mesh: the triangles.
        T: (4, 4) from them to the fixed frame; it may scale.
        color: colour of the shape of a robot, 0 to 255; None for other objects.
        is_clear: whether they are transparent.
    """

    item: Selectable | None
    mesh: TriangleMesh
    T: Matrix
    color: tuple[int, int, int] | None = None
    is_clear: bool = False

    @property
    def triangles(self) -> int:
        """The number of triangles."""
        return len(self.mesh.faces)

    def draw(self, buffer: PickBuffer) -> None:
        """Draw it into all pixels; `PlacedShapes` has a faster way for many."""
        near = nearness(buffer.pixels, self.mesh, self.T)
        buffer.cover(0, 0, near, self)

    def parts(self, of: Callable[[Selectable | None], bool]) -> Parts:
        """Yield the mesh."""
        if of(self.item):
            yield self.item, Part(self.mesh, HERE, self.T)


def within(pixels: RayGrid, corners: Array) -> npt.NDArray[np.bool_]:
    """Tell which of some boxes, (N, 8, 3), lie within the pixels as a whole, (N,)."""
    x, y, z = (pixels.seen(corners, HERE)[..., axis] for axis in range(3))
    # A pixel reaches half its size beyond its ray.
    right, bottom = pixels.columns - 0.5, pixels.rows - 0.5
    beside = (z <= 0.0) | (np.minimum(x, y) < -0.5 * z)
    beside |= (x > right * z) | (y > bottom * z)
    inside: npt.NDArray[np.bool_] = beside.sum(axis=1) == 0
    return inside


@dataclass(frozen=True, slots=True, eq=False)
class PlacedShapes(PickGeometry):
    """All that a display shows.

    Attributes:
        placed: its parts; of two that are equally near the first one is in front.
    """

    placed: Sequence[Placed]

    @property
    def triangles(self) -> int:
        """The number of triangles."""
        return sum(placed.triangles for placed in self.placed)

    @property
    def is_clear(self) -> bool:
        """Whether something selectable can be seen through."""
        return any(placed.is_clear and placed.selects for placed in self.placed)

    def cut_off(self, pixels: RayGrid) -> Iterator[Selectable]:
        """Yield the items that are seen through and lie beside the pixels in part."""
        meshes = self._meshes
        if meshes:
            inside = within(pixels, self._corners(meshes))
            for placed, is_inside in zip(meshes, inside, strict=True):
                if placed.item is not None and not is_inside:
                    yield placed.item
        for placed in self._others:
            if placed.is_clear:
                yield from placed.cut_off(pixels)

    def draw(self, buffer: PickBuffer) -> None:
        """Draw each part; a mesh into the pixels that the box around it covers."""
        meshes = [placed for placed in self._meshes if buffer.takes(placed)]
        if meshes:
            pixels = buffer.pixels
            boxes = covered(pixels, pixels.seen(self._corners(meshes), HERE))
            for number, left, right, top, bottom in boxes:
                placed = meshes[number]
                part = pixels.part(left, top, right - left + 1, bottom - top + 1)
                near = nearness(part, placed.mesh, placed.T)
                buffer.cover(left, top, near, placed)
        for placed in self._others:
            if buffer.takes(placed):
                placed.draw(buffer)

    def nearby(self, ray: RayGrid) -> Nearby | None:
        """Return the nearest of the points that a ray goes past."""
        found = (placed.nearby(ray) for placed in self._others)
        met = (one for one in found if one is not None)
        return min(met, key=lambda one: one.distance, default=None)

    @property
    def _meshes(self) -> list[PlacedMesh]:
        return [placed for placed in self.placed if isinstance(placed, PlacedMesh)]

    @property
    def _others(self) -> list[Placed]:
        return [one for one in self.placed if not isinstance(one, PlacedMesh)]

    @staticmethod
    def _corners(meshes: Sequence[PlacedMesh]) -> Array:
        """The corners of the boxes of meshes in the fixed frame, (M, 8, 3) [m]."""
        T = np.stack([placed.T for placed in meshes])
        corners = np.concatenate([placed.mesh.corners for placed in meshes])
        turned: Array = np.einsum("mij,mkj->mki", T[:, :3, :3], corners)
        return turned + T[:, None, :3, 3]
