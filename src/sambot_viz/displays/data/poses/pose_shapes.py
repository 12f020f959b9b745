"""Arrows and axes at poses, and the properties that say how they look."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.data.properties import alpha_property, metres
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.scene.lines import LineNode
from sambot_viz.displays.scene.solid_nodes import ArrowsNode, AxesNode, rotated
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.displays.scene_size import SceneSize, round_size
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix, Vector3, Wxyz
from sambot_viz.rviz import ColorProperty, ConfigItem, EnumProperty, Property

Floats = npt.NDArray[np.float64]
ARROW, AXES = "Arrow", "Axes"
FLAT_ARROW, SOLID_ARROW = "Arrow (Flat)", "Arrow (3D)"
ARROW_LENGTHS = (1.0, 0.05, 0.3, 0.1)
"""RViz's length and diameter of a shaft, then of a head [m]."""
_ARROW_PARTS = ("Shaft Length", "Shaft Radius", "Head Length", "Head Radius")
COLOR = (255, 25, 0)
_FLAT = np.array([(1.0, 0.0, 0.0), (0.75, 0.2, 0.0), (0.75, -0.2, 0.0)])
"""The tip of a flat arrow of length 1, and the ends of the lines that go back."""


@dataclass(frozen=True, slots=True)
class PoseLook:
    """How poses are drawn.

    Attributes:
        shape: `ARROW`, `SOLID_ARROW`, `FLAT_ARROW` or `AXES`.
        color: of arrows, 0 to 255.
        alpha: of arrows, 0 to 1.
        shaft: length and diameter [m].
        head: length and diameter [m].
        axes: length and diameter [m].
        flat: length of flat arrows [m].
    """

    shape: str
    color: Rgb = COLOR
    alpha: float = 1.0
    shaft: tuple[float, float] = (1.0, 0.05)
    head: tuple[float, float] = (0.3, 0.1)
    axes: tuple[float, float] = (1.0, 0.1)
    flat: float = 0.3


class PoseShapes:
    """Draws poses; a node for each kind of shape.

    Args:
        scene: where to draw.
        name: what the names of the nodes begin with.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self._arrows = ArrowsNode(scene, f"{name}a")
        self._axes = AxesNode(scene, f"{name}x")
        self._lines = LineNode(scene, f"{name}l")

    def draw(
        self,
        look: PoseLook,
        wxyzs: npt.ArrayLike,
        positions: npt.ArrayLike,
        wxyz: Wxyz = IDENTITY,
        position: Vector3 = ORIGIN,
        *,
        sizes: npt.ArrayLike = 1.0,
    ) -> None:
        """Draw poses, and nothing else.

        Args:
            look: how.
            wxyzs: (N, 4), their rotations.
            positions: (N, 3) [m].
            wxyz: rotation of all in the frame of the node above.
            position: there [m].
            sizes: of all, or of each (N,), by what the look says.
        """
        is_solid = look.shape in (ARROW, SOLID_ARROW)
        turns: Floats = np.reshape(np.asarray(wxyzs, np.float64), (-1, 4))
        places: Floats = np.reshape(np.asarray(positions, np.float64), (-1, 3))
        pose: dict[str, Any] = {"wxyz": wxyz, "position": position}
        if is_solid and len(turns):
            parts = look.shaft, look.head, look.color
            self._arrows.draw(
                turns, places, *parts, alpha=look.alpha, sizes=sizes, **pose
            )
        else:
            self._arrows.remove()
        if look.shape == AXES and len(turns):
            self._axes.draw(turns, places, *look.axes, sizes=sizes, **pose)
        else:
            self._axes.remove()
        if look.shape == FLAT_ARROW and len(turns):
            flat = look.flat * _FLAT
            long = np.asarray(sizes, np.float64)[..., None]
            tip, left, right = (places + long * rotated(turns, end) for end in flat)
            lines = np.stack([places, tip, tip, left, tip, right], axis=1)
            self._lines.draw(
                np.reshape(lines, (-1, 2, 3)), look.color, alpha=look.alpha, **pose
            )
        else:
            self._lines.remove()

    def placed(
        self, T_fixed_above: Matrix, item: Selectable | None
    ) -> Iterator[Placed]:
        """Yield the shapes for rays (see `scene.points.PointNode.placed`)."""
        for node in (self._arrows, self._axes, self._lines):
            yield from node.placed(T_fixed_above, item)

    def remove(self) -> None:
        """Take all out of the scene."""
        for node in (self._arrows, self._axes, self._lines):
            node.remove()


def arrow_properties(
    shape: Any,
    lengths: tuple[float, float, float, float] = ARROW_LENGTHS,
    order: tuple[int, ...] = (0, 1, 2, 3),
) -> tuple[Property, ...]:
    """Return the sizes of an arrow.

    Args:
        shape: as for `metres`.
        lengths: length and diameter of the shaft, then of the head [m].
        order: in which they stand.
    """
    made = (
        metres("Shaft Length", lengths[0], "Length of the shaft.", shape),
        metres("Shaft Radius", lengths[1], "Diameter of the shaft, as RViz.", shape),
        metres("Head Length", lengths[2], "Length of the head.", shape),
        metres("Head Radius", lengths[3], "Diameter of the head, as RViz.", shape),
    )
    return tuple(made[index] for index in order)


def axes_properties(
    shape: Any, length: float = 1.0, radius: float = 0.1
) -> tuple[Property, ...]:
    """Return the sizes of axes (see `metres`)."""
    return (
        metres("Axes Length", length, "Length of each axis.", shape),
        metres("Axes Radius", radius, "Diameter of each axis, as RViz.", shape),
    )


def arrow_sizes(size: SceneSize, path: str = "") -> Mapping[str, float]:
    """Return an arrow whose shaft is as long as the robot, in RViz's proportions.

    Args:
        size: of the robot.
        path: as for `look_of`.
    """
    length = round_size(size.length)
    lengths = zip(_ARROW_PARTS, ARROW_LENGTHS, strict=True)
    return {f"{path}{name}": round(length * part, 6) for name, part in lengths}


def color_property(default: Rgb = COLOR, shape: Any = None) -> ColorProperty:
    """Return the colour of arrows."""
    return ColorProperty(
        "Color", default=default, help="The colour.", hidden_unless=shape
    )


def many_poses_properties(each: str) -> tuple[Property, ...]:
    """Return the properties of the topic and of the shape of all poses.

    Args:
        each: what one of them is.
    """
    if_arrow = ("Shape", (FLAT_ARROW, SOLID_ARROW))
    return (
        topic_property(),
        EnumProperty(
            "Shape",
            default=FLAT_ARROW,
            options=(FLAT_ARROW, SOLID_ARROW, AXES),
            help=f"How each {each} is drawn.",
        ),
        color_property(shape=if_arrow),
        alpha_property(hidden_unless=if_arrow),
    )


def look_of(config: ConfigItem, path: str = "") -> PoseLook:
    """Return how a display draws poses.

    Args:
        config: of the display.
        path: what the paths of its properties begin with.
    """

    def get(name: str) -> Any:
        return config.get(path + name)

    return PoseLook(
        shape=str(config.acting("Shape")),
        color=get("Color"),
        alpha=float(get("Alpha")),
        shaft=(float(get("Shaft Length")), float(get("Shaft Radius"))),
        head=(float(get("Head Length")), float(get("Head Radius"))),
        axes=(float(get("Axes Length")), float(get("Axes Radius"))),
    )
