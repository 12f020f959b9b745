"""What RViz says of a marker that is doubtful or wrong, in its own words."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.data.markers.marker_textures import has_texture, texture_of
from sambot_viz.displays.data.message_numbers import coordinates_of
from sambot_viz.displays.display import Level
from sambot_viz.meshes.textures import TextureError
from sambot_viz.topics.contents.amounts import WITH_POINTS
from sambot_viz.topics.decoding import numbers_of

(
    ARROW,
    CUBE,
    SPHERE,
    CYLINDER,
    LINE_STRIP,
    LINE_LIST,
    CUBE_LIST,
    SPHERE_LIST,
    POINTS,
    TEXT,
    MESH,
    TRIANGLES,
) = range(12)
"""Types of visualization_msgs/Marker."""
SOLIDS = (ARROW, CUBE, SPHERE, CYLINDER)
LISTS = (CUBE_LIST, SPHERE_LIST, POINTS)
LINES = (LINE_STRIP, LINE_LIST)

INVALID = "contains invalid floating point values (nans or infs)"
EMPTY = "Points should not be empty for specified marker type."
_UNNORMALIZED = 0.01
"""RViz takes a squared length that differs more than this from 1 for a mistake."""


@dataclass(frozen=True, slots=True)
class Check:
    """The status of a marker.

    Attributes:
        level: the worst level of its sentences.
        text: all sentences; empty without any.
        is_drawn: whether there is something to draw.
        is_ignored: whether the message is ignored.
    """

    level: Level = "Ok"
    text: str = ""
    is_drawn: bool = True
    is_ignored: bool = False


FINE = Check()


def check_of(marker: Any) -> Check:
    """Return what RViz says of a marker that is to be added."""
    invalid = _invalid(marker)
    if invalid:
        return Check("Error", f"{invalid} {INVALID}", False, True)
    kind = int(marker.type)
    if not ARROW <= kind <= TRIANGLES:
        return Check("Error", f"Unknown marker type: {kind}.", False)
    count, most = len(marker.points), limits.MARKER_POINTS.value
    if count > most:
        text = f"{count:,} points are more than the {most:,} that are drawn"
        return Check("Error", text, False)
    errors, hidden = _errors(marker, kind)
    warnings = [*_warnings(marker, kind)]
    if not errors and not warnings:
        return FINE
    level: Level = "Error" if errors else "Warn"
    return Check(level, " \n".join([*warnings, *errors]), not hidden)


def looks_the_same(marker: Any, before: Any) -> bool:
    """Return whether a marker is in nothing but its pose other than one before.

    It is not, if that is not certain, and where there is something to say of its pose.
    """
    if marker.pose is not before.pose:
        p, q = marker.pose.position, marker.pose.orientation
        norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
        # A comparison with NaN is never true.
        if not (abs(norm - 1.0) <= _UNNORMALIZED and math.isfinite(p.x + p.y + p.z)):
            return False
    # The first of the fields after the pose, which are decoded together.
    if marker.scale is not before.scale or marker.type != before.type:
        return False
    return not marker.frame_locked or (marker.header.frame_id == before.header.frame_id)


def _invalid(marker: Any) -> str:
    """Return which part of a marker has a number that is none."""
    p, q, s, c = (
        marker.pose.position,
        marker.pose.orientation,
        marker.scale,
        marker.color,
    )
    # A sum is finite exactly when all of it is, but for numbers that overflow.
    if math.isfinite(
        p.x + p.y + p.z + q.x + q.y + q.z + q.w + s.x + s.y + s.z + c.r + c.g + c.b
    ) and math.isfinite(c.a):
        return ""
    for name, values in (
        ("Position", (p.x, p.y, p.z)),
        ("Orientation", (q.x, q.y, q.z, q.w)),
        ("Scale", (s.x, s.y, s.z)),
        ("Color", (c.r, c.g, c.b, c.a)),
    ):
        if not all(map(math.isfinite, values)):
            return name
    return ""


def _warnings(marker: Any, kind: int) -> Iterator[str]:
    q, scale = marker.pose.orientation, marker.scale
    if kind != TEXT:
        norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
        if norm == 0.0:
            yield "Uninitialized quaternion, assuming identity."
        elif abs(norm - 1.0) > _UNNORMALIZED:
            yield "Unnormalized quaternion in marker message."
    yield from _about_scale(kind, scale, len(marker.points))
    if kind == TRIANGLES and has_texture(marker):
        try:
            texture_of(marker)
        except TextureError as error:
            yield f"The texture cannot be shown: {error}."
    if kind not in WITH_POINTS or not marker.colors:
        if marker.color.a == 0.0 and not _has_own_colors(marker, kind):
            yield "Marker is fully transparent (color.a is 0.0)."
    elif kind != TRIANGLES and not numbers_of(marker.colors, "a").any():
        yield "All points are fully transparent (colors[].a is 0.0)."
    if kind not in (ARROW, *WITH_POINTS) and len(marker.points):
        yield "Non-empty points array is ignored."
    if kind != TEXT and marker.text:
        yield "Non-empty text is ignored."


def _has_own_colors(marker: Any, kind: int) -> bool:
    """Whether a mesh keeps the colours of its file, which all zeros ask for."""
    c = marker.color
    embedded = kind == MESH and bool(marker.mesh_use_embedded_materials)
    return embedded and c.r == c.g == c.b == 0.0


def _about_scale(kind: int, scale: Any, points: int) -> Iterator[str]:
    if kind in LINES:
        if scale.x == 0.0:
            yield "Width LINE_LIST or LINE_STRIP is 0.0 (scale.x)."
    elif kind == POINTS:
        if scale.x == 0.0 or scale.y == 0.0:
            yield "Width and/or height of POINTS is 0.0 (scale.x, scale.y)."
    elif kind == TEXT:
        if scale.z == 0.0:
            yield "Text height of TEXT_VIEW_FACING is 0.0 (scale.z)."
    elif kind == ARROW and points == 2:
        if scale.x == 0.0 or scale.y == 0.0:
            yield "Scale contains 0.0 in x, y or z."
    elif scale.x == 0.0 or scale.y == 0.0 or scale.z == 0.0:
        yield "Scale contains 0.0 in x, y or z."


def _errors(marker: Any, kind: int) -> tuple[Sequence[str], bool]:
    """Return the fault, and whether nothing is drawn because of it."""
    count, found, hidden = len(marker.points), list[str](), False
    if kind == ARROW and count not in (0, 2):
        found.append("Number of points for an ARROW marker should be either 0 or 2.")
        hidden = count == 1
    elif kind in WITH_POINTS:
        found += _wrong_count(kind, count)
        hidden = bool(found)
        colors = len(marker.colors)
        per_face = kind == TRIANGLES and 3 * colors == count
        if colors not in (0, count) and not per_face:
            found.append("Number of colors doesn't match number of points.")
        if not hidden and not _all_finite(marker.points):
            found.append(f"Points {INVALID}".replace("contains", "contain"))
            hidden = True
    elif kind == TEXT and not str(marker.text).strip():
        found.append("Text is empty or only consists of whitespace.")
        hidden = True
    elif kind == MESH and not marker.mesh_resource:
        found.append("Empty mesh_resource path.")
        hidden = True
    return found, hidden


def _wrong_count(kind: int, count: int) -> Iterator[str]:
    if not count:
        yield EMPTY
    if kind == TRIANGLES and count % 3:
        yield "Number of points should be a multiple of 3 for TRIANGLE_LIST marker."
    if kind == LINE_LIST and count % 2:
        yield "Number of points should be a multiple of 2 for LINE_LIST marker."
    if kind == LINE_STRIP and count < 2:
        yield "At least two points are required for a LINE_STRIP marker."


def _all_finite(points: Sequence[Any]) -> bool:
    with np.errstate(over="ignore"):
        return bool(np.isfinite(np.abs(coordinates_of(points)).sum()))
