"""Maps and cells that cannot be drawn, and the way out."""

from __future__ import annotations

import math
from typing import Any

from sambot_viz import limits


def map_fault(message: Any) -> str:
    """Return why a nav_msgs/OccupancyGrid cannot be drawn; empty when it can.

    Of one without data RViz takes no notice (`has_no_map`).
    """
    width, height = int(message.info.width), int(message.info.height)
    cells = len(message.data)
    if not cells:
        return (
            f"What came has {width} × {height} cells and no data: what publishes it "
            "has no map yet, or could not read its file"
        )
    if width * height == 0:
        return (
            f"Map is zero-sized ({width}x{height}). It has {cells} values: publish "
            "the width and the height of the map"
        )
    if width * height != cells:
        return (
            f"Data size doesn't match width*height: width = {width}, "
            f"height = {height}, data size = {cells}"
        )
    if cells > limits.MAP_CELLS.value:
        return f"It has {cells:,} cells: at most {limits.MAP_CELLS.value:,} are drawn"
    resolution = float(message.info.resolution)
    # Numbers that are not finite have another sentence.
    if math.isfinite(resolution) and resolution <= 0.0:
        return f"Its cells are {resolution:g} m wide: set info.resolution"
    return ""


def cells_fault(message: Any) -> str:
    """Return why a nav_msgs/GridCells cannot be drawn; empty when it can."""
    for name in ("width", "height"):
        if float(getattr(message, f"cell_{name}")) <= 0.0:
            return (
                f"Cell {name} is zero, cells will be invisible. Publish cell_{name} "
                "in metres"
            )
    return ""
