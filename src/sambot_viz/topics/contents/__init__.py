"""Why nothing of a message can be drawn, as its display and the list of topics say it.

The functions of this package are the one account of it: a display refuses a message
with the sentence of one of them, and topics say the same without a display.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from sambot_viz.topics.contents import amounts
from sambot_viz.topics.contents.clouds import channels_fault, cloud_fault
from sambot_viz.topics.contents.grids import cells_fault, map_fault
from sambot_viz.topics.contents.pictures import picture_fault
from sambot_viz.topics.reasons import TopicReason, empty, not_drawn

_Look = Callable[[Any], str]

_FAULTS: Mapping[str, _Look] = {
    "nav_msgs/msg/GridCells": cells_fault,
    "nav_msgs/msg/OccupancyGrid": map_fault,
    "sensor_msgs/msg/CompressedImage": picture_fault,
    "sensor_msgs/msg/Image": picture_fault,
    "sensor_msgs/msg/PointCloud": channels_fault,
    "sensor_msgs/msg/PointCloud2": cloud_fault,
}
"""Type → the reason for which its display draws no such message; empty for none."""
_AMOUNTS: Mapping[str, _Look] = {
    "geometry_msgs/msg/PolygonStamped": amounts.corners,
    "geometry_msgs/msg/PoseArray": amounts.none_of("poses"),
    "nav2_msgs/msg/ParticleCloud": amounts.none_of("particles"),
    "nav_msgs/msg/GridCells": amounts.none_of("cells"),
    "nav_msgs/msg/Path": amounts.none_of("poses"),
    "sensor_msgs/msg/CameraInfo": amounts.pixels,
    "sensor_msgs/msg/LaserScan": amounts.ranges,
    "sensor_msgs/msg/PointCloud": amounts.none_of("points"),
    "sensor_msgs/msg/PointCloud2": amounts.points,
    "visualization_msgs/msg/Marker": amounts.marker_points,
    "visualization_msgs/msg/MarkerArray": amounts.none_of("markers"),
}
"""Type → a function that returns "0 points" or the like for an empty message, or ""."""


def content_reason(message: Any) -> TopicReason | None:
    """Return why nothing of a message can be seen; None when something can.

    Args:
        message: with its fields, whose type is `__msgtype__`.
    """
    kind = str(getattr(message, "__msgtype__", ""))
    fault, amount = (
        _said(_FAULTS.get(kind), message),
        _said(_AMOUNTS.get(kind), message),
    )
    if fault:
        return not_drawn(fault)
    return empty(amount) if amount else None


def _said(look: _Look | None, message: Any) -> str:
    if look is None:
        return ""
    try:
        with np.errstate(all="ignore"):
            return look(message)
    except (AttributeError, TypeError, ValueError):
        # A file may define a standard type with other fields: its display says so.
        return ""
