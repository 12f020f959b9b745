"""MoveCamera: the mouse moves the camera."""

from __future__ import annotations

from sambot_viz.tools.tool import Tool


class MoveCameraTool(Tool):
    """Moves the camera and does nothing else."""

    kind = "rviz_default_plugins/MoveCamera"
    label = "Move Camera"
    key = "M"
    help = "Left: turn. Middle: move. Right or wheel: zoom. Shift: move."
    touch = "One finger: turn. Two: move and zoom."
