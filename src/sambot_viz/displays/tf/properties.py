"""The properties of a TF display and of its frames."""

from __future__ import annotations

from sambot_viz.rviz import (
    BoolProperty,
    FloatProperty,
    GroupProperty,
    KeptProperty,
    Property,
    RegexProperty,
)

ALL_ENABLED = "Frames/All Enabled"
BOX = "Value"
"""The property that shows or hides a frame."""

FRAME_PROPERTIES: tuple[Property, ...] = (
    BoolProperty(BOX, default=False, help="Show the frame and its arrow."),
)

TF_PROPERTIES: tuple[Property, ...] = (
    BoolProperty("Show Names", default=False, help="Write each frame's name below it."),
    BoolProperty("Show Axes", default=True, help="Draw the axes of each frame."),
    BoolProperty(
        "Show Arrows",
        default=True,
        help="Draw an arrow from each frame to its parent.",
    ),
    FloatProperty(
        "Marker Scale",
        default=1.0,
        help="Size of names, axes and arrows.",
    ),
    FloatProperty(
        "Update Interval",
        default=0.0,
        minimum=0.0,
        unit="s",
        help="Seconds between updates; frames move at once here.",
        support="approximate",
    ),
    FloatProperty(
        "Frame Timeout",
        default=15.0,
        minimum=1.0,
        unit="s",
        help="Seconds after which RViz takes a silent frame out; frames here "
        "never grow old.",
        support="approximate",
    ),
    RegexProperty(
        "Filter (whitelist)",
        default="",
        help="Show only frames whose name matches; empty shows all.",
    ),
    RegexProperty(
        "Filter (blacklist)",
        default="",
        help="Hide frames whose name matches; empty hides none.",
    ),
    GroupProperty(
        "Frames",
        help="The frames, each with a box to show or hide it.",
        children=(
            BoolProperty("All Enabled", default=True, help="Show or hide all frames."),
        ),
        open_keys=True,
    ),
    KeptProperty("Tree", note="RViz writes the tree of frames, and never reads it"),
    KeptProperty(
        "Marker Alpha", support="none", note="of ROS 1; RViz for ROS 2 ignores it"
    ),
)
