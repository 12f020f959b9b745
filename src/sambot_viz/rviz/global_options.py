"""Global Options: the first row of the displays."""

from __future__ import annotations

from sambot_viz.rviz.properties.kinds import (
    BoolProperty,
    ColorProperty,
    IntProperty,
    TfFrameProperty,
)
from sambot_viz.rviz.properties.property import Property

GLOBAL_OPTIONS: tuple[Property, ...] = (
    TfFrameProperty(
        "Fixed Frame",
        default="base_link",
        ros1_default="map",
        help="The frame everything is drawn in; its origin is the origin of the scene.",
    ),
    ColorProperty(
        "Background Color",
        default=(48, 48, 48),
        help="The colour behind the scene.",
    ),
    IntProperty(
        "Frame Rate",
        default=30,
        minimum=1,
        unit="Hz",
        help="How often what moves by itself is drawn, at most 60 times a second.",
        acts_up_to=60,
    ),
    BoolProperty(
        "Default Light",
        default=True,
        ros1_only=True,
        help="The light at the camera; RViz for ROS 2 always has it.",
    ),
)
