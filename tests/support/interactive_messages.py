"""Messages of interactive markers, as the fixture `messages` takes them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from made_messages import Make

Quat = tuple[float, float, float, float]
INHERIT, FIXED, VIEW_FACING = range(3)
MENU, BUTTON, MOVE_AXIS, MOVE_PLANE, ROTATE_AXIS, MOVE_ROTATE = range(1, 7)
PLAIN: Quat = (0.0, 0.0, 0.0, 1.0)
_H = math.sqrt(0.5)
ALONG_Y: Quat = (0.0, 0.0, _H, _H)
ALONG_Z: Quat = (0.0, -_H, 0.0, _H)
"""Rotations x, y, z, w that turn x to y, and x to z."""


def header(types: Any, frame: str = "map", seconds: int = 0) -> Any:
    time = types["builtin_interfaces/msg/Time"](seconds, 0)
    return types["std_msgs/msg/Header"](time, frame)


def pose(types: Any, x: float = 0.0, turn: Quat = PLAIN) -> Any:
    point = types["geometry_msgs/msg/Point"](x, 0.0, 0.0)
    quaternion = types["geometry_msgs/msg/Quaternion"](*turn)
    return types["geometry_msgs/msg/Pose"](point, quaternion)


def cube(
    types: Any,
    *,
    frame: str = "",
    x: float = 0.0,
    scale: Sequence[float] = (0.2, 0.2, 0.2),
    alpha: float = 1.0,
    kind: int = 1,
    points: Sequence[float] = (),
    colors: int = 0,
) -> Any:
    point, color = types["geometry_msgs/msg/Point"], types["std_msgs/msg/ColorRGBA"]
    return types["visualization_msgs/msg/Marker"](
        header(types, frame),
        "",
        0,
        kind,
        0,
        pose(types, x),
        types["geometry_msgs/msg/Vector3"](*scale),
        color(1.0, 1.0, 0.0, alpha),
        types["builtin_interfaces/msg/Duration"](0, 0),
        False,
        [point(x, 0.0, 0.0) for x in points],
        [color(1.0, 0.0, 0.0, 1.0)] * colors,
        "",
        types["sensor_msgs/msg/CompressedImage"](
            header(types, ""), "", np.zeros(0, np.uint8)
        ),
        [],
        "",
        "",
        types["visualization_msgs/msg/MeshFile"]("", np.zeros(0, np.uint8)),
        False,
    )


def control(
    types: Any,
    mode: int = BUTTON,
    *,
    name: str = "control",
    turn: Quat = PLAIN,
    turning: int = INHERIT,
    always: bool = False,
    independent: bool = False,
    markers: Sequence[Any] = (),
    description: str = "",
) -> Any:
    return types["visualization_msgs/msg/InteractiveMarkerControl"](
        name,
        types["geometry_msgs/msg/Quaternion"](*turn),
        turning,
        mode,
        always,
        list(markers),
        independent,
        description,
    )


def marker(
    types: Any,
    name: str = "one",
    *,
    frame: str = "map",
    seconds: int = 0,
    x: float = 0.0,
    turn: Quat = PLAIN,
    scale: float = 1.0,
    description: str = "",
    controls: Sequence[Any] | None = None,
) -> Any:
    if controls is None:
        controls = [control(types, MOVE_AXIS)]
    return types["visualization_msgs/msg/InteractiveMarker"](
        header(types, frame, seconds),
        pose(types, x, turn),
        name,
        description,
        scale,
        [],
        list(controls),
    )


def six_degrees(types: Any, name: str = "one", **values: Any) -> Any:
    """Return a marker that moves along, and turns about, its three axes."""
    box = control(types, always=True, name="box", markers=[cube(types)])
    moves = [
        control(types, mode, name=f"{mode} {axis}", turn=turn)
        for mode in (MOVE_AXIS, ROTATE_AXIS)
        for axis, turn in (("x", PLAIN), ("y", ALONG_Y), ("z", ALONG_Z))
    ]
    return marker(types, name, controls=[box, *moves], **values)


def moved(
    types: Any, name: str, x: float, frame: str = "map", turn: Quat = PLAIN
) -> Any:
    return types["visualization_msgs/msg/InteractiveMarkerPose"](
        header(types, frame), pose(types, x, turn), name
    )


def update(
    *markers: Callable[[Any], Any],
    poses: Sequence[Callable[[Any], Any]] = (),
    erases: Sequence[str] = (),
    number: int = 1,
    kind: int = 1,
    server: str = "server",
    topic: str = "/ns/update",
) -> Make:
    """Return what makes an update; each part is made of the types of messages."""

    def make(types: Any) -> tuple[str, str, object]:
        name = "visualization_msgs/msg/InteractiveMarkerUpdate"
        made = [one(types) for one in markers], [one(types) for one in poses]
        return topic, name, types[name](server, number, kind, *made, list(erases))

    return make


def full(
    *markers: Callable[[Any], Any], number: int = 1, server: str = "server"
) -> Make:
    """Return what makes a full set of markers."""

    def make(types: Any) -> tuple[str, str, object]:
        name = "visualization_msgs/msg/InteractiveMarkerInit"
        made = [one(types) for one in markers]
        return "/ns/update_full", name, types[name](server, number, made)

    return make
