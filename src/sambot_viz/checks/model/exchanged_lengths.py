"""Report cylinders with exchanged radius and length in one of two places."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.checks.around.place import where
from sambot_viz.checks.rule import Subject, number
from sambot_viz.edits import exchange_attributes
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.robot.parts import Cylinder, Inertial, Link, Shape

_ALIKE = 1e-3


def exchanged_lengths(subject: Subject) -> Iterator[Problem]:
    """Report a cylinder that its link also has with exchanged radius and length.

    Two sources contradict each other: the visual and the collision, or the shape and
    the moments of inertia, which fit the exchanged lengths exactly.
    """
    seen: set[tuple[Place | None, Place | None]] = set()
    for link in subject.robot.links.values():
        made = (link.place, link.inertial.place if link.inertial else None)
        if None in made or made not in seen:
            # A macro makes the same link for each of its calls.
            seen.add(made)
            yield from filter(None, (_of_shapes(link), _of_inertia(link)))


def _only(shapes: tuple[Shape, ...]) -> tuple[Shape, Cylinder] | None:
    geometry = shapes[0].geometry if len(shapes) == 1 else None
    if not isinstance(geometry, Cylinder) or _near(geometry.radius, geometry.length):
        return None
    return shapes[0], geometry


def _of_shapes(link: Link) -> Problem | None:
    seen, hit = _only(link.visuals), _only(link.collisions)
    if seen is None or hit is None:
        return None
    (visual, one), (collision, other) = seen, hit
    if not (_near(one.radius, other.length) and _near(one.length, other.radius)):
        return None
    inertial = link.inertial
    of_visual = inertial is not None and _fits(inertial, one.radius, one.length)
    of_other = inertial is not None and _fits(inertial, other.radius, other.length)
    wrong, beside = (collision, visual) if of_visual else (visual, collision)
    names = ("collision", "visual") if of_visual else ("visual", "collision")
    bad = other if of_visual else one
    place = wrong.geometry_place or wrong.place or link.place
    right = f'radius="{number(bad.length)}" length="{number(bad.radius)}"'
    return Problem.at(
        place,
        "warning",
        "cylinder-exchanged",
        f"the {names[0]} of {link.name} is a cylinder with the radius "
        f"{number(bad.radius)} and the length {number(bad.length)}, and its {names[1]} "
        f"({where(beside.geometry_place or beside.place, place)}) has the two numbers "
        "the other way round",
        Fix(
            f"write {right}, as the inertia has it",
            exchange_attributes(place, "radius", "length") if place else (),
        )
        if of_visual or of_other
        else "exchange radius and length in the one that is wrong",
    )


def _of_inertia(link: Link) -> Problem | None:
    found = _only(link.collisions or link.visuals)
    inertial = link.inertial
    if found is None or inertial is None or inertial.mass <= 0:
        return None
    shape, cylinder = found
    radius, length = cylinder.radius, cylinder.length
    if _fits(inertial, radius, length) or not _fits(inertial, length, radius):
        return None
    place = inertial.call or inertial.place or link.place
    return Problem.at(
        place,
        "warning",
        "cylinder-exchanged",
        f"the moments of inertia of {link.name} are those of a cylinder with the "
        f"radius {number(length)} and the length {number(radius)}, but its shape "
        f"({where(shape.geometry_place or shape.place, place)}) has the two numbers "
        "the other way round",
        "exchange radius and length where the inertia is worked out",
    )


def _fits(inertial: Inertial, radius: float, length: float) -> bool:
    across = inertial.mass / 12 * (3 * radius**2 + length**2)
    along = inertial.mass / 2 * radius**2
    given = sorted((inertial.ixx, inertial.iyy, inertial.izz))
    wanted = sorted((across, across, along))
    return all(_near(a, b) for a, b in zip(given, wanted, strict=True))


def _near(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=_ALIKE)
