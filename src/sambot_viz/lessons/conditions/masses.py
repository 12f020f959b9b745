"""Conditions about masses, moments of inertia and balance."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from sambot_viz.checks.rule import listed, number
from sambot_viz.geometry import PlainPose, Vector3
from sambot_viz.lessons.conditions.condition import Unmet, link_of
from sambot_viz.lessons.conditions.shapes import in_words
from sambot_viz.lessons.reading.records import given
from sambot_viz.lessons.reading.values import NUMBER, TEXT, TEXTS
from sambot_viz.lessons.work import Work
from sambot_viz.robot.parts import (
    Box,
    Cylinder,
    Geometry,
    Inertial,
    Link,
    Shape,
    Sphere,
)

_AXES: tuple[Vector3, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
Tensor = list[list[float]]
"""A (3, 3) matrix of moments of inertia [kg m²]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MassCondition:
    """A link has a mass [kg]; without a link, the whole robot."""

    link: str = given(TEXT, "")
    kg: float = given(NUMBER)
    tolerance: float = given(NUMBER, 0.001)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare the mass."""
        robot = work.robot
        if self.link:
            link = link_of(robot, self.link)
            place, what = link.place, f"the mass of {link.name}"
            mass = link.inertial.mass if link.inertial else 0.0
        else:
            place, what = None, "the mass of the robot"
            mass = sum(x.inertial.mass for x in robot.links.values() if x.inertial)
        if abs(mass - self.kg) > self.tolerance:
            yield Unmet(f"{what} is {number(mass)} kg", f"{number(self.kg)} kg", place)


@dataclass(frozen=True, slots=True, kw_only=True)
class InertiaCondition:
    """The moments of inertia of links are those of a solid of their mass and shape.

    `shape_of` names the link whose shape is taken, where it is another one.
    """

    links: tuple[str, ...] = given(TEXTS)
    shape_of: str = given(TEXT, "")
    tolerance: float = given(NUMBER, 0.01)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare all moments about the axes of the link."""
        for name in self.links:
            link = link_of(work.robot, name)
            shape = _shape(link_of(work.robot, self.shape_of or name))
            inertial = link.inertial
            if inertial is None:
                yield Unmet(f"{name} has no <inertial>", "one", link.place)
            elif shape is not None:
                yield from self._compare(name, inertial, shape)

    def _compare(self, name: str, inertial: Inertial, shape: Shape) -> Iterator[Unmet]:
        wanted = _turned(solid(inertial.mass, shape.geometry), shape.origin.pose)
        found = _turned(_written(inertial), inertial.origin.pose)
        size = max(wanted[k][k] for k in range(3))
        off = max(abs(found[i][k] - wanted[i][k]) for i in range(3) for k in range(3))
        if off > self.tolerance * size:
            yield Unmet(
                f"about x, y, z of {name} the moments of inertia are "
                f"{_diagonal(found)} kg m²",
                f"{_diagonal(wanted)} kg m², those of {in_words(shape.geometry)} of "
                f"{number(inertial.mass)} kg",
                inertial.place,
            )


def _diagonal(tensor: Tensor) -> str:
    return listed(number(tensor[k][k]) for k in range(3))


def _shape(link: Link) -> Shape | None:
    shapes = (*link.collisions, *link.visuals)
    known = (s for s in shapes if isinstance(s.geometry, Box | Cylinder | Sphere))
    return next(known, None)


def _written(inertial: Inertial) -> Tensor:
    i = inertial
    return [[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [i.ixz, i.iyz, i.izz]]


def solid(mass: float, geometry: Geometry) -> Tensor:
    """Return the moments of inertia of a solid about its middle [kg m²]."""
    x = y = z = 0.0
    if isinstance(geometry, Box):
        a, b, c = (side * side for side in geometry.size)
        x, y, z = ((b + c) / 12, (a + c) / 12, (a + b) / 12)
    elif isinstance(geometry, Cylinder):
        r, h = geometry.radius**2, geometry.length**2
        x, y, z = (3 * r + h) / 12, (3 * r + h) / 12, r / 2
    elif isinstance(geometry, Sphere):
        x = y = z = 0.4 * geometry.radius**2
    return [[mass * x, 0.0, 0.0], [0.0, mass * y, 0.0], [0.0, 0.0, mass * z]]


def _turned(tensor: Tensor, pose: PlainPose) -> Tensor:
    """Return R I Rᵀ for the rotation R of a pose."""
    columns = [pose.turned(axis) for axis in _AXES]
    span = range(3)
    return [
        [
            sum(
                columns[a][i] * tensor[a][b] * columns[b][k] for a in span for b in span
            )
            for k in span
        ]
        for i in span
    ]


@dataclass(frozen=True, slots=True, kw_only=True)
class BalanceCondition:
    """The robot stands on its own; the ground may be tilted a little [degrees]."""

    tilt: float = given(NUMBER, 0.0)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Weigh the robot, and tilt the ground."""
        balance = work.robot.balance()
        if balance is None:
            yield Unmet("no link has a mass", "links with an <inertial>")
        elif balance.support is None:
            yield Unmet("no link has a shape to stand on", "wheels, a caster")
        elif not balance.fixed:
            tipping = balance.tipping
            angle = 0.0 if tipping is None else math.degrees(tipping.angle)
            if angle <= self.tilt:
                yield Unmet(
                    f"the robot falls over when the ground is tilted by "
                    f"{number(max(angle, 0.0))}°",
                    f"it stands on ground that is tilted by {number(self.tilt)}°",
                )
