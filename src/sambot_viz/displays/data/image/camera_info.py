"""The numbers of sensor_msgs/CameraInfo, and the status if they are missing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sambot_viz.displays.data.message_numbers import require_finite
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.displays.topic_messages import TopicMessages
from sambot_viz.meanings import Meaning

CAMERA_INFO = "Camera Info"
"""The key of the status."""
_MEANINGS = frozenset({Meaning.CAMERA})
_QOS = WantedQos("Best Effort", "Volatile")
_SMALLEST_FOCUS = 1e-9
"""A focal length below it shows everything at infinity [pixels]."""


@dataclass(frozen=True, slots=True)
class CameraNumbers:
    """How a camera makes pixels of points: x right, y down, z forward.

    Attributes:
        width: of the whole image; 0 where that is not said [pixels].
        height: of the whole image [pixels].
        focus: along x and y [pixels].
        center: where z meets the image [pixels].
        shift: of the second camera of a pair: its place times the focus, negative.
        binning: pixels of the sensor for one of the image, along x and y.
        roi: x, y, width and height of the part that is sent; without a size it is all.
    """

    width: int
    height: int
    focus: tuple[float, float]
    center: tuple[float, float]
    shift: tuple[float, float]
    binning: tuple[int, int]
    roi: tuple[int, int, int, int]


def projection_of(message: Any) -> Sequence[float]:
    """Return the projection matrix of a sensor_msgs/CameraInfo, row by row."""
    # ROS 1 calls it P.
    return message.p if hasattr(message, "p") else message.P


def numbers_of(message: Any) -> CameraNumbers:
    """Return the numbers of a sensor_msgs/CameraInfo.

    Raises:
        MessageRefused: they are not finite, or have no focal length.
    """
    p = [float(value) for value in projection_of(message)]
    if len(p) != 12:
        raise MessageRefused(f"P has {len(p)} numbers; it needs 12", CAMERA_INFO)
    try:
        require_finite(p)
    except MessageRefused as refused:
        raise MessageRefused(refused.text, CAMERA_INFO) from None
    if min(abs(p[0]), abs(p[5])) < _SMALLEST_FOCUS:
        text = f"The focal lengths in P are {p[0]:g} and {p[5]:g} pixels"
        raise MessageRefused(f"{text}: the camera is not calibrated", CAMERA_INFO)
    roi = message.roi
    return CameraNumbers(
        int(message.width),
        int(message.height),
        (p[0], p[5]),
        (p[2], p[6]),
        (p[3], p[7]),
        (max(int(message.binning_x), 1), max(int(message.binning_y), 1)),
        (int(roi.x_offset), int(roi.y_offset), int(roi.width), int(roi.height)),
    )


def size_doubt(camera: CameraNumbers, size: tuple[int, int]) -> str | None:
    """Return a sentence about a wrong size of an image; None if it is right.

    Args:
        camera: the numbers of its camera.
        size: width and height of the image [pixels].
    """
    x, y = camera.binning
    said = (camera.width // x, camera.height // y)
    if camera.roi[2] and camera.roi[3]:
        said = (camera.roi[2], camera.roi[3])
    if said in (size, (0, 0)):
        return None
    text = f"It is of an image of {said[0]} × {said[1]} pixels, and the image has"
    return f"{text} {size[0]} × {size[1]}: what is drawn is not in its place"


def no_info(topic: str, messages: TopicMessages | None) -> str:
    """Return why no camera info has come.

    Args:
        topic: the expected topic.
        messages: the facts about topics.
    """
    text = f"No CameraInfo received on [{topic}]"
    doubt = messages.doubt(topic, _MEANINGS, _QOS) if messages is not None else None
    return text if doubt is None else f"{text}. {doubt.sentence}"
