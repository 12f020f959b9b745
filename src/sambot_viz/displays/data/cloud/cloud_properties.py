"""The properties that all displays of points have, in RViz's order."""

from __future__ import annotations

from typing import get_args

from sambot_viz.displays.data.cloud.colors import ColorOptions
from sambot_viz.displays.scene.points import PointShape
from sambot_viz.rviz import (
    BoolProperty,
    ColorProperty,
    ConfigItem,
    EditableEnumProperty,
    EnumProperty,
    FloatProperty,
    Property,
)

STYLES: tuple[PointShape, ...] = get_args(PointShape)
PLACING, TRANSFORMER = "Position Transformer", "Color Transformer"
CHANNEL = "Channel Name"
_OF_INTENSITY = (TRANSFORMER, ("Intensity", ""))
_OF_AXIS = (TRANSFORMER, "AxisColor")
_METRES = tuple(style for style in STYLES if style != "Points")
INTENSITIES = "Autocompute Intensity Bounds"
COORDINATES = "Autocompute Value Bounds"

CLOUD_PROPERTIES: tuple[Property, ...] = (
    BoolProperty(
        "Selectable",
        default=True,
        help="Whether the points can be selected.",
    ),
    EnumProperty(
        "Style",
        default="Flat Squares",
        options=STYLES,
        help="The shape of each point; Points are the fastest.",
    ),
    FloatProperty(
        "Size (m)",
        default=0.01,
        minimum=0.0001,
        unit="m",
        help="The edge, or the diameter, of each point.",
        hidden_unless=("Style", _METRES),
    ),
    FloatProperty(
        "Size (Pixels)",
        default=3.0,
        minimum=1.0,
        help="The diameter of each point on the screen.",
        hidden_unless=("Style", "Points"),
    ),
    FloatProperty(
        "Alpha",
        default=1.0,
        minimum=0.0,
        maximum=1.0,
        help="How opaque the points are, on top of their own alpha.",
    ),
    FloatProperty(
        "Decay Time",
        default=0.0,
        minimum=0.0,
        unit="s",
        help="How long points stay; 0 = only the newest message.",
    ),
    EditableEnumProperty(
        PLACING,
        default="",
        options=("XYZ",),
        help="How points get their places: from their fields x, y and z.",
    ),
    EditableEnumProperty(
        TRANSFORMER,
        default="",
        options=("AxisColor", "FlatColor", "Intensity", "RGB8", "RGBF32"),
        help="How points get their colours; empty chooses by their fields.",
    ),
    ColorProperty(
        "Color",
        default=(255, 255, 255),
        help="The colour of all points.",
        hidden_unless=(TRANSFORMER, "FlatColor"),
    ),
    EditableEnumProperty(
        CHANNEL,
        default="intensity",
        help="The field that gives the colour.",
        hidden_unless=_OF_INTENSITY,
    ),
    BoolProperty(
        "Use rainbow",
        default=True,
        help="A rainbow from red, the least, to magenta; else between two colours.",
        hidden_unless=_OF_INTENSITY,
    ),
    BoolProperty(
        "Invert Rainbow",
        default=False,
        help="The rainbow runs from magenta, the least, to red.",
        hidden_unless=("Use rainbow", True),
    ),
    ColorProperty(
        "Min Color",
        default=(0, 0, 0),
        help="The colour of the least value.",
        hidden_unless=("Use rainbow", False),
    ),
    ColorProperty(
        "Max Color",
        default=(255, 255, 255),
        help="The colour of the greatest value.",
        hidden_unless=("Use rainbow", False),
    ),
    BoolProperty(
        INTENSITIES,
        default=True,
        help="The bounds are the least and the greatest value of each message.",
        hidden_unless=_OF_INTENSITY,
    ),
    FloatProperty(
        "Min Intensity",
        default=0.0,
        help="The value with the first colour.",
        hidden_unless=(INTENSITIES, False),
    ),
    FloatProperty(
        "Max Intensity",
        default=4096.0,
        help="The value with the last colour.",
        hidden_unless=(INTENSITIES, False),
    ),
    EnumProperty(
        "Axis",
        default="Z",
        options=("X", "Y", "Z"),
        help="The coordinate that gives the colour.",
        hidden_unless=_OF_AXIS,
    ),
    BoolProperty(
        COORDINATES,
        default=True,
        help="The bounds are the least and the greatest coordinate of each message.",
        hidden_unless=_OF_AXIS,
        children=(
            FloatProperty(
                "Min Value",
                default=-10.0,
                unit="m",
                help="The coordinate with the first colour.",
                hidden_unless=(COORDINATES, False),
            ),
            FloatProperty(
                "Max Value",
                default=10.0,
                unit="m",
                help="The coordinate with the last colour.",
                hidden_unless=(COORDINATES, False),
            ),
        ),
    ),
    BoolProperty(
        "Use Fixed Frame",
        default=True,
        help="Coordinates are those in the fixed frame, not in that of the message.",
        hidden_unless=_OF_AXIS,
    ),
)


def color_options(config: ConfigItem) -> ColorOptions:
    """Return the colour settings of a display of points."""
    get = config.get
    bounds = (float(get("Min Intensity")), float(get("Max Intensity")))
    values = (
        float(get(f"{COORDINATES}/Min Value")),
        float(get(f"{COORDINATES}/Max Value")),
    )
    return ColorOptions(
        transformer=str(get(TRANSFORMER)),
        color=get("Color"),
        channel=str(get(CHANNEL)),
        is_rainbow=bool(get("Use rainbow")),
        is_inverted=bool(get("Invert Rainbow")),
        least_color=get("Min Color"),
        most_color=get("Max Color"),
        intensities=None if get(INTENSITIES) else bounds,
        axis=str(get("Axis")),
        coordinates=None if get(COORDINATES) else values,
        in_fixed_frame=bool(get("Use Fixed Frame")),
    )
