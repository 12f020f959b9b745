"""MoveCamera and Interact: the mouse moves the camera."""

from __future__ import annotations

from sambot_viz.rviz import BoolProperty
from sambot_viz.tools.tool import Tool


class MoveCameraTool(Tool):
    """Moves the camera and does nothing else."""

    kind = "rviz_default_plugins/MoveCamera"
    label = "Move Camera"
    key = "M"
    help = "Left: turn. Middle: move. Right or wheel: zoom. Shift: move."
    touch = "One finger: turn. Two: move and zoom."


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
            help="For interactive markers, which are not drawn yet.",
            support="none",
        ),
    )
