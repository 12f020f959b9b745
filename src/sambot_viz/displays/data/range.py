"""Range: what an ultrasonic or infrared sensor measures, as a cone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import require_finite
from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.displays.scene.solid_nodes import Solid, SolidsNode
from sambot_viz.geometry import Matrix, wxyz_from_matrix
from sambot_viz.meanings import Meaning
from sambot_viz.meshes.primitives import CONE_TIP
from sambot_viz.rviz import ColorProperty, IntProperty

_WIDEST = math.radians(179)
_TO_SENSOR = np.array([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""A cone with its tip along z, turned so that the tip points along −x."""

Reading = tuple[float, float]
"""A distance [m], 0 without one, and a field of view [rad]."""


class RangeDisplay(MessageFilterDisplay[Reading]):
    """The readings of sensor_msgs/Range: the tip of a cone is at the sensor."""

    kind = "rviz_default_plugins/Range"
    meanings = frozenset({Meaning.CONE})
    length = "Buffer Length"
    properties = (
        topic_property(),
        ColorProperty(
            "Color", default=(255, 255, 255), help="The colour of the cones."
        ),
        alpha_property(0.5),
        IntProperty(
            "Buffer Length",
            default=1,
            minimum=1,
            acts_up_to=limits.RANGE_CONES.value,
            help="Number of newest readings to show, up to "
            f"{limits.RANGE_CONES.value:,}.",
        ),
    )
    _node = DisplayNode(SolidsNode, "")

    def read(self, message: Any) -> Reading:
        """Return the distance [m], 0 without one, and the field of view [rad]."""
        least, most = float(message.min_range), float(message.max_range)
        require_finite((least, most, float(message.field_of_view)))
        distance = float(message.range)
        if least == most:
            # A sensor that only says whether something is there.
            distance = least if distance == -math.inf else 0.0
        elif not least <= distance <= most:
            distance = 0.0
        return distance, float(message.field_of_view)

    def draw_kept(self, kept: Sequence[Taken[Reading]]) -> None:
        """Draw the cones."""
        cones = (self._cone(one.read, one.T_fixed_frame) for one in kept)
        self._node.draw([cone for cone in cones if cone is not None])

    def _cone(self, reading: Reading, T_fixed_frame: Matrix) -> Solid | None:
        """Return the cone of a reading; None for nothing in its range."""
        distance, angle = reading
        angle = min(max(angle, 0.0), _WIDEST)
        if distance <= 0.0 or angle == 0.0:
            return None
        T = np.array(T_fixed_frame)
        T[:3, 3] += T[:3, :3] @ np.array([CONE_TIP * distance, 0.0, 0.0])
        T[:3, :3] = T[:3, :3] @ _TO_SENSOR
        wide = 2 * distance * math.tan(angle / 2)
        color, alpha = self.config.get("Color"), float(self.config.get("Alpha"))
        sizes = (wide, wide, distance)
        return Solid("cone", wxyz_from_matrix(T), position_of(T), sizes, color, alpha)
