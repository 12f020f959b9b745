"""Wrench: a force and a torque, such as those at a wrist."""

from __future__ import annotations

from typing import Any

from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.data.vectors.vectors import VectorsDisplay, vector_properties
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import BoolProperty

ACCEPTS = "Accept NaN Values"


class WrenchDisplay(VectorsDisplay):
    """The force and the torque of geometry_msgs/WrenchStamped."""

    kind = "rviz_default_plugins/Wrench"
    help = "A force and a torque as arrows."
    meanings = frozenset({Meaning.FORCE})
    words = ("Force", "Torque")
    properties = (
        topic_property(),
        BoolProperty(
            ACCEPTS, default=False, help="Numbers that are NaN are drawn as 0."
        ),
        *vector_properties(*words),
    )

    def vectors(self, message: Any) -> tuple[Any, Any]:
        """Return the force and the torque."""
        return message.wrench.force, message.wrench.torque

    @property
    def nan_is_zero(self) -> bool:
        """Whether a number that is NaN is drawn as 0."""
        return bool(self.config.get(ACCEPTS))

    def property_changed(self, path: str) -> None:
        """A property has a new value; what NaN means is decided once a message."""
        if self.shown and path == ACCEPTS:
            self.clear()
        super().property_changed(path)
