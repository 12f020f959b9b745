"""MoveCamera: the mouse moves the camera (spec/rviz-views-tools.md §2.4)."""

from __future__ import annotations

from sambot_viz.tools.tool import Tool


class MoveCameraTool(Tool):
    """The camera, and nothing else."""

    kind = "rviz_default_plugins/MoveCamera"
    label = "Move Camera"
    key = "M"
    help = "Left: turn. Middle: move. Right or wheel: zoom. Shift: move."
