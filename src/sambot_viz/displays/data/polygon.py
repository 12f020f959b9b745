"""Polygon: an outline, such as the footprint of a robot."""

from __future__ import annotations

from typing import Any

import numpy as np

from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import points_of
from sambot_viz.displays.data.poses.pose_shapes import alpha_property
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.lines import LineNode, chain_segments
from sambot_viz.displays.scene.nodes import position_of
from sambot_viz.frames import Transform
from sambot_viz.geometry import wxyz_from_matrix
from sambot_viz.rviz import ColorProperty, DisplayConfig
from sambot_viz.sources.message import Recorded


class PolygonDisplay(MessageFilterDisplay):
    """The closed outline of geometry_msgs/PolygonStamped, one pixel wide."""

    kind = "rviz_default_plugins/Polygon"
    help = "The outline of a polygon, such as a footprint."
    types = frozenset({"geometry_msgs/msg/PolygonStamped"})
    properties = (
        topic_property(),
        ColorProperty("Color", default=(25, 255, 0), help="The colour of the outline."),
        alpha_property(),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._node = LineNode(context.scene, f"/{key}l")
        self._points = np.zeros((0, 3))
        self._frame = Transform.identity()

    def process(self, message: Any, T_fixed_frame: Transform, came: Recorded) -> None:
        """Draw an outline in the place of the one before."""
        self._points = points_of(message.polygon.points)
        self._frame = T_fixed_frame
        self._show()

    def drop(self) -> None:
        """Take the outline out of the scene."""
        self._points = np.zeros((0, 3))
        self._node.remove()

    def redraw(self) -> None:
        """Draw the outline as it looks now."""
        super().redraw()
        self._show()

    def _show(self) -> None:
        T = self._frame.matrix
        self._node.draw(
            chain_segments(self._points, closed=True),
            self.config.get("Color"),
            alpha=float(self.config.get("Alpha")),
            wxyz=wxyz_from_matrix(T),
            position=position_of(T),
        )
