"""Path: the way that a robot is to go, or has gone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import viser

from sambot_viz import limits
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import Floats, given_poses
from sambot_viz.displays.data.properties import metres
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import HERE, Placed
from sambot_viz.displays.scene.frame_nodes import position_of, short_id
from sambot_viz.displays.scene.lines import LineNode
from sambot_viz.displays.scene.ribbons import RibbonNode
from sambot_viz.displays.scene.solid_nodes import ArrowsNode, AxesNode
from sambot_viz.geometry import Vector3, wxyz_from_matrix
from sambot_viz.matrices import unit_wxyzs
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import (
    ColorProperty,
    DisplayConfig,
    EnumProperty,
    FloatProperty,
    IntProperty,
    VectorProperty,
)

LINES, RIBBONS = "Lines", "Billboards"
NONE, AXES, ARROWS = "None", "Axes", "Arrows"
_IF_AXES, _IF_ARROWS = ("Pose Style", AXES), ("Pose Style", ARROWS)
Poses = tuple[Floats, Floats]
"""Rotations of any length, (N, 4), and positions, (N, 3) [m]."""


class _PathNodes:
    """The nodes that draw one path.

    Args:
        scene: where to draw.
        name: what the names of the nodes begin with.

    Attributes:
        drawn: the path and the settings that they were drawn with last.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self.lines = LineNode(scene, f"{name}l")
        self.ribbon = RibbonNode(scene, f"{name}r")
        self.axes = AxesNode(scene, f"{name}x")
        self.arrows = ArrowsNode(scene, f"{name}a")
        self.all = self.lines, self.ribbon, self.axes, self.arrows
        self.drawn: tuple[Any, ...] | None = None

    def remove(self) -> None:
        """Take them out of the scene."""
        for node in self.all:
            node.remove()


class PathDisplay(MessageFilterDisplay[Poses]):
    """The poses of nav_msgs/Path as a line, with axes or arrows."""

    kind = "rviz_default_plugins/Path"
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
            help=f"Number of newest paths to show, up to {limits.PATHS.value:,}.",
            acts_up_to=limits.PATHS.value,
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
        self._nodes: dict[Taken[Poses], _PathNodes] = {}
        self._made = 0

    def read(self, message: Any) -> Poses:
        """Return the rotations and the positions of the poses of a path."""
        return given_poses(message.poses, "pose.")

    def placed(self) -> Iterator[Placed]:
        """Yield the paths, which cannot be selected, as in RViz."""
        for nodes in self._nodes.values():
            for node in nodes.all:
                yield from node.placed(HERE, None)

    def remove(self) -> None:
        """Take all paths out of the scene."""
        for nodes in self._nodes.values():
            nodes.remove()
        self._nodes.clear()

    def draw_kept(self, kept: Sequence[Taken[Poses]]) -> None:
        """Draw the paths as they look now."""
        names = (one.name for one in self.properties if one.name != self.length)
        look = tuple(self.config.get(name) for name in names)
        # The nodes of a path that goes are used again.
        gone = [one for one in self._nodes if one not in kept]
        free = [self._nodes.pop(one) for one in gone]
        for path in kept:
            if path not in self._nodes:
                self._nodes[path] = free.pop(0) if free else self._new_nodes()
            nodes = self._nodes[path]
            if nodes.drawn != (path, look) or any(node.is_gone for node in nodes.all):
                self._show(path, nodes)
                nodes.drawn = path, look
        for nodes in free:
            nodes.remove()

    def _new_nodes(self) -> _PathNodes:
        self._made += 1
        return _PathNodes(self.context.scene, f"/{self.key}{short_id(self._made)}")

    def _show(self, path: Taken[Poses], nodes: _PathNodes) -> None:
        get, points = self.config.get, path.read[1]
        offset: Vector3 = get("Offset")
        T = np.array(path.T_fixed_frame)
        T[:3, 3] += offset
        place: dict[str, Any] = {
            "wxyz": wxyz_from_matrix(T),
            "position": position_of(T),
        }
        color, alpha = get("Color"), min(max(float(get("Alpha")), 0.0), 1.0)
        if get("Line Style") == RIBBONS:
            nodes.lines.remove()
            width = float(get("Line Width"))
            nodes.ribbon.draw(points, width, color, alpha=alpha, **place)
        else:
            nodes.ribbon.remove()
            nodes.lines.draw_chain(points, color, alpha=alpha, **place)
        style, turns = str(get("Pose Style")), path.read[0]
        if style == AXES:
            sizes = float(get("Length")), float(get("Radius"))
            nodes.axes.draw(unit_wxyzs(turns), points, *sizes, **place)
        else:
            nodes.axes.remove()
        if style == ARROWS:
            shaft = float(get("Shaft Length")), float(get("Shaft Diameter"))
            head = float(get("Head Length")), float(get("Head Diameter"))
            look = shaft, head, get("Pose Color")
            nodes.arrows.draw(unit_wxyzs(turns), points, *look, **place)
        else:
            nodes.arrows.remove()
