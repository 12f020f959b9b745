"""The handles of controls that bring no markers: arrows, rings, and texts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache

from sambot_viz.displays.data.interactive_markers.control_marker import (
    Color,
    ControlMarker,
    Pose,
    Xyz,
    turn_of,
)
from sambot_viz.displays.data.interactive_markers.dragging import (
    MENU,
    MOVE_AXIS,
    MOVE_PLANE,
    MOVE_ROTATE,
    ROTATE_AXIS,
)
from sambot_viz.displays.data.markers.checks import ARROW, TEXT, TRIANGLES
from sambot_viz.geometry import Wxyz, wxyz_rotated

ALPHA = 0.5
STEPS = 36
"""Number of parts of a ring."""
INNER, OUTER = 0.5, 0.65
"""Radii of a ring, by the scale of its marker."""
DARK = 0.6
"""Brightness of the darker parts of a ring."""

_IN, _OUT = 0, 1
Corner = tuple[int, int]
"""A circle, and how many steps ahead on it."""
RingPart = tuple[Corner, Corner, Corner, Corner, Corner, Corner]
"""Two triangles of a ring."""
_SQUARE: RingPart = ((_IN, 0), (_OUT, 0), (_IN, 1), (_OUT, 0), (_OUT, 1), (_IN, 1))
_SLANTED: RingPart = ((_IN, 0), (_OUT, 1), (_IN, 1), (_IN, 1), (_OUT, 1), (_OUT, 2))
_TIP: RingPart = ((_IN, 0), (_OUT, 1), (_IN, 1), (_IN, 1), (_OUT, 1), (_IN, 2))
_BESIDE: RingPart = ((_OUT, -1), (_OUT, 0), (_IN, -1), (_OUT, 0), (_OUT, 1), (_IN, 1))
_PARTS: Mapping[int, tuple[RingPart, RingPart]] = {
    MOVE_PLANE: (_SQUARE, _SQUARE),
    ROTATE_AXIS: (_SLANTED, _SLANTED),
    MOVE_ROTATE: (_TIP, _BESIDE),
}
"""The shapes of every other part of a ring."""


def handles(
    mode: int, scale: float, wxyz: Wxyz, description: str
) -> Sequence[ControlMarker]:
    """Return the handles of a control, in the frame of its interactive marker.

    Args:
        mode: of interaction; most have handles.
        scale: of the interactive marker [m].
        wxyz: the rotation of the control; its x is the axis.
        description: of the control.
    """
    if mode == MOVE_AXIS:
        return [_arrow(scale * way, abs(scale), wxyz) for way in (1.0, -1.0)]
    if mode in _PARTS:
        return [_ring(mode, scale, wxyz)]
    if mode == MENU and description.strip():
        height = 0.25 * scale
        return [_text(description, height, -0.1 * height, 1.175 * scale)]
    return ()


def title(description: str, scale: float) -> ControlMarker:
    """Return the text above an interactive marker, in a frame that faces the view."""
    return _text(description, 0.15 * scale, 0.0, 1.4 * scale)


def default_color(wxyz: Wxyz) -> Color:
    """Return the colour of a handle: of an axis along x red, y green, z blue."""
    x, y, z = (abs(value) for value in wxyz_rotated(wxyz, (1.0, 0.0, 0.0)))
    most = max(x, y, z)
    return Color(x / most, y / most, z / most, ALPHA)


def _arrow(way: float, scale: float, wxyz: Wxyz) -> ControlMarker:
    return ControlMarker(
        ARROW,
        Pose(orientation=turn_of(wxyz)),
        Xyz(0.15 * scale, 0.25 * scale, 0.2 * scale),
        default_color(wxyz),
        (Xyz(0.5 * way), Xyz(0.9 * way)),
    )


def _ring(mode: int, scale: float, wxyz: Wxyz) -> ControlMarker:
    """Return a ring about x, whose parts are dark and bright if it turns."""
    color = default_color(wxyz)
    colors: list[Color] = []
    for step in range(STEPS):
        # RViz's bright parts of a ring that also moves keep the alpha of the handle.
        alpha = ALPHA if mode == MOVE_ROTATE and step % 2 else 1.0
        r, g, b = ((1.0 if step % 2 else DARK) * value for value in color[:3])
        colors += [Color(r, g, b, alpha)] * 2
    return ControlMarker(
        TRIANGLES,
        Pose(orientation=turn_of(wxyz)),
        Xyz(scale, scale, scale),
        color,
        _ring_points(mode),
        () if mode == MOVE_PLANE else colors,
    )


@cache
def _ring_points(mode: int) -> Sequence[Xyz]:
    angles = [2 * math.pi * step / STEPS for step in range(STEPS)]
    circles = [
        [Xyz(0.0, radius * math.cos(a), radius * math.sin(a)) for a in angles]
        for radius in (INNER, OUTER)
    ]
    return tuple(
        circles[circle][(step + ahead) % STEPS]
        for step in range(STEPS)
        for circle, ahead in _PARTS[mode][step % 2]
    )


def _text(text: str, height: float, x: float, z: float) -> ControlMarker:
    size = Xyz(height, height, height)
    return ControlMarker(TEXT, Pose(Xyz(x, 0.0, z)), size, text=text)
