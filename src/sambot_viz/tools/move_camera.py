"""MoveCamera and Interact: the mouse moves the camera."""

from __future__ import annotations

from sambot_viz.rviz import BoolProperty
from sambot_viz.tools.tool import Tool

HIDE = "Hide Inactive Objects"


class MoveCameraTool(Tool):
    """Moves the camera and does nothing else."""

    kind = "rviz_default_plugins/MoveCamera"
    label = "Move Camera"
    key = "M"
    help = "Left: turn. Middle: move. Right or wheel: zoom. Shift: move."
    touch = "One finger: turn. Two: move and zoom."


class InteractTool(Tool):
    """Moves the camera, and shows the controls of interactive markers."""

    kind = "rviz_default_plugins/Interact"
    label = "Interact"
    key = "I"
    help = MoveCameraTool.help
    touch = MoveCameraTool.touch
    properties = (
        BoolProperty(
            HIDE,
            default=True,
            help="Hide the controls of interactive markers while another tool is "
            "chosen.",
        ),
    )

    @property
    def hides_controls(self) -> bool:
        """Whether the controls are hidden while another tool is chosen."""
        return self.config is None or bool(self.config.get(HIDE))
