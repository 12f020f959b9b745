"""Copies of one mesh, at their poses, for rays."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from sambot_viz.cached import cached_property
from sambot_viz.displays.picking.pick_buffer import PickBuffer
from sambot_viz.displays.picking.placed import HERE, Parts, Placed, within
from sambot_viz.displays.picking.rasterise import covered, nearness
from sambot_viz.displays.picking.rays import Array, Indices, RayGrid
from sambot_viz.displays.picking.selectable import Selectable, Selection
from sambot_viz.displays.picking.triangle_mesh import Part, TriangleMesh
from sambot_viz.geometry import Matrix

Items: TypeAlias = "Selectable | Sequence[Selectable | None] | None"
"""The selectable items of a node: one, or one for each of its copies."""


@dataclass(frozen=True, eq=False)
class PlacedCopies(Placed):
    """Copies of one mesh.

    Attributes:
        items: the item of each copy, or of all.
        mesh: the triangles of each.
        T_node_copy: (N, 4, 4), their poses; they may scale.
        T: (4, 4) from the node to the fixed frame.
        is_clear: whether they are transparent.
    """

    items: Items
    mesh: TriangleMesh
    T_node_copy: npt.NDArray[np.float64]
    T: Matrix
    is_clear: bool = False

    @property
    def count(self) -> int:
        """The number of copies."""
        return len(self.T_node_copy)

    @property
    def triangles(self) -> int:
        """The number of triangles."""
        return len(self.T_node_copy) * len(self.mesh.faces)

    @property
    def selects(self) -> bool:
        """Whether a click on one selects something."""
        if isinstance(self.items, Sequence):
            return any(item is not None for item in self.items)
        return self.items is not None

    def item_of(self, number: int) -> Selectable | None:
        """Return the item of a copy."""
        return self.items[number] if isinstance(self.items, Sequence) else self.items

    def selection(self, numbers: Indices) -> Selection:
        """Return what some copies belong to."""
        if not isinstance(self.items, Sequence):
            numbers = numbers[:1]
        items = (self.item_of(number) for number in numbers.tolist())
        return {item: None for item in items if item is not None}

    def cut_off(self, pixels: RayGrid) -> Iterator[Selectable]:
        """Yield what has a copy whose box lies beside the pixels in part."""
        for number in np.flatnonzero(~within(pixels, self._corners(slice(None)))):
            item = self.item_of(int(number))
            if item is not None:
                yield item

    def draw(self, buffer: PickBuffer) -> None:
        """Draw the copies that may be in the picture, one after the other."""
        pixels = buffer.pixels
        may = pixels.may_meet(self._middles, HERE, self._radii).index
        boxes = covered(pixels, pixels.seen(self._corners(may), HERE))
        for which, left, right, top, bottom in boxes:
            number = int(may[which])
            part = pixels.part(left, top, right - left + 1, bottom - top + 1)
            near = nearness(part, self.mesh, self.T @ self.T_node_copy[number])
            buffer.cover(left, top, near, self, number)

    def parts(self, of: Callable[[Selectable | None], bool]) -> Parts:
        """Yield the copies that belong to some items."""
        for number, T in enumerate(self.T_node_copy):
            item = self.item_of(number)
            if of(item):
                yield item, Part(self.mesh, HERE, self.T @ T)

    @cached_property
    def _middles(self) -> Array:
        """The middles of the boxes in the fixed frame, (N, 3) [m]."""
        middle = (self.mesh.low + self.mesh.high) / 2
        at = self.T_node_copy[:, :3, :3] @ middle + self.T_node_copy[:, :3, 3]
        found: Array = np.einsum("ij,nj->ni", self.T[:3, :3], at) + self.T[:3, 3]
        return found

    @cached_property
    def _radii(self) -> Array:
        """Of balls around the boxes, (N,) [m]."""
        half = (self.mesh.high - self.mesh.low) / 2
        sides = self.T_node_copy[:, :3, :3] * half
        found: Array = np.linalg.norm(np.linalg.norm(sides, axis=1), axis=1)
        return found

    def _corners(self, of: Indices | slice) -> Array:
        """The corners of the boxes of some copies in the fixed frame, (M, 8, 3) [m]."""
        T = np.einsum("ij,njk->nik", self.T, self.T_node_copy[of])
        corners = self.mesh.corners[0]
        found: Array = np.einsum("nij,kj->nki", T[:, :3, :3], corners)
        return found + T[:, None, :3, 3]
