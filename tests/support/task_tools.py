"""How the tasks judge what the 3D view shows: by its pixels."""

from __future__ import annotations

import numpy as np
from desk import Desk
from viewer_page import Pixels


def drawn_around(desk: Desk, frame: str, size: int = 60) -> Pixels:
    """The square of the 3D view around a frame."""
    place = desk.viz.frames.lookup(desk.fixed_frame, frame).translation
    column, row = desk.viewer.project("", [float(v) for v in place])
    pixels = desk.viewer.pixels()
    left, top = max(column - size, 0), max(row - size, 0)
    return pixels[top : row + size, left : column + size]


def changed(before: Pixels, after: Pixels) -> int:
    """How many pixels differ visibly."""
    if before.shape != after.shape:
        return before.size
    difference = np.abs(before.astype(int) - after.astype(int)).max(axis=2)
    return int(np.count_nonzero(difference > 10))
