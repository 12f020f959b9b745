"""Images that cannot be shown, and the way out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sambot_viz import limits
from sambot_viz.errors import nearest

_LAYOUTS = ("rggb", "bggr", "gbrg", "grbg")
PIXEL_BYTES: Mapping[str, int] = {
    **dict.fromkeys(("mono8", "8UC1", "8SC1"), 1),
    **dict.fromkeys(("rgb8", "bgr8", "8UC3", "8SC3"), 3),
    **dict.fromkeys(("rgba8", "bgra8", "8UC4", "8SC4"), 4),
    **dict.fromkeys(("mono16", "16UC1", "16SC1"), 2),
    "32FC1": 4,
    **dict.fromkeys(("uyvy", "yuyv", "yuv422", "yuv422_yuy2"), 2),
    **{f"bayer_{one}{8 * size}": size for one in _LAYOUTS for size in (1, 2)},
    **dict.fromkeys(("nv12", "nv21", "nv24"), 1),
}
"""Encoding of a sensor_msgs/Image that is shown → bytes of a pixel in its rows."""
CHROMA_SHARE: Mapping[str, int] = {"nv12": 2, "nv21": 2, "nv24": 1}
"""Encoding with its U and V after all of Y → of how many columns and rows a pair is."""
DEPTH, DEPTH_HEADER = "compressedDepth", 12
"""The format of a file of depths, and how many bytes are before it."""
_FILES = (b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n")
_VIDEOS = ("264", "265", "hevc", "avc", "av1", "vp8", "vp9", "mpeg", "ffmpeg", "theora")


def picture_fault(message: Any) -> str:
    """Return why an image, of whichever kind, cannot be shown; empty when it can.

    Of a file only the first bytes are looked at.
    """
    if hasattr(message, "format"):
        return _file_fault(bytes(message.data[:32]), str(message.format))
    encoding = str(message.encoding)
    if encoding not in PIXEL_BYTES:
        return f"Unsupported image encoding [{encoding[:60]}]. {_instead(encoding)}"
    width, height = int(message.width), int(message.height)
    fault = size_fault(width, height)
    needed = 0 if fault else _least(encoding, width, height, int(message.step))
    if len(message.data) < needed:
        what = f"{width} × {height} pixels of {encoding}"
        return (
            f"The image has {len(message.data):,} bytes; {what} are {needed:,}: what "
            "publishes it names a wrong size or encoding, or leaves bytes out"
        )
    return fault


def size_fault(width: int, height: int) -> str:
    """Return why a picture of a size cannot be shown [pixels]; empty when it can."""
    size = f"{width:,} × {height:,} pixels"
    if width <= 0 or height <= 0:
        return f"The image has {size}: look at what publishes it"
    most = limits.IMAGE.value
    if width * height > most:
        return f"The image has {size}: at most {most:,} are shown"
    return ""


def not_a_picture(of: str, content: bytes) -> str:
    """Say that the data of a sensor_msgs/CompressedImage are no picture.

    Args:
        of: its format.
        content: the first of its bytes.
    """
    text = f"The image of the format '{of[:60]}' is not a JPEG, PNG or WebP"
    words = of.lower()
    if not content:
        return f"{text}: it has no bytes, look at what publishes it"
    if "rvl" in words:
        return (
            f"{text}. Depths in RVL are not read: let them be sent as PNG (the "
            "parameter compressedDepth.format of the camera)"
        )
    if any(one in words for one in _VIDEOS) or content[:4] == b"\0\0\0\1":
        return (
            f"{text}. Video is not read: publish or record the images of the camera as "
            "they are, or as JPEG (the topic ending with /compressed)"
        )
    return (
        f"{text}. Its data are damaged or in another format: let it be sent as jpeg or "
        "png (the parameter compressed.format of the camera)"
    )


def _file_fault(head: bytes, of: str) -> str:
    is_depth = DEPTH in of
    content = head[DEPTH_HEADER:] if is_depth else head
    is_webp = content[:4] == b"RIFF" and content[8:12] == b"WEBP"
    is_known = content.startswith(_FILES) or is_webp
    return "" if is_known else not_a_picture(of, content)


def _least(encoding: str, width: int, height: int, step: int) -> int:
    """Return how many bytes an image needs at least."""
    share = CHROMA_SHARE.get(encoding)
    if share is None:
        return width * height * PIXEL_BYTES[encoding]
    rows, columns = -(-height // share), -(-width // share)
    step = max(step, width)
    return step * height + step * 2 // share * (rows - 1) + 2 * columns


def _instead(encoding: str) -> str:
    """Return what to publish in place of an encoding that is not shown."""
    if encoding.lower() in PIXEL_BYTES:
        return f"Its name is written '{encoding.lower()}'"
    if encoding.startswith(("rgb", "bgr")) and encoding.endswith("16"):
        return f"Publish 8 bits for each colour ('{encoding[:-2]}8')"
    if "FC" in encoding or "SC" in encoding or "UC" in encoding:
        return "Publish one number for each pixel (16UC1 or 32FC1), or colours (rgb8)"
    if like := nearest(encoding, PIXEL_BYTES, likeness=0.75):
        return (
            f"Did you mean '{like}'? Publish one that is shown, such as rgb8 or mono8"
        )
    return "Publish one that is shown, such as rgb8, bgr8, mono8, 16UC1 or 32FC1"
