"""PointStamped: single points, such as clicked ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import point_of
from sambot_viz.displays.data.properties import alpha_property, metres
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.displays.scene.solid_nodes import Solid, SolidsNode
from sambot_viz.geometry import IDENTITY, Matrix, Vector3
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import ColorProperty, IntProperty


class PointStampedDisplay(MessageFilterDisplay[Vector3]):
    """The points of geometry_msgs/PointStamped as balls."""

    kind = "rviz_default_plugins/PointStamped"
    differs = "RViz for ROS 1 draws the ball twice as large."
    meanings = frozenset({Meaning.POINT})
    length = "History Length"
    properties = (
        topic_property(),
        ColorProperty("Color", default=(204, 41, 204), help="The colour of the ball."),
        alpha_property(),
        metres("Radius", 0.2, "The diameter of the ball, as RViz."),
        IntProperty(
            "History Length",
            default=1,
            minimum=1,
            maximum=100_000,
            acts_up_to=limits.STAMPED_POINTS.value,
            help=f"Number of points to show, up to {limits.STAMPED_POINTS.value:,}.",
        ),
    )
    _node = DisplayNode(SolidsNode, "")

    def read(self, message: Any) -> Vector3:
        """Return the point [m]."""
        return point_of(message.point)

    def draw_kept(self, kept: Sequence[Taken[Vector3]]) -> None:
        """Draw the balls."""
        self._node.draw([self._ball(one.read, one.T_fixed_frame) for one in kept])

    def _ball(self, point: Vector3, T_fixed_frame: Matrix) -> Solid:
        T = np.array(T_fixed_frame)
        T[:3, 3] += T[:3, :3] @ np.array(point)
        size = float(self.config.get("Radius"))
        color, alpha = self.config.get("Color"), float(self.config.get("Alpha"))
        sizes = (size, size, size)
        return Solid("sphere", IDENTITY, position_of(T), sizes, color, alpha)
