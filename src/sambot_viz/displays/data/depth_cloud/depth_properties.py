"""The properties of DepthCloud, in RViz's order; those of all points follow."""

from __future__ import annotations

from sambot_viz.displays.data.image.transports import (
    COMPRESSED,
    COMPRESSED_DEPTH,
    RAW,
)
from sambot_viz.rviz import (
    BoolProperty,
    EditableEnumProperty,
    FloatProperty,
    IntProperty,
    Property,
    TopicProperty,
)

DEPTH_TOPIC, COLOR_TOPIC = "Depth Map Topic", "Color Image Topic"
DEPTH_HINT, COLOR_HINT = "Depth Map Transport Hint", "Color Transport Hint"
AUTO_SIZE, OCCLUSION = "Auto Size", "Occlusion Compensation"
TIME_OUT = f"{OCCLUSION}/Occlusion Time-Out"
FACTOR = f"{AUTO_SIZE}/Auto Size Factor"
QUEUE_SIZE = "Queue Size"

DEPTH_PROPERTIES: tuple[Property, ...] = (
    EditableEnumProperty(
        "Reliability Policy",
        default="Best effort",
        options=("System Default", "Reliable", "Best effort"),
        help="Whether lost messages are sent again; it is compared with the "
        "publishers.",
        support="approximate",
    ),
    BoolProperty(
        "Topic Filter",
        default=True,
        help="List only topics whose names speak of depths or colours.",
    ),
    TopicProperty(DEPTH_TOPIC, children=(), help="The topic of the depth images."),
    EditableEnumProperty(
        DEPTH_HINT,
        default=RAW,
        options=(RAW, COMPRESSED_DEPTH),
        help="How the depth images are sent.",
    ),
    TopicProperty(
        COLOR_TOPIC,
        children=(),
        help="The topic of the colour images; without one all points are white.",
    ),
    EditableEnumProperty(
        COLOR_HINT,
        default=RAW,
        options=(RAW, COMPRESSED),
        help="How the colour images are sent.",
    ),
    IntProperty(
        QUEUE_SIZE,
        default=5,
        minimum=1,
        acts_up_to=100,
        help="How many images wait for each other, and for their transform.",
    ),
    BoolProperty(
        AUTO_SIZE,
        default=True,
        help="Make each point as large as its pixel is at its depth.",
        children=(
            FloatProperty(
                "Auto Size Factor",
                default=1.0,
                minimum=0.0001,
                help="How many times as large.",
                hidden_unless=(AUTO_SIZE, True),
            ),
        ),
    ),
    BoolProperty(
        OCCLUSION,
        default=False,
        help="Keep showing the points that something nearer covers; the camera has to "
        "stand still.",
        support="approximate",
        children=(
            FloatProperty(
                "Occlusion Time-Out",
                default=30.0,
                minimum=0.0,
                unit="s",
                help="How long covered points stay.",
                hidden_unless=(OCCLUSION, True),
            ),
        ),
    ),
)
