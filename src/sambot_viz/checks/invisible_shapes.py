"""Shapes that exist but cannot be seen."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.rule import Subject, number
from sambot_viz.errors import Problem
from sambot_viz.robot.model import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Link,
    MeshFile,
    Robot,
    Shape,
    Sphere,
)


def _shapes(robot: Robot) -> Iterator[tuple[Link, Shape]]:
    for link in robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            yield link, shape


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


def sizes_not_positive(subject: Subject) -> Iterator[Problem]:
    """A shape with a length of zero or less; RViz draws nothing or the inside."""
    for link, shape in _shapes(subject.robot):
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


def invisible_materials(subject: Subject) -> Iterator[Problem]:
    """A material whose opacity is 0; one finding per material."""
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
