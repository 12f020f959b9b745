"""The properties that every view has."""

from __future__ import annotations

from sambot_viz.rviz import (
    BoolProperty,
    FloatProperty,
    KeptProperty,
    Property,
    TfFrameProperty,
)

COMMON_PROPERTIES: tuple[Property, ...] = (
    FloatProperty(
        "Near Clip Distance",
        default=0.01,
        minimum=0.001,
        maximum=10000.0,
        unit="m",
        help="What is nearer to the camera is not drawn.",
    ),
    BoolProperty("Invert Z Axis", default=False, help="Turn the picture upside down."),
    TfFrameProperty(
        "Target Frame",
        default="<Fixed Frame>",
        help="The frame that the view follows.",
    ),
    KeptProperty(
        "Enable Stereo Rendering",
        note="RViz for ROS 2 writes it, and has no stereo picture",
    ),
    KeptProperty(
        "Field of View",
        support="none",
        note="of ROS 1; the angle is 45 degrees, as in RViz for ROS 2",
    ),
)
