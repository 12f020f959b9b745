"""Report a visual or a collision that lacks the origin of its twin."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from sambot_viz.checks.rule import Subject
from sambot_viz.edits import Extent, source_of
from sambot_viz.errors import Fix, Problem
from sambot_viz.geometry import UP, dot
from sambot_viz.robot.parts import Cylinder, Language, Link, Shape, Sphere

_ALONG = 0.99
"""Smallest cosine between two equal directions (8°)."""
_NEAR = 0.01
"""Difference below which angles are equal [rad]."""
_ORIGIN = re.compile(
    r"(?P<blanks>\s*)(?P<origin><(origin|pose)\b(?:[^>]*/>|[^<]*</\3>)"
    r"|<xacro:insert_block\b[^>]*/>)"
)


def lost_origins(subject: Subject) -> Iterator[Problem]:
    """Report a shape without an origin, where the other one of its link is turned.

    Both have the same geometry, so they are meant to be one.
    """
    language = subject.robot.language
    for link in subject.robot.links.values():
        if len(link.visuals) != 1 or len(link.collisions) != 1:
            continue
        shapes = link.visuals[0], link.collisions[0]
        for one, other in (shapes, shapes[::-1]):
            if _lacks(one, other):
                yield _problem(link, one, other, language)


def _lacks(one: Shape, other: Shape) -> bool:
    """Return whether a shape is not turned as an equal one is, and has no origin."""
    if one.geometry != other.geometry or isinstance(one.geometry, Sphere):
        return False
    if one.place is None or any(map(abs, (*one.origin.xyz, *one.origin.rpy))):
        return False
    if one.origin.place not in (None, one.place):
        return False
    if isinstance(one.geometry, Cylinder):
        is_turned = abs(dot(other.origin.pose.turned(UP), UP)) < _ALONG
    else:
        is_turned = any(abs(angle) > _NEAR for angle in other.origin.rpy)
    return is_turned and all(map(_is_quarter, other.origin.rpy))


def _is_quarter(angle: float) -> bool:
    """Return whether an angle is a number of quarter turns, as people mean it."""
    return abs(math.remainder(angle, math.pi / 2)) < _NEAR


def _problem(link: Link, one: Shape, other: Shape, language: Language) -> Problem:
    kinds = ("visual", "collision") if one in link.visuals else ("collision", "visual")
    rpy = " ".join(f"{round(value, 4) + 0.0:g}" for value in other.origin.rpy)
    xyz = " ".join(f"{round(value, 4) + 0.0:g}" for value in other.origin.xyz)
    element = (
        f"<pose>{xyz} {rpy}</pose>"
        if language == "sdf"
        else f'<origin xyz="{xyz}" rpy="{rpy}"/>'
    )
    return Problem.at(
        one.place,
        "warning",
        "shape-origin-missing",
        f"the {kinds[0]} of link {link.name} has the same shape as its {kinds[1]}, "
        f"which is turned by {rpy}, and no origin: what is seen is not what collides",
        _copied(one, other) or f"add {element} into it",
    )


def _copied(one: Shape, other: Shape) -> Fix | None:
    """Return the fix that copies the origin, as it is written, from the other shape."""
    if one.place is None or other.place is None or one.place.file != other.place.file:
        return None
    source = source_of(one.place.file)
    tag = None if source is None else source.tag(source.offset(one.place))
    own = {text for _, text in _written(one)}
    found = [written for written in _written(other) if written[1] not in own]
    if source is None or tag is None or len(found) != 1 or tag.is_empty:
        return None
    blanks, text = found[0]
    edit = source.edit(one.place, Extent(tag.end, tag.end), blanks + text)
    return Fix(f"add {text} into it", (edit,))


def _written(shape: Shape) -> list[tuple[str, str]]:
    """Return what places a shape in its text, with the blanks before."""
    source = None if shape.place is None else source_of(shape.place.file)
    tag = (
        None
        if source is None or shape.place is None
        else source.tag(source.offset(shape.place))
    )
    if source is None or tag is None:
        return []
    end = source.end_of(tag) or tag.end
    return [
        (one["blanks"], one["origin"])
        for one in _ORIGIN.finditer(source.text, tag.end, end)
    ]
