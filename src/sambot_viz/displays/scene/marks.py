"""Marks that are seen through everything: a ball, lines, and a clear face."""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.scene.glb_node import (
    LINES,
    TRIANGLES,
    GlbNode,
    drawn_glb,
    rgba_rows,
    single,
)
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.geometry import IDENTITY, Vector3
from sambot_viz.meshes.primitives import unit_sphere

BLACK: Rgb = (0, 0, 0)


class BallMark(GlbNode):
    """The sign of a centre of mass: a ball whose eighths have two colours in turn."""

    def draw(self, radius: float, color: Rgb, position: Vector3) -> None:
        """Draw the ball.

        Args:
            radius: [m].
            color: beside black, 0 to 255.
            position: of its middle in the frame of the node above [m].
        """

        def make() -> bytes:
            corners, is_black = _ball()
            colors = np.where(is_black[:, None], BLACK, color)
            return _mark(2.0 * radius * corners, colors, above=2)

        self.show((radius, color), make, IDENTITY, position)


class LinesMark(GlbNode):
    """Lines of one pixel."""

    def draw(self, segments: npt.ArrayLike, color: Rgb) -> None:
        """Draw them.

        Args:
            segments: (N, 2, 3), start and end of each in the node above [m].
            color: 0 to 255.
        """
        points = np.reshape(single(segments), (-1, 3))
        self.show((points, color), lambda: _mark(points, color, LINES, above=1))


class FaceMark(GlbNode):
    """A convex polygon that can be seen through."""

    def draw(self, corners: npt.ArrayLike, color: Rgb, alpha: float) -> None:
        """Draw it.

        Args:
            corners: (N, 3), at least three, counter-clockwise, in the node above [m].
            color: 0 to 255.
            alpha: 0 to 1.
        """
        points = np.reshape(single(corners), (-1, 3))
        fan = [(0, i, i + 1) for i in range(1, len(points) - 1)]
        faces = points[np.array(fan).ravel()]
        # It is seen from below too.
        both = np.concatenate((faces, faces[::-1]))
        self.show(
            (points, color, alpha), lambda: _mark(both, color, above=0, alpha=alpha)
        )


def _mark(
    points: npt.NDArray[np.float32],
    color: npt.ArrayLike,
    mode: int = TRIANGLES,
    *,
    above: int,
    alpha: float = 1.0,
) -> bytes:
    """Return a GLB file.

    Args:
        points: (N, 3) [m].
        color: of all (3,) or of each (N, 3), 0 to 255.
        mode: `LINES` or `TRIANGLES`.
        above: marks with a smaller number are drawn before.
        alpha: 0 to 1.
    """
    each = np.asarray(color, np.float64)
    each = np.broadcast_to(each, (len(points), 3))
    colors = rgba_rows(each, alpha, len(points))
    attributes = {"POSITION": single(points), "COLOR_0": colors}
    extras = {"above": above}
    return drawn_glb("mark", attributes, extras=extras, mode=mode, blended=True)


@cache
def _ball() -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]:
    """Return the triangles of a ball of diameter 1, (3 N, 3), and which are black."""
    ball = unit_sphere()
    corners = ball.vertices[ball.faces]
    middles = corners.mean(axis=1)
    is_black = (middles > 0.0).sum(axis=1) % 2 == 0
    return np.reshape(corners, (-1, 3)), np.repeat(is_black, 3)
