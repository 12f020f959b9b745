"""How the tasks judge what the 3D view shows: by its pixels."""

from __future__ import annotations

import numpy as np
from desk import Desk
from viewer_page import Pixels

_CONTROLS = ("button", "tab", "slider", "checkbox", "menuitem")


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
    desk.settle()
    # Names take a moment to be laid out.
    before = desk.viewer.pixels()
    for _ in range(100):
        after = desk.viewer.pixels()
        if not changed(before, after):
            return
        before = after
    raise AssertionError("the picture does not come to rest")


def on_page(desk: Desk, *point: float, frame: str = "") -> tuple[float, float]:
    """Where a point of the fixed frame, or of a frame, is on the page [CSS pixels]."""
    if frame:
        found = desk.viz.frames.lookup(desk.fixed_frame, frame)
        x, y, z = point or (0.0, 0.0, 0.0)
        point = tuple(float(v) for v in found.matrix[:3] @ (x, y, z, 1.0))
    return desk.viewer.on_page(point)


def drawn(desk: Desk) -> float:
    """The part of the 3D view that has another colour than its corner."""
    pixels = desk.viewer.pixels()[..., :3].astype(int)
    return float((np.abs(pixels - pixels[5, 5]).max(axis=-1) > 8).mean())


def corner(desk: Desk) -> tuple[int, ...]:
    """The colour of the upper left corner of the 3D view."""
    return tuple(int(v) for v in desk.viewer.pixels()[5, 5, :3])


def changed(before: Pixels, after: Pixels) -> int:
    """How many pixels differ visibly."""
    if before.shape != after.shape:
        return before.size
    difference = np.abs(before.astype(int) - after.astype(int)).max(axis=2)
    return int(np.count_nonzero(difference > 10))


def nothing_is_cut_off(desk: Desk) -> None:
    """Wait until all controls are whole on the screen, or can be scrolled to.

    Scrolling replaces rows, so what was seen once is not looked for again.
    """
    seen: set[int] = set()

    def is_whole() -> bool:
        found: list[str] = []
        for thing in desk.user.see().walk():
            if thing.role not in _CONTROLS or thing.node in seen:
                continue
            try:
                if not desk.user.can_see(thing):
                    desk.user.go_to(thing)
                seen.add(thing.node)
            except AssertionError as error:
                found.append(str(error))
        assert not found, "; ".join(found)
        return True

    desk.user.until(is_whole)
