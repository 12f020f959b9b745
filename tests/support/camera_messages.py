"""Messages of a camera: its images, its numbers, and where it is."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from made_messages import Make


def header(types: Any, frame: str = "camera", stamp: float = 0.0) -> object:
    """Return a header; the stamp is in seconds, 0 for the latest time."""
    seconds = types["builtin_interfaces/msg/Time"](
        int(stamp), round(stamp % 1 * 1_000_000_000)
    )
    return types["std_msgs/msg/Header"](seconds, frame)


def image(
    topic: str,
    encoding: str,
    pixels: npt.NDArray[Any],
    *,
    frame: str = "camera",
    stamp: float = 0.0,
    size: tuple[int, int] | None = None,
) -> Make:
    """Return an image; its size is that of the array, (H, W, …), if not given."""

    def make(types: Any) -> tuple[str, str, object]:
        name = "sensor_msgs/msg/Image"
        height, width = size or pixels.shape[:2]
        octets = np.frombuffer(pixels.tobytes(), np.uint8)
        parts = (height, width, encoding, 0, octets.size // max(height, 1), octets)
        return topic, name, types[name](header(types, frame, stamp), *parts)

    return make


def file(topic: str, data: bytes, of: str, frame: str = "camera") -> Make:
    """Return a compressed image."""

    def make(types: Any) -> tuple[str, str, object]:
        name = "sensor_msgs/msg/CompressedImage"
        octets = np.frombuffer(data, np.uint8)
        return topic, name, types[name](header(types, frame), of, octets)

    return make


def info(
    topic: str,
    p: Sequence[float],
    size: tuple[int, int] = (0, 0),
    *,
    binning: int = 0,
    roi: tuple[int, int, int, int] = (0, 0, 0, 0),
    frame: str = "camera",
) -> Make:
    """Return a camera info.

    Args:
        topic: its name.
        p: the twelve numbers, by rows, or fx, fy, cx and cy.
        size: width and height [pixels].
        binning: along both sides.
        roi: x, y, width and height.
        frame: of the camera.
    """
    if len(p) == 4:
        fx, fy, cx, cy = p
        p = (fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0)

    def make(types: Any) -> tuple[str, str, object]:
        name = "sensor_msgs/msg/CameraInfo"
        region = types["sensor_msgs/msg/RegionOfInterest"](
            roi[0], roi[1], roi[3], roi[2], False
        )
        zeros = np.zeros(9)
        made = types[name](
            header(types, frame),
            size[1],
            size[0],
            "plumb_bob",
            np.zeros(5),
            zeros,
            zeros,
            np.array(p, np.float64),
            binning,
            binning,
            region,
        )
        return topic, name, made

    return make


def pose(
    child: str, xyz: Sequence[float], xyzw: Sequence[float], parent: str = "map"
) -> Make:
    """Return a static transform."""

    def make(types: Any) -> tuple[str, str, object]:
        at = types["geometry_msgs/msg/Vector3"](*xyz)
        turn = types["geometry_msgs/msg/Quaternion"](*xyzw)
        step = types["geometry_msgs/msg/Transform"](at, turn)
        named = types["geometry_msgs/msg/TransformStamped"]
        message = types["tf2_msgs/msg/TFMessage"]
        made = message([named(header(types, parent), child, step)])
        return "/tf_static", "tf2_msgs/msg/TFMessage", made

    return make


def cube(topic: str, xyz: Sequence[float], edge: float, number: int = 0) -> Make:
    """Return a marker, a green cube in the frame map."""

    def make(types: Any) -> tuple[str, str, object]:
        name = "visualization_msgs/msg/Marker"
        point = types["geometry_msgs/msg/Point"]
        turn = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
        cubes, add = 1, 0
        made = types[name](
            header(types, "map"),
            "",
            number,
            cubes,
            add,
            types["geometry_msgs/msg/Pose"](point(*xyz), turn),
            types["geometry_msgs/msg/Vector3"](edge, edge, edge),
            types["std_msgs/msg/ColorRGBA"](0.0, 1.0, 0.0, 1.0),
            types["builtin_interfaces/msg/Duration"](0, 0),
            False,
            [],
            [],
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
        return topic, name, made

    return make


def unpacked(frame: bytes) -> tuple[dict[str, Any], bytes]:
    """Return what the page is sent of a picture: about it, and its file."""
    end = 5 + int.from_bytes(frame[1:5], "little")
    return json.loads(frame[5:end]), frame[end:]
