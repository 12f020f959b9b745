"""Point clouds that cannot be drawn, and the way out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

POINT_TYPES: Mapping[int, str] = {
    1: "i1",
    2: "u1",
    3: "i2",
    4: "u2",
    5: "i4",
    6: "u4",
    7: "f4",
    8: "f8",
}
"""The datatype of a sensor_msgs/PointField → numpy's, without a byte order."""
FLOAT32 = 7
_NAMES = ("INT8", "UINT8", "INT16", "UINT16", "INT32", "UINT32", "FLOAT32", "FLOAT64")
_MOST_NAMED = 8
_NO_PLACE = "No position transformer available for cloud"


def cloud_fault(message: Any) -> str:
    """Return why a sensor_msgs/PointCloud2 cannot be drawn; empty when it can.

    The first sentence is RViz's; the second one has the cause and the remedy.
    """
    return _size_fault(message) or _place_fault(message)


def _size_fault(message: Any) -> str:
    step, width, height = (
        int(one) for one in (message.point_step, message.width, message.height)
    )
    size, needed = len(message.data), width * height * step
    if size == needed:
        return ""
    text = (
        f"Data size ({size} bytes) does not match width ({width}) times height "
        f"({height}) times point_step ({step}).  Dropping message."
    )
    row, points = int(message.row_step), width * step
    if height and row > points and size in (row * height, row * (height - 1) + points):
        return (
            f"{text} Each row has {row - points} bytes more than its points need: "
            f"publish rows without them (row_step {points})"
        )
    if step and size % step == 0:
        return (
            f"{text} The data are {size // step} points: publish their number as "
            "width, with the height 1"
        )
    return (
        f"{text} They should be {needed}: point_step is the number of bytes of a "
        "point, width and height are those of the data"
    )


def _place_fault(message: Any) -> str:
    step, fields = int(message.point_step), {str(f.name): f for f in message.fields}
    if not fields:
        return f"{_NO_PLACE}. It has no fields: look at what publishes it"
    missing = [axis for axis in "xyz" if axis not in fields]
    if missing:
        named = ", ".join([*fields][:_MOST_NAMED])
        return (
            f"{_NO_PLACE}. It has no field {' or '.join(missing)} (its fields: "
            f"{named}): publish the coordinates as x, y and z, each a FLOAT32"
        )
    kinds = {axis: int(fields[axis].datatype) for axis in "xyz"}
    others = {axis: kind for axis, kind in kinds.items() if kind != FLOAT32}
    if others:
        axes, kind = " and ".join(others), next(iter(others.values()))
        name = _NAMES[kind - 1] if kind in POINT_TYPES else f"of datatype {kind}"
        return (
            f"{_NO_PLACE}. Its {axes} {'is' if len(others) == 1 else 'are'} {name}: "
            f"publish the coordinates as FLOAT32 (datatype {FLOAT32})"
        )
    offsets = {axis: int(fields[axis].offset) for axis in "xyz"}
    outside = [axis for axis, at in offsets.items() if not 0 <= at <= step - 4]
    if outside:
        axis = outside[0]
        return (
            f"{_NO_PLACE}. The field {axis} begins at byte {offsets[axis]} of points "
            f"of {step} bytes: set point_step to the size of a point"
        )
    return ""


def channels_fault(message: Any) -> str:
    """Return why a sensor_msgs/PointCloud cannot be drawn; empty when it can."""
    count = len(message.points)
    for channel in message.channels:
        if len(channel.values) != count:
            has = f"Channel {channel.name} has {len(channel.values)} values"
            return f"{has} for {count} points: publish one for each"
    return ""
