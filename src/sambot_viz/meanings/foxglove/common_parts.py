"""The parts that many of Foxglove's schemas have: stamps, frames, poses, colours.

In Protobuf a field that is zero is not written, so that a rotation without numbers is
none, and a colour without any is not black but not set.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

from sambot_viz.errors import DecodeError
from sambot_viz.meanings.schema_row import Fields
from sambot_viz.messages.shape import is_fields, time_parts

IDENTITY = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
"""A rotation that is none."""
WHITE = {"r": 1.0, "g": 1.0, "b": 1.0, "a": 1.0}


def part(fields: Fields, name: str) -> Fields | None:
    """Return the fields in a field; None when it is not there.

    Raises:
        DecodeError: it has no fields.
    """
    value = fields.get(name)
    if value is None or is_fields(value):
        return value
    raise DecodeError(f"{name}: it has no fields")


def parts(fields: Fields, name: str) -> Sequence[Fields]:
    """Return the elements of a list of fields; an empty list if it is missing.

    Raises:
        DecodeError: the value is no such list.
    """
    value = fields.get(name) or ()
    is_list = isinstance(value, list | tuple)
    if not is_list or not all(map(is_fields, cast("Any", value))):
        raise DecodeError(f"{name}: it is not a list of fields")
    return cast("Sequence[Fields]", value)


def time_of(value: Any) -> Fields:
    """Return a time or duration in ROS's spelling."""
    sec, nanosec = time_parts(value)
    return {"sec": sec, "nanosec": nanosec}


def header_of(fields: Fields) -> Fields:
    """Return the header of a message with a timestamp and a frame."""
    stamp = time_of(fields.get("timestamp"))
    return {"stamp": stamp, "frame_id": fields.get("frame_id")}


def rotation_of(value: Fields | None) -> Fields:
    """Return a rotation; none where it has no numbers."""
    return value if value and any(map(value.get, "xyzw")) else IDENTITY


def pose_of(value: Fields | None) -> Fields:
    """Return a pose; the origin when it is not there."""
    if value is None:
        return {"orientation": IDENTITY}
    orientation = rotation_of(part(value, "orientation"))
    return {"position": part(value, "position"), "orientation": orientation}


def color_of(value: Fields | None) -> Fields:
    """Return a colour, 0 to 1; white when it is not there."""
    return WHITE if value is None else value
