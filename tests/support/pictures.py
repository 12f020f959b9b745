"""Pictures beside those of RViz: what of them is drawn, where, and in which colour."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from sambot_viz.export.chromium import Chromium

Image = npt.NDArray[np.int16]
Mask = npt.NDArray[np.bool_]
DIFFERENT = 12
"""A channel this far from the background belongs to something that is drawn."""
SAME = 8
"""Colours whose channels are this near are the same."""
PATCH = 5
"""Edge of the square that is of one colour around a pixel of a flat patch."""


def picture(path: Path) -> Image:
    """A picture of a file, (height, width, 3)."""
    from PIL import Image as Pillow

    opened: Pillow.Image = Pillow.open(path)
    with opened:
        return np.asarray(opened.convert("RGB"), np.int16)


def counting(folder: Path, golden: Image) -> Mask:
    """The pixels that count: where RViz's own order is undefined, either is right."""
    doubtful = folder / "ambiguous_mask.png"
    if doubtful.exists():
        return np.asarray(picture(doubtful)[..., 0] == 0)
    return np.ones(golden.shape[:2], bool)


def drawn(image: Image, background: Image | int) -> Mask:
    """The pixels that differ from the background."""
    return np.asarray(np.abs(image - background).max(axis=-1) > DIFFERENT)


def dilated(mask: Mask) -> Mask:
    """All pixels with a pixel of the mask within one pixel."""
    out: Mask = np.array(mask)
    padded = np.pad(mask, 1)
    height, width = mask.shape
    for y in range(3):
        for x in range(3):
            out |= padded[y : y + height, x : x + width]
    return out


def near_part(a: Mask, b: Mask) -> float:
    """The part of the pixels of both that have one of the other within one pixel."""
    near = (a & dilated(b)).sum() + (b & dilated(a)).sum()
    return float(near / max(1, a.sum() + b.sum()))


def flat(image: Image) -> Mask:
    """The pixels in the middle of a square of one colour."""
    windows = np.lib.stride_tricks.sliding_window_view(image, (PATCH, PATCH), (0, 1))
    even = (windows.max(axis=(-1, -2)) - windows.min(axis=(-1, -2))).max(axis=-1) <= 2
    return np.asarray(np.pad(even, PATCH // 2))


def end_of_recording(chromium: Chromium, folder: Path, shape: tuple[int, ...]) -> Image:
    """The messages of a case at their end, through the view of its config.

    Args:
        chromium: takes the picture.
        folder: with messages.mcap and config.rviz.
        shape: of the picture: height, width, ….
    """
    from sambot_viz import Visualizer
    from sambot_viz.export.view_picture import snapshot

    source = f"bag:{folder / 'messages.mcap'}"
    config = folder / "config.rviz"
    with Visualizer(source=source, config=config, port=0, panels=False) as viz:
        viz.player.pause()
        viz.player.jump(viz.player.duration)
        view = viz.server.sessions.all()[0].document_view.camera
        found = snapshot(viz.server, chromium, shape[1], shape[0], view)
        return found.astype(np.int16)
