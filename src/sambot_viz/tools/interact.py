"""Interact: the mouse moves the camera (spec/rviz-views-tools.md §2.5)."""

from __future__ import annotations

from sambot_viz.rviz import BoolProperty
from sambot_viz.tools.tool import Tool


class InteractTool(Tool):
    """RViz's interactive markers come from ROS programs; without them it is a hand."""

    kind = "rviz_default_plugins/Interact"
    label = "Interact"
    key = "I"
    help = "Left: turn. Middle: move. Right or wheel: zoom. Shift: move."
    properties = (
        BoolProperty(
            "Hide Inactive Objects",
            default=True,
            help="Concerns interactive markers, which need a ROS program.",
            support="none",
        ),
    )
