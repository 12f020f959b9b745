"""Messages that are well-formed and have nothing in them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

WITH_POINTS = (4, 5, 6, 7, 8, 11)
"""Types of visualization_msgs/Marker that are drawn from points."""


def none_of(field: str) -> Callable[[Any], str]:
    """Return what says that a list of a message is empty."""

    def look(message: Any) -> str:
        return "" if len(getattr(message, field)) else f"0 {field}"

    return look


def corners(message: Any) -> str:
    """Say that a geometry_msgs/PolygonStamped has no points."""
    return none_of("points")(message.polygon)


def points(message: Any) -> str:
    """Say that a sensor_msgs/PointCloud2 has no points."""
    return "" if message.width * message.height else "0 points"


def pixels(message: Any) -> str:
    """Say that a sensor_msgs/CameraInfo is of images without pixels."""
    return "" if message.width * message.height else "0 × 0 pixels"


def ranges(message: Any) -> str:
    """Say that a sensor_msgs/LaserScan has no range that is drawn."""
    found = message.ranges
    if not len(found):
        return "0 ranges"
    # A comparison with nan is false.
    good = (found >= message.range_min) & (found <= message.range_max)
    return "" if good.any() else f"all {len(found)} ranges are out of range"


def marker_points(message: Any) -> str:
    """Say that a visualization_msgs/Marker made of points has none."""
    is_added = message.action == 0 and message.type in WITH_POINTS
    return "0 points" if is_added and not len(message.points) else ""
