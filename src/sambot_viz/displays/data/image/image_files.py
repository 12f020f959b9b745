"""Files of pictures: those of sensor_msgs/CompressedImage, and those we make."""

from __future__ import annotations

import io
import struct
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from sambot_viz.displays.camera_pictures import CameraPicture
from sambot_viz.displays.data.image.encodings import (
    IMAGE,
    Bytes,
    Values,
    read_image,
    read_values,
    require_shown,
)
from sambot_viz.displays.data.image.ranges import Ranges, scaled
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.topics.contents.pictures import (
    DEPTH,
    DEPTH_HEADER,
    not_a_picture,
    size_fault,
)

FEW_PIXELS = 100_000
"""Maximum number of pixels kept exactly; a larger picture becomes a JPEG."""
QUALITY = 90
_TYPES = {"JPEG": "image/jpeg", "PNG": "image/png", "WEBP": "image/webp"}


def file_of(pixels: Bytes) -> CameraPicture:
    """Return pixels as a file, (H, W) grey or (H, W, 3) RGB."""
    from PIL import Image

    image = Image.fromarray(np.ascontiguousarray(pixels))
    stream = io.BytesIO()
    is_small = image.width * image.height <= FEW_PIXELS
    if is_small:
        image.save(stream, "PNG", compress_level=1)
    else:
        image.save(stream, "JPEG", quality=QUALITY, subsampling=0)
    kind = _TYPES["PNG" if is_small else "JPEG"]
    return CameraPicture(kind, image.width, image.height, stream.getvalue())


def picture_of(message: Any, scale: Callable[[Values], Bytes]) -> CameraPicture:
    """Return an image, of whichever kind, for browsers.

    Args:
        message: with its fields.
        scale: makes grey of 16-bit and float values, (H, W).

    Raises:
        MessageRefused: it cannot be shown, and why.
    """
    if hasattr(message, "format"):
        return compressed(message, scale)
    return file_of(read_image(message, scale))


def compressed(message: Any, scale: Callable[[Values], Bytes]) -> CameraPicture:
    """Return a sensor_msgs/CompressedImage for browsers, as it came where they read it.

    Args:
        message: with its fields.
        scale: makes grey of 16-bit and float values, (H, W).

    Raises:
        MessageRefused: it cannot be shown, and why.
    """
    require_shown(message)
    content, of = bytes(message.data), str(message.format)
    if DEPTH in of:
        return file_of(scale(_depths(content, of)))
    image = _open(content, of)
    if image.mode.startswith(("I", "F")):
        return file_of(scale(np.asarray(image, np.uint16)))
    return CameraPicture(_TYPES[image.format], image.width, image.height, content)


def read_depths(message: Any) -> Values:
    """Return the numbers of a depth image, of whichever kind, (H, W).

    Raises:
        MessageRefused: it cannot be read, or has colours.
    """
    values = None
    if not hasattr(message, "format"):
        kind, values = str(message.encoding), read_values(message)
    elif DEPTH in (kind := str(message.format)):
        values = _depths(bytes(message.data), kind)
    if values is None:
        text = f"An image of {kind[:60]} has no depths: choose one of 16UC1 or 32FC1"
        raise MessageRefused(text, IMAGE)
    return values


def read_colors(message: Any) -> Bytes:
    """Return the pixels of an image, of whichever kind, (H, W, 3) RGB.

    Raises:
        MessageRefused: it cannot be read.
    """
    if hasattr(message, "format"):
        image = _open(bytes(message.data), str(message.format))
        return np.asarray(image.convert("RGB"))
    pixels = read_image(message, _grey)
    grey = pixels.ndim == 2
    return np.repeat(pixels[..., None], 3, axis=2) if grey else pixels


def _grey(values: Values) -> Bytes:
    ranges = Ranges()
    ranges.add(values)
    return scaled(values, ranges.median(1))


def _open(content: bytes, of: str) -> Any:
    """Return a file as an image, of which only the head is read."""
    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            image = Image.open(io.BytesIO(content), formats=tuple(_TYPES))
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError):
        raise MessageRefused(not_a_picture(of, content), IMAGE) from None
    if fault := size_fault(image.width, image.height):
        raise MessageRefused(fault, IMAGE)
    return image


def _depths(content: bytes, of: str) -> Values:
    """Return the depths of a picture that follows a short header, (H, W)."""
    image = _open(content[DEPTH_HEADER:], of)
    stored = np.asarray(image, np.uint16)
    if not of.startswith("32FC1"):
        return stored
    quant_a, quant_b = struct.unpack_from("<ff", content, 4)
    with np.errstate(all="ignore"):
        metres = quant_a / (stored.astype(np.float32) - quant_b)
    return np.where(stored == 0, np.nan, metres).astype(np.float32)
