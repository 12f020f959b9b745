"""AccelStamped: an acceleration, along and about axes."""

from __future__ import annotations

from typing import Any

from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.data.vectors.vectors import (
    HIDES,
    VectorsDisplay,
    vector_properties,
)
from sambot_viz.meanings import Meaning


class AccelStampedDisplay(VectorsDisplay):
    """The linear and the angular part of geometry_msgs/AccelStamped."""

    kind = "rviz_default_plugins/AccelStamped"
    help = "An acceleration as arrows."
    meanings = frozenset({Meaning.ACCELERATION})
    words = ("Linear", "Angular")
    properties = (topic_property(), *vector_properties(*words), HIDES)

    def vectors(self, message: Any) -> tuple[Any, Any]:
        """Return the linear and the angular part."""
        return message.accel.linear, message.accel.angular

    @property
    def hides_small(self) -> bool:
        """Whether an arrow that is not longer than its width is left out."""
        return bool(self.config.get(HIDES.name))
