"""Pictures beside those of RViz: what of them is drawn, where, and in which colour."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

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


def dilated(mask: Mask, pixels: int = 1) -> Mask:
    """All pixels with a pixel of the mask within so many pixels, also diagonally."""
    if pixels > 1:
        mask = dilated(mask, pixels - 1)
    out: Mask = np.array(mask)
    padded = np.pad(mask, 1)
    height, width = mask.shape
    for y in range(3):
        for x in range(3):
            out |= padded[y : y + height, x : x + width]
    return out


def outlined(mask: Mask) -> Mask:
    """The pixels on both sides of the border of what the mask covers."""
    out = np.zeros_like(mask)
    for inner, found in ((mask, out), (mask.T, out.T)):
        changes = inner[1:] != inner[:-1]
        found[1:] |= changes
        found[:-1] |= changes
    return out


def near_part(a: Mask, b: Mask, pixels: int = 1) -> float:
    """The part of the pixels of both that have one of the other so near."""
    near = (a & dilated(b, pixels)).sum() + (b & dilated(a, pixels)).sum()
    return float(near / max(1, a.sum() + b.sum()))


def flat(image: Image) -> Mask:
    """The pixels in the middle of a square of one colour."""
    height, width = (size - PATCH + 1 for size in image.shape[:2])

    def of_squares(extreme: np.ufunc) -> Image:
        rows = extreme.reduce([image[n : n + height] for n in range(PATCH)])
        return extreme.reduce([rows[:, n : n + width] for n in range(PATCH)])

    even = (of_squares(np.maximum) - of_squares(np.minimum)).max(axis=-1) <= 2
    return np.asarray(np.pad(even, PATCH // 2))
