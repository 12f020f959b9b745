"""The size of a box whose three lengths were written as their own attributes."""

from __future__ import annotations

from sambot_viz.robot.xml.element import Element

_NAMES = (
    ("length", "width", "height"),
    ("x", "y", "z"),
    ("width", "depth", "height"),
)


def size_of_three(box: Element) -> str | None:
    """Return "x y z" from length, width and height, or None when they are not there."""
    for names in _NAMES:
        values = [box.get(name) for name in names]
        known = [value for value in values if value]
        if len(known) == len(names):
            return " ".join(known)
    return None
