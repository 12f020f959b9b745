"""Values that ROS accepts and that are hardly meant: degrees, no size, no colour."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.checks.rule import Subject, number
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.parts import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    MeshFile,
    Origin,
    Sphere,
)

_FULL_TURN = 2 * math.pi + 1e-3
_SMALLEST_LIMIT = 15.0
_LARGEST_LIMIT = 720.0


def _is_round(value: float) -> bool:
    """Tell whether it is a multiple of a half, as people write degrees."""
    return abs(value * 2 - round(value * 2)) < 1e-9


def limits_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Report limits of a revolute joint that only make sense in degrees.

    Below 15 rad (2.4 turns) a round number is more likely a generous limit, and above
    720 it usually means "no limit".
    """
    for joint in subject.robot.joints.values():
        limit = joint.limit
        if joint.type != "revolute" or limit is None:
            continue
        ends = [v for v in (limit.lower, limit.upper) if v]
        if not ends or not _SMALLEST_LIMIT <= max(abs(v) for v in ends):
            continue
        if any(abs(v) > _LARGEST_LIMIT for v in ends):
            continue
        if not all(_is_round(v) and abs(v) > _FULL_TURN for v in ends):
            continue
        yield Problem.at(
            limit.place or joint.place,
            "warning",
            "limit-in-degrees",
            f"joint {joint.name}: the limits {number(limit.lower)} and "
            f"{number(limit.upper)} look like degrees, but URDF uses radians",
            f'write lower="{number(math.radians(limit.lower))}" '
            f'upper="{number(math.radians(limit.upper))}"',
        )


def rpy_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Report an rpy of more than a full turn in round numbers."""
    for joint in subject.robot.joints.values():
        yield from _rpy(joint.origin, joint.place)
    for _, shape in subject.shapes():
        yield from _rpy(shape.origin, shape.place)
    for link in subject.robot.links.values():
        if link.inertial is not None:
            yield from _rpy(link.inertial.origin, link.inertial.place)


def _rpy(origin: Origin, place: Place | None) -> Iterator[Problem]:
    if not any(abs(v) > _FULL_TURN for v in origin.rpy):
        return
    if not all(_is_round(v) for v in origin.rpy):
        return
    written = " ".join(number(v) for v in origin.rpy)
    corrected = " ".join(number(math.radians(v)) for v in origin.rpy)
    yield Problem.at(
        origin.place or place,
        "warning",
        "rpy-in-degrees",
        f'rpy="{written}" looks like degrees, but URDF uses radians',
        f'write rpy="{corrected}"',
    )


def sizes_not_positive(subject: Subject) -> Iterator[Problem]:
    """Report a length of zero or less; RViz draws nothing or the inside."""
    for link, shape in subject.shapes():
        what, values = _lengths(shape.geometry)
        mirrored = isinstance(shape.geometry, MeshFile)
        wrong = [v for v in values if v == 0 or (v < 0 and not mirrored)]
        if not wrong:
            continue
        kind = "zero" if not any(wrong) else "negative"
        written = " ".join(number(v) for v in values)
        yield Problem.at(
            shape.geometry_place or shape.place,
            "warning",
            "size-not-positive",
            f"link {link.name}: the {what} ({written}) contains a {kind} number, so "
            "nothing useful can be drawn",
            "give full lengths in metres, each larger than 0",
        )


def _lengths(geometry: Geometry) -> tuple[str, tuple[float, ...]]:
    if isinstance(geometry, Box):
        return "size of the box", geometry.size
    if isinstance(geometry, Sphere):
        return "radius of the sphere", (geometry.radius,)
    if isinstance(geometry, Cylinder):
        return "radius and length of the cylinder", (geometry.radius, geometry.length)
    if isinstance(geometry, Capsule):
        return "radius and length of the capsule", (geometry.radius, geometry.length)
    return "scale of the mesh", geometry.scale


def invisible_materials(subject: Subject) -> Iterator[Problem]:
    """Report materials whose opacity is 0, each once."""
    reported: set[str] = set()
    for link in subject.robot.links.values():
        for shape in link.visuals:
            material = shape.material
            if material is None or material.rgba is None or material.rgba[3] > 0:
                continue
            if material.name in reported and material.name:
                continue
            reported.add(material.name)
            named = f"the material {material.name} of " if material.name else ""
            yield Problem.at(
                shape.place,
                "info",
                "alpha-zero",
                f"{named}link {link.name} has the alpha 0: it is invisible",
                'the fourth number of rgba is the opacity: write rgba="… … … 1"',
            )
