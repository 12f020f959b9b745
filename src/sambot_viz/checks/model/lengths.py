"""Report robots as large as houses: their lengths are in millimetres or centimetres."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from sambot_viz.checks.clues import Clues, guess
from sambot_viz.checks.model.volumes import volume_of
from sambot_viz.checks.rule import Subject, number
from sambot_viz.errors import Edit, Fix, Problem
from sambot_viz.robot.model import Robot, shapes_of
from sambot_viz.robot.parts import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Link,
    MeshFile,
    Origin,
    Sphere,
    written_sizes,
)

if TYPE_CHECKING:
    from sambot_viz.checks.model.rewritten import Rewriting

LENGTHS = ("size", "radius", "length")
"""Attributes and elements with the lengths of a shape."""
_HOUSE, _ROOM = 15.0, 4.0
"""Lower bounds for the longest and the shortest side of a huge shape [m]."""
UNITS = {"centimetres": 0.01, "millimetres": 0.001}
_USUAL = 0.3
"""Usual size of a robot [m], where its joints do not show it."""
_NEAR = 0.05
"""Distance of joints below which they do not show the size of a robot [m]."""
_THINNEST = 0.001
"""Lower bound for the thickness of a part [m]."""
_BESIDE = 2.0
"""A shape larger than the whole robot by this factor is in another unit."""
_APART = 5.0
"""Joints farther from each other by this factor are in another unit."""


class _Lengths(NamedTuple):
    """The unit of the lengths of a robot.

    Attributes:
        unit: its name.
        metres: the length of one unit [m].
        size: the longest side of the largest shape [m], once it is in metres.
        origins: the origins also have that unit.
    """

    unit: str
    metres: float
    size: float
    origins: bool

    def has(self, geometry: Geometry) -> bool:
        """Return whether a shape has that unit."""
        if isinstance(geometry, MeshFile):
            return False
        longest, shortest = _sides(geometry)
        small = longest <= _BESIDE * self.size
        return not small and shortest * self.metres >= _THINNEST


def lengths_in_another_unit(subject: Subject) -> Iterator[Problem]:
    """Report shapes as large as a house on all sides, and similar ones.

    Shapes of the same size give one finding. Floors and walls are thin, so they do not
    count.
    """
    lengths = _lengths_of(subject.robot)
    if lengths is None:
        return
    from sambot_viz.checks.model.rewritten import Rewriting

    rewriting = Rewriting(subject.files, lambda length: length * lengths.metres)
    edits: dict[tuple[str, tuple[float, ...]], list[Edit]] = {}
    for _, shape in subject.shapes():
        if lengths.has(shape.geometry):
            of_these = edits.setdefault(written_lengths(shape.geometry), [])
            of_these += rewriting.attributes(shape.geometry_place, *LENGTHS)
    clues = _clues(subject.robot, lengths)
    for link, shape in subject.shapes():
        what, values = written_lengths(shape.geometry)
        of_these = edits.pop((what, values), None)
        if of_these is None:
            continue
        written = " ".join(number(v) for v in values)
        better = " ".join(number(v * lengths.metres) for v in values)
        longest, _ = _sides(shape.geometry)
        yield guess(
            shape.geometry_place or shape.place,
            "shape-size",
            f"link {link.name}: the {what} ({written}) makes it {longest:.3g} m "
            f"large: it is probably given in {lengths.unit}",
            Fix(f"write metres: {better}", tuple(dict.fromkeys(of_these))),
            clues,
        )
    if lengths.origins:
        yield _far_joint(subject, lengths, clues, rewriting)


def _clues(robot: Robot, lengths: _Lengths) -> Clues:
    """Return the clues for another unit: floors and halls neither move nor weigh."""
    clues = {"size"}
    if any(joint.movable for joint in robot.joints.values()):
        clues.add("moving parts")
    if any(
        lengths.has(shape.geometry) and is_lighter_than_foam(link)
        for link in robot.links.values()
        for shape in (*link.visuals, *link.collisions)
    ):
        clues.add("density")
    if robot.joints and not lengths.origins:
        clues.add("places of joints")
    return clues


def _far_joint(
    subject: Subject, lengths: _Lengths, clues: Clues, rewriting: Rewriting
) -> Problem:
    robot = subject.robot
    name = "" if robot.language == "sdf" else "xyz"
    edits = (
        edit
        for origin in _origins(subject)
        for edit in rewriting.attributes(origin.place, name, most=3)
    )
    joint = max(robot.joints.values(), key=lambda joint: _reach(joint.origin))
    tag = "pose" if robot.language == "sdf" else "origin"
    return guess(
        joint.origin.place or joint.place,
        "shape-size",
        f"joint {joint.name} is {number(_reach(joint.origin))} m from the origin of "
        f"{joint.parent}: the places are probably given in {lengths.unit}, too",
        Fix(
            f"divide x, y and z of every <{tag}> by {1 / lengths.metres:.0f}",
            tuple(dict.fromkeys(edits)),
        ),
        clues,
    )


def _origins(subject: Subject) -> Iterator[Origin]:
    """Yield all origins of a robot."""
    yield from (joint.origin for joint in subject.robot.joints.values())
    yield from (shape.origin for _, shape in subject.shapes())
    for link in subject.robot.links.values():
        if link.inertial is not None:
            yield link.inertial.origin


_FOAM = 10.0
"""Lower bound for the density of materials of robots [kg/m³]."""


def is_lighter_than_foam(link: Link) -> bool:
    """Return whether a link weighs too little for its shapes."""
    mass = 0.0 if link.inertial is None else link.inertial.mass
    volume = volume_of(link)
    return math.isfinite(volume) and 0 < mass < _FOAM * volume


def _lengths_of(robot: Robot) -> _Lengths | None:
    """Return the unit of a robot with a shape as large as a house; None for others."""
    largest = 0.0
    for shape in shapes_of(robot):
        if not isinstance(shape.geometry, MeshFile):
            longest, shortest = _sides(shape.geometry)
            if longest > _HOUSE and shortest > _ROOM:
                largest = max(largest, longest)
    if not largest:
        return None
    reach = max((_reach(joint.origin) for joint in robot.joints.values()), default=0.0)
    usual = 2 * reach if _NEAR < reach <= _ROOM else _USUAL
    unit = min(UNITS, key=lambda u: abs(math.log(largest * UNITS[u] / usual)))
    size = largest * UNITS[unit]
    return _Lengths(unit, UNITS[unit], size, reach > max(_ROOM, _APART * size))


def _reach(origin: Origin) -> float:
    """Return the largest of x, y and z [m]."""
    return max(abs(value) for value in origin.xyz)


def _sides(geometry: Geometry) -> tuple[float, float]:
    """Return the longest and the shortest side of a shape [m]."""
    _, values = written_lengths(geometry)
    sides = values if isinstance(geometry, Box) else (2 * values[0], *values[1:])
    return max(sides), min(sides)


def written_lengths(geometry: Geometry) -> tuple[str, tuple[float, ...]]:
    """Return the name of a shape's numbers, and the numbers."""
    return _NUMBERS[type(geometry)], written_sizes(geometry)


_NUMBERS = {
    Box: "size of the box",
    Sphere: "radius of the sphere",
    Cylinder: "radius and length of the cylinder",
    Capsule: "radius and length of the capsule",
    MeshFile: "scale of the mesh",
}
