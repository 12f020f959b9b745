"""Arrows, cubes, spheres and cylinders of markers as unit shapes."""

from __future__ import annotations

import math
from typing import Any

from sambot_viz.displays.data.markers.checks import ARROW, CUBE, SPHERE
from sambot_viz.displays.data.markers.marker_fields import MarkerPose, alpha_of, rgb_of
from sambot_viz.displays.scene.solid_nodes import Kind, Solid
from sambot_viz.displays.scene.solids import AXIS_WXYZ, Rgb, arrow_wxyz
from sambot_viz.geometry import Vector3, Wxyz, wxyz_product, wxyz_rotated

_TO_X, _TO_Y = AXIS_WXYZ[0], AXIS_WXYZ[1]
"""Rotations that turn z to x, and z to y."""
_SHAFT, _HEAD = 0.77, 0.23
"""Parts of the length of an arrow."""


def solids_of(marker: Any, place: MarkerPose) -> tuple[Solid, ...]:
    """Return the unit shapes of a marker that is a solid."""
    wxyz, at = place.of(marker.pose)
    kind, scale = int(marker.type), marker.scale
    color, alpha = rgb_of(marker.color), alpha_of(marker.color)
    if kind == ARROW:
        if len(marker.points) == 2:
            return _arrow_between(marker, wxyz, at, color, alpha)
        return _arrow_along(scale, wxyz, at, color, alpha)
    if kind == CUBE:
        size = (scale.x, scale.y, scale.z)
        return (Solid("box", wxyz, at, size, color, alpha),)
    if kind == SPHERE:
        # RViz's sphere of markers has its poles on y.
        size = (scale.x, scale.z, scale.y)
        return (Solid("sphere", wxyz_product(wxyz, _TO_Y), at, size, color, alpha),)
    size = (scale.x, scale.y, scale.z)
    return (Solid("cylinder", wxyz, at, size, color, alpha),)


def _arrow_along(
    scale: Any, wxyz: Wxyz, at: Vector3, color: Rgb, alpha: float
) -> tuple[Solid, ...]:
    """An arrow along x of the pose; its sides may differ."""
    shaft, head = _SHAFT * scale.x, _HEAD * scale.x
    turn, ahead = wxyz_product(wxyz, _TO_X), wxyz_rotated(wxyz, (1.0, 0.0, 0.0))
    parts: list[Solid] = []
    for kind, middle, size in _parts(shaft, head):
        wide = 1.0 if kind == "cylinder" else 2.0
        sides = (wide * scale.z, wide * scale.y, size)
        place = _along(at, ahead, middle)
        parts.append(Solid(kind, turn, place, sides, color, alpha))
    return tuple(parts)


def _arrow_between(
    marker: Any, wxyz: Wxyz, at: Vector3, color: Rgb, alpha: float
) -> tuple[Solid, ...]:
    """An arrow from one point to another."""
    begin, end = marker.points
    way = (end.x - begin.x, end.y - begin.y, end.z - begin.z)
    length = math.hypot(*way)
    if not 0.0 < length < math.inf:
        return ()
    scale = marker.scale
    head = min(max(scale.z, 0.0), length) if scale.z else _HEAD * length
    from_origin = wxyz_rotated(wxyz, (begin.x, begin.y, begin.z))
    start = _along(at, from_origin, 1.0)
    turn = wxyz_product(wxyz, arrow_wxyz(way))
    ahead = wxyz_rotated(turn, (0.0, 0.0, 1.0))
    parts: list[Solid] = []
    for kind, middle, size in _parts(length - head, head):
        wide = scale.x if kind == "cylinder" else scale.y
        place = _along(start, ahead, middle)
        parts.append(Solid(kind, turn, place, (wide, wide, size), color, alpha))
    return tuple(parts)


def _parts(shaft: float, head: float) -> tuple[tuple[Kind, float, float], ...]:
    """Shape, place of its middle on the arrow, and length of shaft and head."""
    return (
        ("cylinder", shaft / 2, shaft),
        ("cone", shaft + head / 2, head),
    )


def _along(at: Vector3, ahead: Vector3, far: float) -> Vector3:
    return (at[0] + ahead[0] * far, at[1] + ahead[1] * far, at[2] + ahead[2] * far)
