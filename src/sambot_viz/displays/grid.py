"""Grid: lines in a plane of a frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.displays.display import Display, DisplayContext, Status
from sambot_viz.displays.picking.pick_geometry import PickGeometry
from sambot_viz.displays.picking.rays import Array
from sambot_viz.displays.scene.frame_nodes import Handle, NodeCache
from sambot_viz.displays.scene.lines import in_pieces, lines_glb
from sambot_viz.displays.scene.ribbons import segment_ribbons
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.displays.scene_size import SceneSize, round_size
from sambot_viz.geometry import Matrix, Vector3, Wxyz
from sambot_viz.rviz import (
    FIXED_FRAME,
    ColorProperty,
    DisplayConfig,
    EnumProperty,
    FloatProperty,
    IntProperty,
    TfFrameProperty,
    VectorProperty,
)

_HALF = 0.5**0.5
_PLANES: dict[str, Wxyz] = {
    "XY": (_HALF, -_HALF, 0.0, 0.0),
    "XZ": (1.0, 0.0, 0.0, 0.0),
    "YZ": (0.5, 0.5, -0.5, 0.5),
}
"""Turns the grid's own axes (normal along y) into the plane, as RViz does."""
_NORMALS = {"XY": (0.0, 0.0, 1.0), "XZ": (0.0, 1.0, 0.0), "YZ": (1.0, 0.0, 0.0)}
_SIDES = ("Plane", "Normal")
CELLS = 2.0
"""Cells that are as long as the robot, about: ten show five of it."""
NEAR_LINE = 3.0
"""A line of a grid is met from so far [pixels]."""


def line_count(cells: int, layers: int) -> int:
    """Return how many lines a grid has."""
    uprights = (cells + 1) ** 2 if layers else 0
    return 2 * (cells + 1) * (layers + 1) + uprights


def drawn_cells(cells: int, layers: int) -> tuple[int, int]:
    """The counts to draw: halved until the lines are no more than may be."""
    while line_count(cells, layers) > limits.GRID_LINES.value:
        if layers > cells:
            layers //= 2
        else:
            cells //= 2
    return cells, layers


def grid_segments(cells: int, layers: int, size: float) -> npt.NDArray[np.float32]:
    """Return the lines of a grid in its own axes: in-plane x and z, normal y.

    Args:
        cells: cells along each side, N.
        layers: cells along the normal, H; the layers are centred on the plane.
        size: edge of a cell [m].

    Returns:
        (2·(N+1)·(H+1), plus (N+1)² with layers, 2, 3) float32 [m].
    """
    extent = cells * size / 2
    at = extent - np.arange(cells + 1) * size
    heights = (layers / 2 - np.arange(layers + 1)) * size
    y, c = (grid.ravel() for grid in np.meshgrid(heights, at, indexing="ij"))
    edge = np.full_like(c, extent)
    along_z = np.stack([np.stack([c, y, -edge], 1), np.stack([c, y, edge], 1)], 1)
    along_x = np.stack([np.stack([-edge, y, c], 1), np.stack([edge, y, c], 1)], 1)
    parts = [along_z, along_x]
    if layers > 0:
        x, z = (grid.ravel() for grid in np.meshgrid(at, at, indexing="ij"))
        top = np.full_like(x, layers * size / 2)
        parts.append(np.stack([np.stack([x, -top, z], 1), np.stack([x, top, z], 1)], 1))
    return np.concatenate(parts).astype(np.float32)


@dataclass(frozen=True, slots=True)
class GridLines(PickGeometry):
    """The lines of a grid, in the plane z = 0 or another pair of axes of its frame.

    Attributes:
        T: (4, 4) from the grid's frame to the fixed frame.
        normal: which axis of that frame is across the plane, (3,).
        offset: middle of the square in that frame, (3,) [m].
        cells: how many cells there are along each side.
        cell: side of a cell [m].
        thickness: of a line [m].
    """

    T: Matrix
    normal: Array
    offset: Array
    cells: int
    cell: float
    thickness: float = 0.0

    def cast(self, origin: Array, direction: Array, pixel: float) -> float:
        """Follow a ray to a line, which is met from `NEAR_LINE` pixels."""
        o = (origin - self.T[:3, 3]) @ self.T[:3, :3] - self.offset
        d = direction @ self.T[:3, :3]
        towards = float(d @ self.normal)
        if towards == 0.0:
            return np.inf
        t = -float(o @ self.normal) / towards
        if t < 0.0:
            return np.inf
        reach = max(NEAR_LINE * pixel * t, self.thickness / 2)
        half = self.cells * self.cell / 2
        place, along = (o + t * d)[self.normal == 0], d[self.normal == 0]
        # From each coordinate to the nearest line across it, in the plane …
        line = np.round((place + half) / self.cell).clip(0, self.cells)
        aside = np.abs(place - (line * self.cell - half))
        # … and between the ray and that line, which is less at a flat angle.
        apart = aside * abs(towards) / np.sqrt(1.0 - along[::-1] ** 2)
        inside = np.abs(place[::-1]) <= half + reach
        return t if bool(np.any((apart <= reach) & inside)) else np.inf


