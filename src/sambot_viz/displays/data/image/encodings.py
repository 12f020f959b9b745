"""The encodings of sensor_msgs/Image, as RViz shows them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.displays.data.refusals import MessageRefused

IMAGE = "Image"
"""The key of the status."""
MOST_PIXELS = limits.IMAGE.value
"""A larger picture is not shown."""
Bytes = npt.NDArray[np.uint8]
Values = npt.NDArray[np.uint16] | npt.NDArray[np.float32]

_CHANNELS: dict[str, tuple[int, ...]] = {
    "rgb8": (0, 1, 2),
    "rgba8": (0, 1, 2, 3),
    "bgr8": (2, 1, 0),
    "8UC3": (2, 1, 0),
    "8SC3": (2, 1, 0),
    "bgra8": (2, 1, 0, 3),
    "8UC4": (2, 1, 0, 3),
    "8SC4": (2, 1, 0, 3),
    "mono8": (0,),
    "8UC1": (0,),
    "8SC1": (0,),
}
"""Encoding → where red, green, blue and alpha are."""
_SCALED = {
    "16UC1": np.dtype(np.uint16),
    "16SC1": np.dtype(np.uint16),
    "mono16": np.dtype(np.uint16),
    "32FC1": np.dtype(np.float32),
}
_YUV = {
    "uyvy": (1, 0, 2),
    "yuv422": (1, 0, 2),
    "yuyv": (0, 1, 3),
    "yuv422_yuy2": (0, 1, 3),
}
"""Encoding → where the first Y, U and V are among four bytes of two pixels."""


def require_size(width: int, height: int) -> None:
    """Refuse a picture without pixels, or with too many.

    Raises:
        MessageRefused: it is one.
    """
    size = f"{width:,} × {height:,} pixels"
    if width <= 0 or height <= 0:
        raise MessageRefused(f"The image has {size}", IMAGE)
    if width * height > MOST_PIXELS:
        most = f"at most {MOST_PIXELS / 1e6:.0f} million are shown"
        raise MessageRefused(f"The image has {size}: {most}", IMAGE)


def read_values(message: Any) -> Values | None:
    """Return the numbers of a sensor_msgs/Image, (H, W); None where it has colours.

    Raises:
        MessageRefused: it cannot be read, and why.
    """
    native: Any = _SCALED.get(str(message.encoding))
    if native is None:
        return None
    dtype: Any = native.newbyteorder(">" if message.is_bigendian else "<")
    rows: Any = np.ascontiguousarray(_rows(message, native.itemsize))
    values: Any = rows.view(dtype)
    return values.astype(native, copy=False)


def read_image(message: Any, scale: Callable[[Values], Bytes]) -> Bytes:
    """Return the pixels of a sensor_msgs/Image, (H, W) grey or (H, W, 3) RGB.

    Args:
        message: with its fields.
        scale: makes grey of 16-bit and float values, (H, W).

    Raises:
        MessageRefused: it cannot be shown, and why.
    """
    encoding, values = str(message.encoding), read_values(message)
    if values is not None:
        return scale(values)
    if encoding in _YUV:
        return _from_yuv(_rows(message, 2), *_YUV[encoding])
    places = (0,) if encoding.startswith("bayer") else _CHANNELS.get(encoding)
    if places is None:
        raise MessageRefused(f"Unsupported image encoding [{encoding}]", IMAGE)
    rows = _rows(message, len(places))
    if len(places) == 1:
        return rows
    pixels = np.reshape(rows, (len(rows), -1, len(places)))
    return np.ascontiguousarray(pixels[..., places[:3]])


def _rows(message: Any, pixel: int) -> Bytes:
    """Return the bytes of the pixels, (H, W · pixel), without those between rows."""
    width, height, step = int(message.width), int(message.height), int(message.step)
    require_size(width, height)
    row = width * pixel
    data = np.ascontiguousarray(message.data, np.uint8)
    # Of a step that cannot be RViz takes no notice either.
    step = step if step >= row and step * (height - 1) + row <= len(data) else row
    needed = step * (height - 1) + row
    if len(data) < needed:
        what = f"{width} × {height} pixels of {message.encoding}"
        text = f"The image has {len(data):,} bytes; {what} are {needed:,}"
        raise MessageRefused(text, IMAGE)
    return np.lib.stride_tricks.as_strided(data, (height, row), (step, 1))


def _from_yuv(rows: Bytes, first: int, u_at: int, v_at: int) -> Bytes:
    height, width = len(rows), rows.shape[1] // 2
    pairs = np.reshape(rows[:, : width // 2 * 4], (height, -1, 4))
    luma = np.reshape(pairs[..., first::2], (height, -1)).astype(np.float32)
    u, v = (
        np.repeat(pairs[..., at].astype(np.float32) - 128.0, 2, axis=1)
        for at in (u_at, v_at)
    )
    # The sign of the second term of green is RViz's.
    rgb = (luma + 1.403 * v, luma + 0.344 * u - 0.714 * v, luma + 1.770 * u)
    pixels: Any = np.stack(rgb, axis=-1)
    return np.asarray(pixels.clip(0, 255), np.uint8)
