"""Polygon: an outline, such as the footprint of a robot."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from sambot_viz.displays.data.message_numbers import Floats, points_of
from sambot_viz.displays.data.newest_message import NewestMessageDisplay
from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import HERE, Placed
from sambot_viz.displays.scene.lines import LineNode, chain_segments
from sambot_viz.geometry import Vector3, Wxyz
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import ColorProperty, DisplayConfig


class PolygonDisplay(NewestMessageDisplay[Floats]):
    """The closed outline of geometry_msgs/PolygonStamped, one pixel wide."""

    kind = "rviz_default_plugins/Polygon"
    help = "The outline of a polygon, such as a footprint."
    meanings = frozenset({Meaning.POLYGON})
    properties = (
        topic_property(),
        ColorProperty("Color", default=(25, 255, 0), help="The colour of the outline."),
        alpha_property(),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._node = LineNode(context.scene, f"/{key}l")

    def read(self, message: Any) -> Floats:
        """Return the corners, (N, 3) [m]."""
        return points_of(message.polygon.points)

    def draw_read(self, read: Floats, wxyz: Wxyz, position: Vector3) -> None:
        """Draw the outline as it looks now."""
        self._node.draw(
            chain_segments(read, closed=True),
            self.config.get("Color"),
            alpha=float(self.config.get("Alpha")),
            wxyz=wxyz,
            position=position,
        )

    def placed(self) -> Iterator[Placed]:
        """Yield the outline, which cannot be selected, as in RViz."""
        yield from self._node.placed(HERE, None)

    def remove(self) -> None:
        """Take the outline out of the scene."""
        self._node.remove()