class GridDisplay(Display):
    """A grid around the origin of its reference frame."""

    kind = "rviz_default_plugins/Grid"
    properties = (
        TfFrameProperty(
            "Reference Frame",
            default=FIXED_FRAME,
            help="The frame at whose origin the grid is drawn.",
        ),
        IntProperty(
            "Plane Cell Count",
            default=10,
            minimum=1,
            help="How many cells the grid has along each side.",
        ),
        IntProperty(
            "Normal Cell Count",
            default=0,
            minimum=0,
            help="How many cells the grid has along its normal; 0 draws one plane.",
        ),
        FloatProperty(
            "Cell Size",
            default=1.0,
            minimum=0.0001,
            unit="m",
            help="Length of the side of a cell.",
        ),
        EnumProperty(
            "Line Style",
            default="Lines",
            options=("Lines", "Billboards"),
            help="Hairlines, or ribbons that have a width in metres.",
            children=(
                FloatProperty(
                    "Line Width",
                    default=0.03,
                    minimum=0.001,
                    unit="m",
                    help="Width of the ribbons.",
                    hidden_unless=("Line Style", "Billboards"),
                ),
            ),
        ),
        ColorProperty("Color", default=(160, 160, 164), help="Colour of the lines."),
        FloatProperty(
            "Alpha",
            default=0.5,
            minimum=0.0,
            maximum=1.0,
            help="How opaque the lines are: 0 is invisible, 1 opaque.",
        ),
        EnumProperty(
            "Plane",
            default="XY",
            options=("XY", "XZ", "YZ"),
            help="The plane in which the grid lies.",
        ),
        VectorProperty(
            "Offset",
            default=(0.0, 0.0, 0.0),
            unit="m",
            help="Moves the grid away from the origin of its frame.",
        ),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._nodes = NodeCache()

    @classmethod
    def size_values(cls, size: SceneSize) -> Mapping[str, float]:
        """Return cells that the robot fills by two."""
        return {"Cell Size": round_size(size.length / CELLS)}

    def draw(self) -> None:
        """Draw the grid, unless it is drawn already."""
        frame = self.context.frame(self.config.get("Reference Frame"))
        if self.context.lookup_problem(frame) is not None:
            self.clear()
            fixed = self.context.fixed_frame
            sentence = f"Could not transform from [{frame}] to [{fixed}]"
            self.status.replace({"Transform": Status("Error", sentence)})
            return
        name = f"{self.context.above(frame)}/{self.key}"
        state = (name, *self.config.properties.values())
        self._nodes.show(state, lambda: (self._add_lines(name),))
        self._report()

    def _counts(self) -> tuple[int, int]:
        """Return the cells along each side and along the normal, as they are drawn."""
        cells = int(self.config.get("Plane Cell Count"))
        return drawn_cells(cells, int(self.config.get("Normal Cell Count")))

    def _report(self) -> None:
        rows = {"Transform": Status("Ok", "Ok")}
        cells, layers = self._counts()
        asked = [int(self.config.get(f"{side} Cell Count")) for side in _SIDES]
        if [cells, layers] != asked:
            said = limits.GRID_LINES.said(line_count(asked[0], asked[1]))
            rows["Cells"] = Status(
                "Warn",
                f"Too many cells to draw ({said}): {cells} are drawn along each side"
                + (f" and {layers} along the normal" if layers else ""),
            )
        self.status.replace(rows)

    def _add_lines(self, name: str) -> Handle:
        get, scene = self.config.get, self.context.scene
        segments = grid_segments(*self._counts(), float(get("Cell Size")))
        color: Rgb = get("Color")
        alpha = float(get("Alpha"))
        wxyz = _PLANES.get(str(get("Plane")), _PLANES["XY"])
        offset: Vector3 = get("Offset")
        if get("Line Style") == "Billboards":
            glb = segment_ribbons(
                segments, float(get("Line Style/Line Width")), color, alpha
            )
        else:
            pieces = in_pieces(segments, float(get("Cell Size")))
            glb = lines_glb(pieces, color, alpha)
        return scene.add_glb(
            name,
            glb,
            cast_shadow=False,
            receive_shadow=False,
            wxyz=wxyz,
            position=offset,
        )

    def pick_geometry(self) -> PickGeometry:
        """Return its lines, which can be measured to and select nothing."""
        get = self.config.get
        T = self.context.pose(self.context.frame(get("Reference Frame")))
        if T is None:
            return PickGeometry()
        ribbons = get("Line Style") == "Billboards"
        return GridLines(
            T,
            np.array(_NORMALS.get(str(get("Plane")), _NORMALS["XY"])),
            np.array(get("Offset")),
            int(get("Plane Cell Count")),
            float(get("Cell Size")),
            float(get("Line Style/Line Width")) if ribbons else 0.0,
        )

    def clear(self) -> None:
        """Take the grid out of the scene."""
        self._nodes.remove()
