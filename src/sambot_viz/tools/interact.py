"""Interact: the mouse moves the camera, as long as there are no interactive markers."""

from __future__ import annotations

from sambot_viz.rviz import BoolProperty
from sambot_viz.tools.move_camera import MoveCameraTool
from sambot_viz.tools.tool import Tool


class InteractTool(Tool):
    """Interactive markers come from ROS programs; without them it moves the camera."""

    kind = "rviz_default_plugins/Interact"
    label = "Interact"
    key = "I"
    help = MoveCameraTool.help
    touch = MoveCameraTool.touch
    properties = (
        BoolProperty(
            "Hide Inactive Objects",
            default=True,
            help="Concerns interactive markers, which need a ROS program.",
            support="none",
        ),
    )
