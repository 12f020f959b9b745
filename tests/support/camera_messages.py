"""Messages of a camera: its images, its numbers, and where it is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

Make = Callable[[Any], tuple[str, str, object]]
"""Returns topic, type and message, made of rosbags' types."""


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
