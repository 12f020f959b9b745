"""GridCells: cells of a grid, such as obstacles."""

from __future__ import annotations

from typing import Any

import numpy as np

from sambot_viz.displays.data.message_filter import (
    MessageFilterDisplay,
    MessageRefused,
)
from sambot_viz.displays.data.message_numbers import points_of, require_finite
from sambot_viz.displays.data.poses.pose_shapes import alpha_property
from sambot_viz.displays.data.topic_display import TOPIC, topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.nodes import position_of
from sambot_viz.displays.scene.points import PointNode, PointStyle
from sambot_viz.frames import Transform
from sambot_viz.geometry import wxyz_from_matrix
from sambot_viz.rviz import ColorProperty, DisplayConfig
from sambot_viz.sources.message import Recorded


class GridCellsDisplay(MessageFilterDisplay):
    """The cells of nav_msgs/GridCells, as tiles in the plane of their frame."""

    kind = "rviz_default_plugins/GridCells"
    help = "Cells of a grid, such as obstacles."
    types = frozenset({"nav_msgs/msg/GridCells"})
    properties = (
        topic_property(),
        ColorProperty("Color", default=(25, 255, 0), help="The colour of the cells."),
        alpha_property(),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._node = PointNode(context.scene, f"/{key}p")
        self._cells = np.zeros((0, 3))
        self._size = (0.0, 0.0)
        self._frame = Transform.identity()

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Draw cells in the place of those before."""
        width, height = float(message.cell_width), float(message.cell_height)
        require_finite([width, height])
        for name, edge in (("width", width), ("height", height)):
            if edge <= 0.0:
                text = f"Cell {name} is zero, cells will be invisible."
                raise MessageRefused(text, TOPIC)
        self._cells, self._size = points_of(message.cells), (width, height)
        self._frame = T_fixed_frame
        self._show()

    def drop(self) -> None:
        """Take the cells out of the scene."""
        self._cells = np.zeros((0, 3))
        self._node.remove()

    def redraw(self) -> None:
        """Draw the cells as they look now."""
        super().redraw()
        self._show()

    def _show(self) -> None:
        T = self._frame.matrix
        style = PointStyle(
            "Tiles",
            (*self._size, 0.0),
            alpha=float(self.config.get("Alpha")),
            normal=(0.0, 0.0, 1.0),
            is_twice=True,
        )
        color = np.array([self.config.get("Color")], np.uint8)
        place = wxyz_from_matrix(T), position_of(T)
        self._node.draw(self._cells, color, style, *place)
