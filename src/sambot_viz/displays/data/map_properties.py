"""The properties of Map; five of them only show what the message says."""

from __future__ import annotations

from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.scene.maps import SCHEMES
from sambot_viz.rviz import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    Property,
    VectorProperty,
)

UPDATE_TOPIC = "Update Topic"
RESOLUTION, WIDTH, HEIGHT = "Resolution", "Width", "Height"
POSITION, ORIENTATION = "Position", "Orientation"
MAP_PROPERTIES: tuple[Property, ...] = (
    topic_property(),
    topic_property(UPDATE_TOPIC, is_filtered=False),
    FloatProperty(
        "Alpha",
        default=0.7,
        minimum=0.0,
        maximum=1.0,
        help="How opaque the map is.",
    ),
    EnumProperty(
        "Color Scheme",
        default="map",
        options=SCHEMES,
        help="The colours of the values.",
    ),
    BoolProperty(
        "Draw Behind",
        default=False,
        help="Draw everything else over the map, as if it were far below.",
    ),
    FloatProperty(
        RESOLUTION,
        default=0.0,
        unit="m",
        help="How wide a cell of the map is.",
        read_only=True,
    ),
    IntProperty(
        WIDTH, default=0, help="How many cells it has along x.", read_only=True
    ),
    IntProperty(
        HEIGHT, default=0, help="How many cells it has along y.", read_only=True
    ),
    VectorProperty(
        POSITION,
        unit="m",
        help="Where its first cell begins, in the frame of the map.",
        read_only=True,
    ),
    VectorProperty(
        ORIENTATION,
        default=(0.0, 0.0, 0.0, 1.0),
        keys=("X", "Y", "Z", "W"),
        help="How it is turned there.",
        read_only=True,
    ),
    BoolProperty(
        "Use Timestamp",
        default=False,
        help="Place the map where its frame was at its stamp, not where it is now.",
    ),
    BoolProperty(
        "Binary representation",
        default=False,
        help="Tell apart only what is less than the threshold, and what is not.",
    ),
    IntProperty(
        "Binary threshold",
        default=100,
        minimum=0,
        maximum=100,
        help="The least value that is occupied.",
        hidden_unless=("Binary representation", True),
    ),
)
