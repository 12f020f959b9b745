"""Lines, at their pose, for rays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.picking.pick_buffer import PickBuffer
from sambot_viz.displays.picking.placed import HERE, Parts, Placed
from sambot_viz.displays.picking.rasterise import nearness
from sambot_viz.displays.picking.rays import Array
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.triangle_mesh import Part, TriangleMesh
from sambot_viz.geometry import Matrix

NEAR_LINE = 3.0
"""A line is met from so far [pixels]."""


@dataclass(frozen=True, slots=True, eq=False)
class PlacedLines(Placed):
    """Lines that face the eye; a ray hits them within some pixels.

    Attributes:
        item: the marker; None if not selectable: then they are only hit where the ray
            hits nothing else.
        segments: (N, 2, 3), their ends [m].
        T: (4, 4) from them to the fixed frame.
        width: width [m]; 0 for lines as thin as a pixel.
        is_clear: whether they are transparent.
    """

    item: Selectable | None
    segments: npt.NDArray[np.float32]
    T: Matrix
    width: float = 0.0
    is_clear: bool = True

    @property
    def triangles(self) -> int:
        """The number of triangles, seen from both sides."""
        return 4 * len(self.segments)

    def draw(self, buffer: PickBuffer) -> None:
        """Draw the lines as wide as they are, and at least as they are met."""
        pixels = buffer.pixels
        R, ends = self.T[:3, :3], self.segments.astype(np.float64)
        at: Array = np.einsum("ij,nkj->nki", R, ends) + self.T[:3, 3]
        towards = pixels.origin - at
        across = np.cross((at[:, 1] - at[:, 0])[:, None], towards)
        length = np.linalg.norm(across, axis=2, keepdims=True)
        near = NEAR_LINE if pixels.is_single else 0.5
        far = np.linalg.norm(towards, axis=2, keepdims=True)
        half = np.maximum(self.width / 2, near * pixels.pixel * far)
        with np.errstate(divide="ignore", invalid="ignore"):
            aside = np.where(length > 0.0, across * half / length, 0.0)
        corners: Array = np.reshape(
            np.concatenate([at - aside, at + aside], axis=1), (-1, 3)
        )
        first = 4 * np.arange(len(at))[:, None]
        faces = first + np.array([0, 1, 2, 2, 1, 3])
        mesh = TriangleMesh.of(corners, np.reshape(faces, (-1, 3))).both_sides()
        buffer.cover(0, 0, nearness(pixels, mesh, HERE), self)

    def parts(self, of: Callable[[Selectable | None], bool]) -> Parts:
        """Yield a box around the lines."""
        if of(self.item):
            points = np.reshape(self.segments, (-1, 3))
            low, high = points.min(axis=0), points.max(axis=0)
            half = self.width / 2
            box = TriangleMesh.box_around(low - half, high + half)
            yield self.item, Part(box, HERE, self.T)
