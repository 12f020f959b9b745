"""Polygon: an outline, such as the footprint of a robot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import Floats, points_of
from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.scene.lines import LineNode, chain_segments
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import ColorProperty


class PolygonDisplay(MessageFilterDisplay[Floats]):
    """The closed outline of geometry_msgs/PolygonStamped, one pixel wide."""

    kind = "rviz_default_plugins/Polygon"
    meanings = frozenset({Meaning.POLYGON})
    properties = (
        topic_property(),
        ColorProperty("Color", default=(25, 255, 0), help="The colour of the outline."),
        alpha_property(),
    )
    _node = DisplayNode(LineNode, "l")

    def read(self, message: Any) -> Floats:
        """Return the corners, (N, 3) [m]."""
        return points_of(message.polygon.points)

    def draw_kept(self, kept: Sequence[Taken[Floats]]) -> None:
        """Draw the outline as it looks now."""
        wxyz, position = kept[-1].pose
        self._node.draw(
            chain_segments(kept[-1].read, closed=True),
            self.config.get("Color"),
            alpha=float(self.config.get("Alpha")),
            wxyz=wxyz,
            position=position,
        )
