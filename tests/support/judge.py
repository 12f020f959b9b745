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


def look_near(desk: Desk) -> None:
    """Bring the robot to the whole of the view, and wait until it stands still."""
    desk.user.click("button", "Focus", ("toolbar", "Tools"))
    before = desk.viewer.pixels()
    for _ in range(100):
        after = desk.viewer.pixels()
        if not changed(before, after):
            return
        before = after
    raise AssertionError("the picture does not come to rest")


def corner(desk: Desk) -> tuple[int, ...]:
    """The colour of the upper left corner of the 3D view."""
    return tuple(int(v) for v in desk.viewer.pixels()[5, 5, :3])


def changed(before: Pixels, after: Pixels) -> int:
    """How many pixels differ visibly."""
    if before.shape != after.shape:
        return before.size
    difference = np.abs(before.astype(int) - after.astype(int)).max(axis=2)
    return int(np.count_nonzero(difference > 10))
