"""Points in the six styles of RViz, all of one cloud in one node."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.picking.placed_points import (
    Outline,
    PlacedPoints,
    PointOutline,
)
from sambot_viz.displays.picking.rays import Indices
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.scene.glb_node import POINTS, GlbNode, drawn_glb, single
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix, Vector3, Wxyz
from sambot_viz.meshes.glb import OPAQUE_FROM

PointShape = Literal["Points", "Squares", "Flat Squares", "Spheres", "Boxes", "Tiles"]


@dataclass(frozen=True, slots=True)
class PointStyle:
    """How points look.

    Attributes:
        shape: dots; squares with and without a rim that face the camera; shaded discs;
            boxes along the axes of the cloud; tiles in a fixed plane.
        size: along x, y and z [m]; of Points the diameter [pixels], first.
        alpha: of the whole cloud, 0 to 1; multiplies the alpha of points.
        normal: of Tiles, in the frame of the cloud.
        up: of Tiles: the direction of their y.
        is_twice: RViz draws some clouds twice, so that they are less transparent.
        is_by_depth: the size is that of a point at z = 1 m in the frame of the cloud;
            it grows with z.
    """

    shape: PointShape
    size: Vector3
    alpha: float = 1.0
    normal: Vector3 = (0.0, 0.0, -1.0)
    up: Vector3 = (0.0, 1.0, 0.0)
    is_twice: bool = False
    is_by_depth: bool = False


Shown: TypeAlias = tuple[npt.NDArray[np.float32], npt.NDArray[np.uint8], PointStyle]
_FEW = 64
_OUTLINES: Mapping[PointShape, Outline] = {
    "Points": "dot",
    "Squares": "square",
    "Flat Squares": "square",
    "Spheres": "disc",
    "Boxes": "box",
    "Tiles": "tile",
}


class PointNode(GlbNode):
    """The points of one cloud, in one node; it keeps the arrays that it is given.

    Args:
        scene: where to draw.
        name: of the node.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        super().__init__(scene, name)
        # Comparing them takes a fraction of the time of a digest.
        self._shown: Shown | None = None

    def draw(
        self,
        points: npt.ArrayLike,
        colors: npt.NDArray[np.uint8],
        style: PointStyle,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw points; without any the node is taken away.

        Args:
            points: (N, 3) [m]; those that are not finite are left out.
            colors: (N, 3) or (N, 4) with alpha, or one row for all; 0 to 255.
            style: how they look.
            wxyz: rotation in the frame of the node above.
            position: there [m].
        """
        at: npt.NDArray[np.float32] = np.reshape(single(points), (-1, 3))
        if not np.isfinite(at).all():
            finite = np.isfinite(at).all(axis=1)
            at = at[finite]
            colors = colors[finite] if len(colors) > 1 else colors
        if not len(at):
            self.remove()
            return
        now = at, colors, style
        is_new = self._shown is None or not _is_same(self._shown, now)
        self._shown = now
        self.send(is_new, lambda: points_glb(at, colors, style), wxyz, position)

    def placed(
        self,
        T_fixed_above: Matrix,
        item: Selectable | None,
        numbers: Indices | None = None,
    ) -> Iterator[PlacedPoints]:
        """Yield the points for rays, if there are any.

        Args:
            T_fixed_above: (4, 4), of the node above.
            item: what they are to a selection.
            numbers: as of `PlacedPoints`.
        """
        if self._shown is None or not self.is_drawn:
            return
        points, _, style = self._shown
        outline = PointOutline(
            _OUTLINES[style.shape],
            style.size,
            style.normal,
            style.up,
            style.is_by_depth,
        )
        if style.alpha > 0.0:
            is_clear = style.alpha < OPAQUE_FROM
            T = self.place(T_fixed_above)
            yield PlacedPoints(item, points, T, outline, numbers, is_clear)


def _is_same(one: Shown, other: Shown) -> bool:
    # The beginnings first: most clouds differ there already.
    return (
        one[2] == other[2]
        and all(
            a.shape == b.shape and np.array_equal(a[:_FEW], b[:_FEW])
            for a, b in zip(one[:2], other[:2], strict=True)
        )
        and np.array_equal(one[0], other[0])
        and np.array_equal(one[1], other[1])
    )


def points_glb(
    points: npt.NDArray[np.float32], colors: npt.NDArray[np.uint8], style: PointStyle
) -> bytes:
    """Return a GLB file of points.

    Args:
        points: (N, 3) [m], finite, at least one.
        colors: (N, 3), (N, 4), (1, 3) or (1, 4), 0 to 255.
        style: how they look.
    """
    has_alpha = colors.shape[1] == 4
    attributes: dict[str, npt.NDArray[np.float32] | npt.NDArray[np.uint8]] = {
        "POSITION": points
    }
    extras: dict[str, object] = {
        "shape": style.shape,
        "size": list(style.size),
        "alpha": style.alpha,
        "twice": style.is_twice,
        "byDepth": style.is_by_depth,
        "normal": list(style.normal),
        "up": list(style.up),
    }
    if len(colors) == 1 and len(points) > 1:
        extras["color"] = [*colors[0].tolist(), 255][:4]
    else:
        # Rows of three bytes would not be aligned.
        rows = np.empty((len(points), 4), np.uint8)
        rows[:, 3] = 255
        rows[:, : colors.shape[1]] = colors
        attributes["COLOR_0"] = rows
    blended = style.alpha < OPAQUE_FROM or has_alpha
    return drawn_glb(
        "points",
        attributes,
        extras=extras,
        mode=POINTS,
        blended=blended,
        has_bounds=False,
    )
