"""Lines in the scene: segments, and lines with a width that grow at their ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.picking.placed_lines import PlacedLines
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.scene.frame_nodes import any_gone, remove_all
from sambot_viz.displays.scene.glb_node import (
    LINE_STRIP,
    LINES,
    GlbNode,
    drawn_glb,
    rgba_rows,
    single,
)
from sambot_viz.displays.scene.solids import Rgb, linear
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix, Vector3, Wxyz
from sambot_viz.meshes.glb import OPAQUE_FROM, glb_file

_FLOAT, _LINES = 5126, 1
Floats = npt.NDArray[np.float32]

MOST_PIECES = 20000
"""More pieces than this are not made of lines (0.5 MB)."""


def in_pieces(
    segments: npt.NDArray[np.float32], longest: float
) -> npt.NDArray[np.float32]:
    """Cut lines into pieces.

    A GL line with an end behind the camera is dropped as a whole by some renderers
    (software WebGL does so); of a line in pieces only the nearest piece is lost.

    Args:
        segments: (N, 2, 3) float32 [m].
        longest: length that a piece should not exceed [m].

    Returns:
        (M, 2, 3) float32; M ≥ N.
    """
    start, step = segments[:, 0], segments[:, 1] - segments[:, 0]
    length = float(np.linalg.norm(step, axis=1).max())
    count = max(1, min(int(np.ceil(length / longest)), MOST_PIECES // len(segments)))
    at = np.arange(count + 1, dtype=np.float32)[:, None, None] / count
    points = start[None] + at * step[None]
    pieces = np.stack([points[:-1], points[1:]], axis=2)
    return np.concatenate(list(pieces)).astype(np.float32)


def lines_glb(
    segments: npt.NDArray[np.float32], color: tuple[int, int, int], alpha: float
) -> bytes:
    """Return a GLB file of line segments.

    Args:
        segments: (N, 2, 3) float32, start and end of each line [m].
        color: 0 to 255.
        alpha: 0 to 1; from `OPAQUE_FROM` on the lines are opaque and write depth.

    Returns:
        The bytes for `viser.SceneApi.add_glb`.
    """
    points = np.array(segments, dtype="<f4")
    rgba = [*(linear(c) for c in color), alpha]
    blended = alpha < OPAQUE_FROM
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [
            {
                "primitives": [
                    {"attributes": {"POSITION": 0}, "mode": _LINES, "material": 0}
                ]
            }
        ],
        "materials": [
            {
                "pbrMetallicRoughness": {"baseColorFactor": rgba, "metallicFactor": 0},
                "alphaMode": "BLEND" if blended else "OPAQUE",
            }
        ],
        "buffers": [{"byteLength": points.nbytes}],
        "bufferViews": [{"buffer": 0, "byteLength": points.nbytes}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": _FLOAT,
                "count": 2 * len(points),
                "type": "VEC3",
                "min": points.min(axis=(0, 1)).tolist(),
                "max": points.max(axis=(0, 1)).tolist(),
            }
        ],
    }
    return glb_file(document, points.tobytes())


class LinesNode(GlbNode):
    """Lines in one node, of which those that derive from it say where they are."""

    _lines: Callable[[], tuple[Floats, float]]
    """Returns those that were drawn last, (N, 2, 3) [m], and how wide they are [m]."""

    def placed(
        self, T_fixed_above: Matrix, item: Selectable | None
    ) -> Iterator[PlacedLines]:
        """Yield the lines for rays, if there are any.

        Args:
            T_fixed_above: (4, 4), of the node above.
            item: what they are to a selection.
        """
        if self.is_drawn:
            segments, width = self._lines()
            yield PlacedLines(item, segments, self.place(T_fixed_above), width)


class LineNode(LinesNode):
    """Lines that are one pixel wide at any distance, in one node."""

    def draw(
        self,
        segments: npt.ArrayLike,
        color: npt.ArrayLike,
        *,
        alpha: float = 1.0,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw the lines; those that are not finite are left out.

        Args:
            segments: (N, 2, 3), start and end of each [m].
            color: one for all (3,), or one for each end with its alpha (N, 2, 4); 0 to
                255. Between the ends the colours change evenly.
            alpha: 0 to 1; where one of the ends is not opaque, all are blended.
            wxyz: rotation in the frame of the node above.
            position: there [m].
        """
        given: Floats = np.reshape(single(segments), (-1, 2, 3))
        each = np.asarray(color)
        each = np.reshape(each, (-1, 4)) if each.ndim > 1 else each
        rgba = rgba_rows(each, alpha, 2 * len(given))
        finite = np.isfinite(given).all(axis=(1, 2))
        points: Floats = np.reshape(given[finite], (-1, 3))
        colors = rgba[np.repeat(finite, 2)]
        if not len(points):
            self.remove()
            return
        self._lines = lambda: (np.reshape(points, (-1, 2, 3)), 0.0)
        self.show(
            (points, colors),
            lambda: drawn_glb(
                "lines",
                {"POSITION": points, "COLOR_0": colors},
                mode=LINES,
                blended=bool(colors[:, 3].min() < 255),
            ),
            wxyz,
            position,
        )

    def draw_chain(
        self,
        points: npt.ArrayLike,
        color: Rgb,
        *,
        alpha: float = 1.0,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw a line from each point to the next; each point is sent once.

        Args:
            points: (N, 3) [m]; no line leads to or from one that is not finite.
            color: 0 to 255.
            alpha: as for `draw`, like the others.
            wxyz: rotation in the frame of the parent node.
            position: position there [m].
        """
        at: Floats = np.ascontiguousarray(single(points))
        if len(at) < 2 or not np.isfinite(at).all():
            chain = chain_segments(at)
            self.draw(chain, color, alpha=alpha, wxyz=wxyz, position=position)
            return
        (rgba,) = rgba_rows(color, alpha, 1)
        self._lines = lambda: (chain_segments(at), 0.0)
        self.show(
            (at, rgba),
            lambda: drawn_glb(
                "lines",
                {"POSITION": at},
                mode=LINE_STRIP,
                blended=bool(rgba[3] < 255),
                color=rgba,
            ),
            wxyz,
            position,
        )


def chain_segments(points: npt.ArrayLike, closed: bool = False) -> npt.NDArray[Any]:
    """Return the lines from each point to the next, (N − 1, 2, 3).

    Args:
        points: (N, 3).
        closed: adds the line from the last to the first.
    """
    at: npt.NDArray[Any] = np.reshape(np.asarray(points), (-1, 3))
    ends = np.roll(at, -1, axis=0) if closed else at[1:]
    return np.stack([at[: len(ends)], ends], axis=1)


COLOR = (255, 170, 0)
WIDTH = 0.012
HEIGHT = 0.004
"""Height above the floor, so that the grid does not hide the line [m]."""
PIECE = 200
"""Points of one node: only the newest node is sent again."""


class Ribbon:
    """One line through points.

    Args:
        scene: where to draw.
        name: of its node.
        color: 0 to 255.
        width: [m].
    """

    def __init__(
        self, scene: viser.SceneApi, name: str, color: Rgb, width: float
    ) -> None:
        self._scene = scene
        self._name = name
        self._color, self._width = color, width
        self._node: viser.LineSegmentsHandle | None = None
        self._visible = True

    @property
    def gone(self) -> bool:
        """Return whether its node went with the frame that it hung below."""
        return self._node is not None and any_gone([self._node])

    def draw(self, points: npt.NDArray[np.float32]) -> None:
        """Send the line through some points, (N, 3) with N ≥ 2 [m]."""
        segments = np.stack([points[:-1], points[1:]], axis=1)
        if self._node is not None:
            self._node.points = segments
            return
        self._node = self._scene.add_line_segments(
            self._name, segments, colors=self._color, thickness=self._width
        )
        self._node.visible = self._visible

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        self._visible = visible
        if self._node is not None:
            self._node.visible = visible

    def remove(self) -> None:
        """Take it out of the scene."""
        if self._node is not None:
            remove_all([self._node])
            self._node = None


class PathLine:
    """Draws a growing list of points on the floor.

    Args:
        scene: where to draw.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._pieces: list[Ribbon] = []
        self._drawn = 1

    def draw(self, above: str | None, points: Sequence[tuple[float, float]]) -> bool:
        """Draw the new points; a list that became shorter is drawn from the start.

        Args:
            above: the node of the frame of the points; None draws nothing.
            points: x, y [m].

        Returns:
            Whether something was sent.
        """
        forgotten = False
        if any(piece.gone for piece in self._pieces) or len(points) < self._drawn:
            self.remove()
            forgotten = True
        if above is None or len(points) == self._drawn:
            return forgotten
        first = (self._drawn - 1) // PIECE
        for number in range(first, (len(points) - 2) // PIECE + 1):
            start = number * PIECE
            piece = np.array(points[start : start + PIECE + 1], np.float32)
            self._draw_piece(f"{above}/~drive{number}", number, piece)
        self._drawn = len(points)
        return True

    def remove(self) -> None:
        """Remove the line from the scene."""
        for piece in self._pieces:
            piece.remove()
        self._pieces.clear()
        self._drawn = 1

    def _draw_piece(
        self, name: str, number: int, piece: npt.NDArray[np.float32]
    ) -> None:
        if number == len(self._pieces):
            self._pieces.append(Ribbon(self._scene, name, COLOR, WIDTH))
        height = np.full(len(piece), HEIGHT, np.float32)
        self._pieces[number].draw(np.column_stack([piece, height]))
