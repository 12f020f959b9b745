"""Correct the only wrong number of an inertia, where it is certain."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace

from sambot_viz.checks.rule import number
from sambot_viz.edits import Extent, SourceFile, source_of
from sambot_viz.errors import Fix, Place
from sambot_viz.geometry import UP, Vector3
from sambot_viz.robot.parts import Box, Cylinder, Geometry, Inertial, Link, Sphere

_MOMENTS = ("ixx", "iyy", "izz")
_PRODUCTS = ("ixy", "ixz", "iyz")
_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), UP)
_SAME = 0.05
"""Relative difference up to which moments are equal."""
_NEAR = 1e-3
"""Distance up to which centres are equal [m]."""

IsBody = Callable[[Inertial], bool]
"""Returns whether a real body can have an inertia."""


def repaired(link: Link, is_body: IsBody) -> Fix | None:
    """Return the fix for a mass or an inertia that no body has; None if uncertain.

    The fix deletes a superfluous sign, exchanges a moment and a product, or replaces
    the only moment that differs from the moment of the shape.

    Args:
        link: the link, with its inertia.
        is_body: returns whether a real body can have an inertia.
    """
    inertial = link.inertial
    place = inertial.place if inertial is not None else None
    source = source_of(place.file) if place is not None else None
    if inertial is None or place is None or source is None:
        return None
    spans = _spans(source, place)
    for changed in _candidates(link, inertial):
        new = replace(inertial, **changed)
        if new.mass <= 0 or not is_body(new):
            continue
        texts: dict[str, str] = {}
        for name, value in changed.items():
            text = _new_text(source, spans.get(name), getattr(inertial, name), value)
            if text is not None:
                texts[name] = text
        if texts.keys() == changed.keys():
            said = " and ".join(f"{text} for {name}" for name, text in texts.items())
            edits = (source.edit(place, spans[n], text) for n, text in texts.items())
            return Fix(f"write {said}", tuple(edits))
    return None


def _candidates(link: Link, inertial: Inertial) -> list[Mapping[str, float]]:
    """Return possible changes, the likeliest first."""
    found: list[Mapping[str, float]] = []
    negative = [n for n in ("mass", *_MOMENTS) if getattr(inertial, n) < 0]
    if negative:
        return [{name: -getattr(inertial, name) for name in negative}]
    products = [n for n in _PRODUCTS if getattr(inertial, n)]
    empty = [n for n in _MOMENTS if not getattr(inertial, n)]
    if len(products) == len(empty) == 1:
        value = getattr(inertial, products[0])
        found.append({empty[0]: value, products[0]: 0.0})
    shape = _of_shape(link, inertial)
    if shape is not None and not products:
        wrong = {
            name: right
            for name, right in zip(_MOMENTS, shape, strict=True)
            if abs(getattr(inertial, name) - right) > _SAME * right
        }
        if len(wrong) == 1:
            found.append(wrong)
    return found


def _of_shape(link: Link, inertial: Inertial) -> Vector3 | None:
    """Return the moments of the only shape of a link, about the axes of its inertia."""
    shapes = link.collisions or link.visuals
    if len({(shape.geometry, shape.origin) for shape in shapes}) != 1:
        return None
    solid = moments(shapes[0].geometry, inertial.mass)
    T = inertial.origin.pose.inverse() @ shapes[0].origin.pose
    if solid is None or max(map(abs, T.position)) > _NEAR:
        return None
    axes = [
        T.turned(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    ]
    x, y, z = (
        sum(value * axis[at] ** 2 for value, axis in zip(solid, axes, strict=True))
        for at in range(3)
    )
    return x, y, z


def moments(geometry: Geometry, mass: float) -> Vector3 | None:
    """Return the moments of inertia of a full body [kg m²]; None for a mesh."""
    match geometry:
        case Box(size):
            x, y, z = (side * side for side in size)
            return (y + z) * mass / 12, (x + z) * mass / 12, (x + y) * mass / 12
        case Sphere(radius):
            moment = 0.4 * mass * radius**2
            return moment, moment, moment
        case Cylinder(radius, length):
            across = (3 * radius**2 + length**2) * mass / 12
            return across, across, mass * radius**2 / 2
        case _:
            return None


def _spans(source: SourceFile, place: Place) -> dict[str, Extent]:
    """Return where the mass and the six numbers are in an <inertial>."""
    tag = source.tag(source.offset(place))
    end = None if tag is None else source.end_of(tag)
    found: dict[str, Extent] = {}
    if tag is None or end is None:
        return found
    for name in ("mass", *_MOMENTS, *_PRODUCTS):
        attribute = r"<mass\s+value" if name == "mass" else rf"\b{name}"
        pattern = (
            rf"{attribute}\s*=\s*[\"']([^\"']*)[\"']|<{name}>\s*([^<]*?)\s*</{name}>"
        )
        matches = list(re.finditer(pattern, source.text[tag.end : end]))
        if len(matches) == 1:
            group = 1 if matches[0][1] is not None else 2
            start, stop = matches[0].span(group)
            found[name] = Extent(tag.end + start, tag.end + stop)
    return found


def _new_text(
    source: SourceFile, span: Extent | None, value: float, right: float
) -> str | None:
    """Return what to write for a number; None where the file computes it."""
    old = None if span is None else source.text[slice(*span)]
    if old is not None and value == -right and old.startswith("-"):
        return old[1:]
    return None if old is None or "$" in old else number(right)
