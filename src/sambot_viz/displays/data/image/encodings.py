"""The encodings of sensor_msgs/Image, as RViz shows them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.data.image.bayer import BAYER, demosaiced
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.topics.contents.pictures import CHROMA_SHARE, picture_fault

IMAGE = "Image"
"""The key of the status."""
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
_PLANES = {"nv12": (0, 1), "nv21": (1, 0), "nv24": (0, 1)}
"""Encoding → where U and V are in a pair."""


def require_shown(message: Any) -> None:
    """Refuse an image, of whichever kind, that cannot be shown.

    Raises:
        MessageRefused: it is one, and what to do.
    """
    if fault := picture_fault(message):
        raise MessageRefused(fault, IMAGE)


def read_values(message: Any) -> Values | None:
    """Return the numbers of a sensor_msgs/Image, (H, W); None where it has colours.

    Raises:
        MessageRefused: it cannot be read, and why.
    """
    native: Any = _SCALED.get(str(message.encoding))
    if native is None:
        return None
    require_shown(message)
    return _numbers(message, native)


def read_image(message: Any, scale: Callable[[Values], Bytes]) -> Bytes:
    """Return the pixels of a sensor_msgs/Image, (H, W) grey or (H, W, 3) RGB.

    Args:
        message: with its fields.
        scale: makes bytes of 16-bit and float values, (H, W) or (H, W, 3).

    Raises:
        MessageRefused: it cannot be shown, and why.
    """
    encoding, values = str(message.encoding), read_values(message)
    if values is not None:
        return scale(values)
    require_shown(message)
    if encoding in _YUV:
        return _from_pairs(_rows(message, 2), *_YUV[encoding])
    if encoding in _PLANES:
        return _from_planes(message, CHROMA_SHARE[encoding], *_PLANES[encoding])
    if encoding in BAYER:
        return _from_bayer(message, *BAYER[encoding], scale)
    places = _CHANNELS[encoding]
    rows = _rows(message, len(places))
    if len(places) == 1:
        return rows
    pixels = np.reshape(rows, (len(rows), -1, len(places)))
    return np.ascontiguousarray(pixels[..., places[:3]])


def _numbers(message: Any, native: Any) -> Any:
    """Return the numbers of the pixels, (H, W), in the byte order of this machine."""
    dtype: Any = native.newbyteorder(">" if message.is_bigendian else "<")
    rows: Any = np.ascontiguousarray(_rows(message, native.itemsize))
    return rows.view(dtype).astype(native, copy=False)


def _rows(message: Any, pixel: int) -> Bytes:
    """Return the bytes of the pixels, (H, W · pixel), without those between rows."""
    height, row = int(message.height), int(message.width) * pixel
    step = int(message.step)
    # Of a step that cannot be RViz takes no notice either.
    if step < row or step * (height - 1) + row > len(message.data):
        step = row
    return _block(message, 0, (height, row), step)


def _block(message: Any, first: int, shape: tuple[int, int], step: int) -> Bytes:
    """Return rows of bytes of a message that is long enough.

    Args:
        message: the decoded message.
        first: offset of the first row [bytes].
        shape: number of rows, and bytes of each.
        step: distance from one row to the next [bytes].
    """
    data = np.ascontiguousarray(message.data, np.uint8)
    return np.lib.stride_tricks.as_strided(data[first:], shape, (step, 1))


def _from_bayer(
    message: Any, pattern: str, size: int, scale: Callable[[Values], Bytes]
) -> Bytes:
    if size == 1:
        return demosaiced(_rows(message, 1), pattern)
    return scale(demosaiced(_numbers(message, np.dtype(np.uint16)), pattern))


def _from_pairs(rows: Bytes, first: int, u_at: int, v_at: int) -> Bytes:
    """Return the colours of rows in which two pixels share their U and V."""
    height, width = len(rows), rows.shape[1] // 2
    pairs = np.reshape(rows[:, : width // 2 * 4], (height, -1, 4))
    luma = np.reshape(pairs[..., first::2], (height, -1))
    return _from_yuv(luma, pairs[..., u_at], pairs[..., v_at], (1, 2))


def _from_planes(message: Any, share: int, u_at: int, v_at: int) -> Bytes:
    """Return the colours of an image whose U and V come after all of its Y."""
    height, width = int(message.height), int(message.width)
    step = max(int(message.step), width)
    rows, columns = -(-height // share), -(-width // share)
    chroma = _block(message, step * height, (rows, 2 * columns), step * 2 // share)
    luma = _block(message, 0, (height, width), step)
    u, v = chroma[:, u_at::2], chroma[:, v_at::2]
    return _from_yuv(luma, u, v, (share, share))


def _from_yuv(luma: Bytes, u: Bytes, v: Bytes, share: tuple[int, int]) -> Bytes:
    """Return RGB, (H, W, 3), in RViz's whole numbers.

    Args:
        luma: Y of each pixel, (H, W).
        u: of some pixels together.
        v: of the same ones.
        share: of how many rows and columns.
    """
    u_off, v_off = (one.astype(np.int32) - 128 for one in (u, v))
    # The sign of the second term of green is RViz's. Its divisions cut towards 0.
    parts = (1403 * v_off, 344 * u_off - 714 * v_off, 1770 * u_off)
    pixels = np.empty((*luma.shape, 3), np.uint8)
    for at, part in enumerate(parts):
        added = np.trunc(part / 1000).astype(np.int16)
        added = added.repeat(share[0], axis=0).repeat(share[1], axis=1)
        added = added[: luma.shape[0], : luma.shape[1]]
        pixels[..., at] = (luma + added).clip(0, 255)
    return pixels
