"""Pictures of sensors with a colour filter: one colour per pixel becomes three."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

_RED: Mapping[str, tuple[int, int]] = {
    "rggb": (0, 0),
    "grbg": (0, 1),
    "gbrg": (1, 0),
    "bggr": (1, 1),
}
"""Filter → row and column of red in each 2 × 2 pixels; blue is at the other corner."""
BAYER: Mapping[str, tuple[str, int]] = {
    f"bayer_{name}{8 * size}": (name, size) for name in _RED for size in (1, 2)
}
"""Encoding → its filter, and the bytes of a pixel."""
Number = TypeVar("Number", np.uint8, np.uint16)


def demosaiced(mosaic: npt.NDArray[Number], pattern: str) -> npt.NDArray[Number]:
    """Return the colours of a mosaic, (H, W, 3) RGB of its numbers.

    A colour that a pixel does not measure is the mean of those around it that do, as in
    RViz 2 (its pull request 1749); without any of them it is 0.

    Args:
        mosaic: one number for each pixel, (H, W).
        pattern: the filter, such as "rggb".
    """
    row, column = _RED[pattern]
    height, width = mosaic.shape
    red, blue = np.zeros((height, width), bool), np.zeros((height, width), bool)
    red[row::2, column::2] = True
    blue[1 - row :: 2, 1 - column :: 2] = True
    colors = [_spread(mosaic, own) for own in (red, ~(red | blue), blue)]
    return np.stack(colors, axis=-1)


def _spread(
    mosaic: npt.NDArray[Number], own: npt.NDArray[np.bool_]
) -> npt.NDArray[Number]:
    """Return a colour at all pixels, of which some measure it."""
    wide = np.dtype(f"u{2 * mosaic.itemsize}")
    count = _sum_around(own.astype(wide))
    total = _sum_around(np.where(own, mosaic, 0).astype(wide))
    mean = (total + count // 2) // np.maximum(count, 1)
    return np.where(own, mosaic, mean).astype(mosaic.dtype)


def _sum_around(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return the sums of each 3 × 3 pixels."""
    padded = np.pad(values, 1)
    rows = padded[:-2] + padded[1:-1] + padded[2:]
    return rows[:, :-2] + rows[:, 1:-1] + rows[:, 2:]
