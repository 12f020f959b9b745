"""Path: the way that a robot is to go, or has gone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.data.kept_messages import KeptMessagesDisplay
from sambot_viz.displays.data.message_numbers import poses_of
from sambot_viz.displays.data.properties import metres
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import HERE, Placed
from sambot_viz.displays.scene.lines import LineNode, chain_segments
from sambot_viz.displays.scene.nodes import position_of, short_id
from sambot_viz.displays.scene.ribbons import RibbonNode
from sambot_viz.displays.scene.solid_nodes import ArrowsNode, AxesNode
from sambot_viz.frames import Transform
from sambot_viz.geometry import Matrix, Vector3, wxyz_from_matrix
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import (
    ColorProperty,
    DisplayConfig,
    EnumProperty,
    FloatProperty,
    IntProperty,
    VectorProperty,
)
from sambot_viz.sources.message import Recorded

LINES, RIBBONS = "Lines", "Billboards"
NONE, AXES, ARROWS = "None", "Axes", "Arrows"
MOST_PATHS = 100
"""So many paths are drawn at most, whatever the Buffer Length."""
_IF_AXES, _IF_ARROWS = ("Pose Style", AXES), ("Pose Style", ARROWS)
Floats = npt.NDArray[np.float64]


@dataclass(slots=True, eq=False)
class _Path:
    """A path and the nodes that draw it.

    Attributes:
        turns: (N, 4), w, x, y, z of its poses.
        points: (N, 3) [m].
        T_fixed_frame: (4, 4), of the frame they are given in.
        drawn: the settings that they were drawn with last.
    """

    turns: Floats
    points: Floats
    T_fixed_frame: Matrix
    lines: LineNode
    ribbon: RibbonNode
    axes: AxesNode
    arrows: ArrowsNode
    drawn: tuple[Any, ...] | None = None

    @property
    def nodes(self) -> tuple[LineNode, RibbonNode, AxesNode, ArrowsNode]:
        """What draws it."""
        return self.lines, self.ribbon, self.axes, self.arrows

    def remove(self) -> None:
        """Take it out of the scene."""
        for node in self.nodes:
            node.remove()


class PathDisplay(KeptMessagesDisplay):
    """The poses of nav_msgs/Path as a line, with axes or arrows."""

    kind = "rviz_default_plugins/Path"
    help = "The path that a robot is to follow."
    meanings = frozenset({Meaning.PATH})
    length = "Buffer Length"
    properties = (
        topic_property(),
        EnumProperty(
            "Line Style",
            default=LINES,
            options=(LINES, RIBBONS),
            help="Lines are one pixel wide, billboards have a width.",
        ),
        FloatProperty(
            "Line Width",
            default=0.03,
            minimum=0.001,
            unit="m",
            help="Width of billboards.",
            hidden_unless=("Line Style", RIBBONS),
        ),
        ColorProperty("Color", default=(25, 255, 0), help="The colour of the line."),
        FloatProperty("Alpha", default=1.0, help="How opaque the line is."),
        IntProperty(
            "Buffer Length",
            default=1,
            minimum=1,
            help=f"So many of the newest paths are shown, up to {MOST_PATHS}.",
            acts_up_to=MOST_PATHS,
        ),
        VectorProperty(
            "Offset",
            default=(0.0, 0.0, 0.0),
            unit="m",
            help="Moves what is drawn, along the axes of the fixed frame.",
        ),
        EnumProperty(
            "Pose Style",
            default=NONE,
            options=(NONE, AXES, ARROWS),
            help="What is drawn at each pose.",
        ),
        metres("Length", 0.3, "Length of each axis.", _IF_AXES),
        metres("Radius", 0.03, "Diameter of each axis, as RViz.", _IF_AXES),
        ColorProperty(
            "Pose Color",
            default=(255, 85, 255),
            help="The colour of the arrows.",
            hidden_unless=_IF_ARROWS,
        ),
        metres("Shaft Length", 0.1, "Length of the shafts.", _IF_ARROWS),
        metres("Head Length", 0.2, "Length of the heads.", _IF_ARROWS),
        metres("Shaft Diameter", 0.1, "Diameter of the shafts.", _IF_ARROWS),
        metres("Head Diameter", 0.3, "Diameter of the heads.", _IF_ARROWS),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._paths: list[_Path] = []
        self._made = 0

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Take a path; the oldest one that is too many goes."""
        turns, points = poses_of(message.poses, "pose.")
        T = T_fixed_frame.matrix
        # The nodes of a path that goes are used again.
        if len(self._paths) >= self.most:
            nodes = self._paths.pop(0).nodes
        else:
            self._made += 1
            name, scene = f"/{self.key}{short_id(self._made)}", self.context.scene
            nodes = (
                LineNode(scene, f"{name}l"),
                RibbonNode(scene, f"{name}r"),
                AxesNode(scene, f"{name}x"),
                ArrowsNode(scene, f"{name}a"),
            )
        self._paths.append(_Path(turns, points, T, *nodes))

    def placed(self) -> Iterator[Placed]:
        """Yield the paths, which cannot be selected, as in RViz."""
        for path in self._paths:
            for node in path.nodes:
                yield from node.placed(HERE, None)

    def drop(self) -> None:
        """Take all paths out of the scene."""
        for path in self._paths:
            path.remove()
        self._paths.clear()

    def show_taken(self) -> None:
        """Draw the paths as they look now."""
        while len(self._paths) > self.most:
            self._paths.pop(0).remove()
        names = (one.name for one in self.properties if one.name != self.length)
        look = tuple(self.config.get(name) for name in names)
        for path in self._paths:
            if path.drawn != look or any(node.is_gone for node in path.nodes):
                self._show(path)
                path.drawn = look

    def _show(self, path: _Path) -> None:
        get = self.config.get
        offset: Vector3 = get("Offset")
        T = np.array(path.T_fixed_frame)
        T[:3, 3] += offset
        place: dict[str, Any] = {
            "wxyz": wxyz_from_matrix(T),
            "position": position_of(T),
        }
        color, alpha = get("Color"), min(max(float(get("Alpha")), 0.0), 1.0)
        if get("Line Style") == RIBBONS:
            path.lines.remove()
            width = float(get("Line Width"))
            path.ribbon.draw(path.points, width, color, alpha=alpha, **place)
        else:
            path.ribbon.remove()
            path.lines.draw(chain_segments(path.points), color, alpha=alpha, **place)
        style, poses = str(get("Pose Style")), (path.turns, path.points)
        if style == AXES:
            sizes = float(get("Length")), float(get("Radius"))
            path.axes.draw(*poses, *sizes, **place)
        else:
            path.axes.remove()
        if style == ARROWS:
            shaft = float(get("Shaft Length")), float(get("Shaft Diameter"))
            head = float(get("Head Length")), float(get("Head Diameter"))
            path.arrows.draw(*poses, shaft, head, get("Pose Color"), **place)
        else:
            path.arrows.remove()
