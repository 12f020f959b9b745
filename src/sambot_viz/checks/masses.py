"""Links that are heavier than any metal: their mass is in grams."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.checks.rule import Subject, number
from sambot_viz.errors import Problem
from sambot_viz.robot.parts import Box, Capsule, Cylinder, Geometry, Link, Sphere

_DENSEST = 25_000.0
"""More than osmium, 22,600 kg/m³, the densest metal."""
_TIMES = 2.0
"""So many times the mass of all other links; small shapes stand for large parts."""
_LIGHT = 1.0
"""A mass that is less may be meant [kg]."""


def masses_in_grams(subject: Subject) -> Iterator[Problem]:
    """Report the links that make the robot heavy, and are too small for their mass."""
    masses = {
        link.name: link.inertial.mass
        for link in subject.robot.links.values()
        if link.inertial is not None
    }
    dense = {
        name: mass
        for name, mass in masses.items()
        if mass > _LIGHT and mass > _DENSEST * _volume(subject.robot.links[name])
    }
    if sum(dense.values()) <= _TIMES * (sum(masses.values()) - sum(dense.values())):
        return
    # A mass with its unit is read without it, and that is the finding.
    cut = [p.message for p in subject.robot.problems if p.code == "sdf-number-cut-off"]
    for name, mass in dense.items():
        if any(f"of link {name}:" in message for message in cut):
            continue
        inertial = subject.robot.links[name].inertial
        yield Problem.at(
            inertial.place if inertial else None,
            "warning",
            "mass-in-grams",
            f"link {name} has a mass of {number(mass)} kg and is too small for it, "
            "even of metal: it is probably given in grams",
            f"write {number(mass / 1000.0)}, and the moments of inertia of that mass",
        )


def _volume(link: Link) -> float:
    """Return how much room the shapes of a link have [m³]; inf when that is unknown."""
    shapes = link.collisions or link.visuals
    volumes = [_volume_of(shape.geometry) for shape in shapes]
    return sum(volumes) if volumes else math.inf


def _volume_of(geometry: Geometry) -> float:
    match geometry:
        case Box(size):
            return abs(math.prod(size))
        case Sphere(radius):
            return 4 / 3 * math.pi * radius**3
        case Cylinder(radius, length):
            return math.pi * radius**2 * length
        case Capsule(radius, length):
            return math.pi * radius**2 * (length + 4 / 3 * radius)
        case _:
            return math.inf
