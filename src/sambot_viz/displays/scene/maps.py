"""Maps: the cells of an occupancy grid as textured squares, and their palettes."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from functools import cache

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.picking.placed import PlacedMesh
from sambot_viz.displays.picking.triangle_mesh import TriangleMesh
from sambot_viz.displays.scene.frame_nodes import placed, short_id
from sambot_viz.displays.scene.glb_node import ONE_PIXEL, GlbNode, drawn_glb
from sambot_viz.displays.scene.posed_node import PosedNode
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix, Vector3, Wxyz
from sambot_viz.meshes.glb import OPAQUE_FROM

Cells = npt.NDArray[np.uint8]
Palette = npt.NDArray[np.uint8]

TILE = 512
"""Edge of a square of a map [cells]: what an update sends again."""
SCHEMES = ("map", "costmap", "raw")
UNKNOWN = (112, 137, 134)
_LAST_LEGAL = 100


def palette(scheme: str, is_binary: bool = False, threshold: int = 100) -> Palette:
    """Return the colour of each value of a cell, as RViz 14.

    Value 0 of the costmap is transparent, which RViz 14 forgets at alpha 1.

    Args:
        scheme: one of `SCHEMES`; another one is "map".
        is_binary: whether only less than the threshold and not less are told apart.
        threshold: 0 to 100.

    Returns:
        (256, 4) uint8, RGBA; a value of −1 is 255.
    """
    value = np.arange(256)
    colors = np.full((256, 4), 255, np.int64)
    if scheme == "raw":
        grey = np.where(value < threshold, 0, 255) if is_binary else value
        colors[:, :3] = grey[:, None]
        return colors.astype(np.uint8)
    legal = value[: _LAST_LEGAL + 1]
    share = 255 * legal // 100
    rest, full, none = 255 - share, np.full_like(share, 255), np.zeros_like(share)
    if scheme == "costmap":
        shown = [share, none, rest, full]
        if is_binary:
            high = np.where(legal < threshold, 0, 255)
            shown = [high, none, 255 - high, full]
    else:
        grey = np.where(legal < threshold, 255, 0) if is_binary else rest
        shown = [grey, grey, grey, full]
    colors[: _LAST_LEGAL + 1] = np.stack(shown, axis=1)
    if scheme == "costmap" and not is_binary:
        colors[[0, 99, 100]] = (0, 0, 0, 0), (0, 255, 255, 255), (255, 0, 255, 255)
    colors[101:128, :3] = (0, 255, 0)
    illegal = value[128:255]
    colors[128:255, 1] = 255 * (illegal - 128) // 126
    colors[128:255, 2] = 0
    colors[255, :3] = UNKNOWN
    return colors.astype(np.uint8)


class MapNode(PosedNode[viser.FrameHandle]):
    """The cells of one map, in squares of `TILE` cells below a node with its pose.

    A square is sent again only if one of its cells has changed; the palette, the alpha
    and the order of drawing are a separate file of 2.6 kB.

    Args:
        scene: viser's scene.
        name: name of the node; it is drawn in the frame of its parent node.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        super().__init__(scene, name)
        self._look = GlbNode(scene, f"{name}/~")
        self._tiles: dict[tuple[int, int], GlbNode] = {}
        self._cells: Cells | None = None
        self._resolution = 0.0
        self._hides = False

    def draw(
        self,
        cells: Cells,
        colors: Palette,
        resolution: float,
        *,
        alpha: float = 1.0,
        is_behind: bool = False,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw a map; what has not changed is not sent again.

        Args:
            cells: (rows, columns); row 0 has the lowest y. No cells draw nothing.
            colors: (256, 4) RGBA, such as `palette` returns.
            resolution: edge of a cell [m].
            alpha: 0 to 1; multiplies the alpha of the colours.
            is_behind: whether all else is drawn over it.
            wxyz: rotation of the corner of cell (0, 0) in the frame of the node above.
            position: of that corner there [m].
        """
        good = np.isfinite(resolution) and 0 < resolution < 1e30 / max(1, *cells.shape)
        if not cells.size or not good:
            self.remove()
            return
        if self.is_gone:
            self.remove()
        self._place(wxyz, position)
        before = self._cells
        if (
            before is None
            or before.shape != cells.shape
            or self._resolution != resolution
        ):
            self._drop_tiles()
            before = None
        self._cells, self._resolution = np.array(cells, np.uint8), float(resolution)
        for row, column in _tiles(cells.shape):
            part = _square(row, column)
            if before is None or not np.array_equal(before[part], self._cells[part]):
                self._draw_tile(row, column)
        look: dict[str, object] = {
            "map": self._name,
            "palette": base64.b64encode(colors.astype(np.uint8).tobytes()).decode(),
            "alpha": float(min(1.0, max(0.0, alpha))),
            "behind": bool(is_behind),
        }
        self._hides = alpha >= OPAQUE_FROM and not is_behind
        self._look.show((look,), lambda: _look_glb(look))

    def update(self, x: int, y: int, cells: Cells) -> None:
        """Replace a rectangle of cells; it must be inside the map that was drawn.

        Args:
            x: first column.
            y: first row.
            cells: (rows, columns).
        """
        if self._cells is None or not cells.size:
            return
        rows, columns = cells.shape
        self._cells[y : y + rows, x : x + columns] = cells
        for row in range(y // TILE, (y + rows - 1) // TILE + 1):
            for column in range(x // TILE, (x + columns - 1) // TILE + 1):
                self._draw_tile(row, column)

    def placed(self, T_fixed_above: Matrix) -> Iterator[PlacedMesh]:
        """Yield the map for rays, as one square; nothing of it can be selected.

        Args:
            T_fixed_above: (4, 4), of the node above.
        """
        if self._cells is None or not self.is_drawn:
            return
        T = self.place(T_fixed_above)
        rows, columns = self._cells.shape
        T[:3, :3] *= (columns * self._resolution, rows * self._resolution, 1.0)
        yield PlacedMesh(None, _square_mesh(), T, is_clear=not self._hides)

    def remove(self) -> None:
        """Take the map out of the scene."""
        self._drop_tiles()
        self._look.remove()
        super().remove()

    def _place(self, wxyz: Wxyz, position: Vector3) -> None:
        pose = placed(wxyz, position)
        if self._handle is None:
            frame = self._scene.add_frame(
                self._name, show_axes=False, wxyz=pose[0], position=pose[1]
            )
            self.has_made(frame, pose)
        else:
            self.move(pose)

    def _drop_tiles(self) -> None:
        for tile in self._tiles.values():
            tile.remove()
        self._tiles.clear()
        self._cells = None

    def _draw_tile(self, row: int, column: int) -> None:
        assert self._cells is not None
        part = self._cells[_square(row, column)]
        corner, resolution = (column * TILE, row * TILE), self._resolution
        number = short_id(len(self._tiles))
        tile = self._tiles.setdefault(
            (row, column), GlbNode(self._scene, f"{self._name}/{number}")
        )
        tile.show(
            (part, corner, resolution),
            lambda: tile_glb(self._name, part, corner, resolution),
        )


@cache
def _square_mesh() -> TriangleMesh:
    """Return a square between 0 and 1, seen from above and from below."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], np.float32)
    return TriangleMesh.of(corners, np.array([[0, 1, 2], [2, 1, 3]])).both_sides()


def _tiles(shape: tuple[int, ...]) -> Iterator[tuple[int, int]]:
    """Yield the row and column of each square of a map."""
    rows, columns = shape
    for row in range(-(-rows // TILE)):
        for column in range(-(-columns // TILE)):
            yield row, column


def _square(row: int, column: int) -> tuple[slice, slice]:
    """Return where the cells of a square are."""
    top, left = row * TILE, column * TILE
    return slice(top, top + TILE), slice(left, left + TILE)


def _look_glb(look: dict[str, object]) -> bytes:
    """Return a GLB file without geometry that carries the look of a map."""
    corners = np.zeros((3, 3), np.float32)
    attributes = {"POSITION": corners, "TEXCOORD_0": corners[:, :2]}
    return drawn_glb("map", attributes, extras=look, image=ONE_PIXEL)


def tile_glb(
    name: str, cells: Cells, corner: tuple[int, int], resolution: float
) -> bytes:
    """Return a GLB file of one square of a map.

    Args:
        name: of the map.
        cells: (rows, columns).
        corner: column and row of its first cell in the map.
        resolution: edge of a cell [m].
    """
    rows, columns = cells.shape
    uv = np.array([[0, 0], [1, 0], [0, 1], [1, 1]], np.float32)
    at = (uv * (columns, rows) + corner) * resolution
    return drawn_glb(
        "mapTile",
        {
            "POSITION": np.column_stack([at, np.zeros(4)]).astype(np.float32),
            "TEXCOORD_0": uv,
            "_CELLS": np.reshape(packed(cells), (-1, 1)),
        },
        extras={"map": name, "rows": rows, "columns": columns},
        indices=np.array([0, 1, 2, 2, 1, 3], np.uint32),
    )


def packed(cells: Cells) -> Cells:
    """Return cells as the page unpacks them: as they are, or as runs if it is less.

    A picture would be smaller still, but browsers decode pictures in their own time,
    and a map with ten updates a second would never be there.

    Args:
        cells: (rows, columns).

    Returns:
        (rows · columns,), or (2 · runs,): a value, and how often it is there less one.
    """
    flat: Cells = np.ravel(cells)
    ends = np.append(np.flatnonzero(flat[1:] != flat[:-1]) + 1, len(flat))
    lengths = np.diff(ends, prepend=0)
    # A run of more than 256 is several.
    pieces = (lengths + 255) // 256
    last = np.cumsum(pieces) - 1
    if 2 * (last[-1] + 1) >= len(flat):
        return flat
    counts = np.full(last[-1] + 1, 255, np.uint8)
    counts[last] = (lengths - 1) % 256
    values = np.repeat(flat[ends - 1], pieces)
    return np.ravel(np.stack([values, counts], axis=1))
