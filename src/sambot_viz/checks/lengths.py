"""Robots as large as houses, whose lengths are in millimetres or centimetres."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from sambot_viz.checks.clues import Clues, guess
from sambot_viz.checks.rule import Subject, number
from sambot_viz.checks.volumes import volume_of
from sambot_viz.errors import Problem
from sambot_viz.geometry import Vector3
from sambot_viz.robot.model import Robot, shapes_of
from sambot_viz.robot.parts import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Link,
    MeshFile,
    Origin,
    Shape,
    Sphere,
)

_HOUSE, _ROOM = 15.0, 4.0
"""Sides of a shape [m]: the longest is longer, and the shortest is longer."""
UNITS = {"centimetres": 0.01, "millimetres": 0.001}
_USUAL = 0.3
"""Usual size of a robot [m], where its joints do not say."""
_NEAR = 0.05
"""Joints that are nearer to each other say nothing of the size of a robot [m]."""
_THINNEST = 0.001
"""No part is thinner [m]."""
_BESIDE = 2.0
"""A shape is so many times larger than the whole robot only in another unit."""
_APART = 5.0
"""Joints are so many times farther from each other only in another unit."""


class _Lengths(NamedTuple):
    """In which unit the lengths of a robot are.

    Attributes:
        unit: its name.
        metres: how many metres it is.
        size: the longest side of the largest shape [m], once it is in metres.
        origins: the origins are in that unit too.
    """

    unit: str
    metres: float
    size: float
    origins: bool

    def has(self, geometry: Geometry) -> bool:
        """Tell whether a shape is in that unit."""
        if isinstance(geometry, MeshFile):
            return False
        longest, shortest = _sides(geometry)
        small = longest <= _BESIDE * self.size
        return not small and shortest * self.metres >= _THINNEST


def lengths_in_another_unit(subject: Subject) -> Iterator[Problem]:
    """Report shapes that are as large as a house on all sides, and those like them.

    One finding for those of the same size. Floors and walls are thin.
    """
    lengths = _lengths_of(subject.robot)
    if lengths is None:
        return
    seen: set[tuple[str, tuple[float, ...]]] = set()
    clues = _clues(subject.robot, lengths)
    for link, shape in subject.shapes():
        what, values = written_lengths(shape.geometry)
        if (what, values) in seen or not lengths.has(shape.geometry):
            continue
        seen.add((what, values))
        written = " ".join(number(v) for v in values)
        better = " ".join(number(v * lengths.metres) for v in values)
        longest, _ = _sides(shape.geometry)
        yield guess(
            shape.geometry_place or shape.place,
            "shape-size",
            f"link {link.name}: the {what} ({written}) makes it {longest:.3g} m "
            f"large: it is probably given in {lengths.unit}",
            f"write metres: {better}",
            clues,
        )
    if lengths.origins:
        yield _far_joint(subject.robot, lengths, clues)


def _clues(robot: Robot, lengths: _Lengths) -> Clues:
    """Return what speaks for another unit: floors and halls neither move nor weigh."""
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


def _far_joint(robot: Robot, lengths: _Lengths, clues: Clues) -> Problem:
    joint = max(robot.joints.values(), key=lambda joint: _reach(joint.origin))
    tag = "pose" if robot.language == "sdf" else "origin"
    return guess(
        joint.origin.place or joint.place,
        "shape-size",
        f"joint {joint.name} is {number(_reach(joint.origin))} m from the origin of "
        f"{joint.parent}: the places are probably given in {lengths.unit}, too",
        f"divide x, y and z of every <{tag}> by {1 / lengths.metres:.0f}",
        clues,
    )


_FOAM = 10.0
"""What is less dense is nothing that robots are made of [kg/m³]."""


def is_lighter_than_foam(link: Link) -> bool:
    """Tell whether a link weighs too little for its shapes."""
    mass = 0.0 if link.inertial is None else link.inertial.mass
    volume = volume_of(link)
    return math.isfinite(volume) and 0 < mass < _FOAM * volume


def robot_in_metres(robot: Robot) -> Robot:
    """Return the robot as it would be with all lengths in metres.

    What a check finds only in the robot as it is follows from the unit.
    """
    lengths = _lengths_of(robot)
    if lengths is None:
        return robot
    links = {name: _scaled_link(link, lengths) for name, link in robot.links.items()}
    joints = robot.joints
    if lengths.origins:
        joints = {
            name: replace(joint, origin=_scaled_origin(joint.origin, lengths))
            for name, joint in joints.items()
        }
    return replace(robot, links=links, joints=joints)


def _lengths_of(robot: Robot) -> _Lengths | None:
    """Return the unit of a robot with a shape like a house; None for others."""
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
    """Return what the numbers of a shape are, and the numbers."""
    if isinstance(geometry, Box):
        return "size of the box", geometry.size
    if isinstance(geometry, Sphere):
        return "radius of the sphere", (geometry.radius,)
    if isinstance(geometry, Cylinder):
        return "radius and length of the cylinder", (geometry.radius, geometry.length)
    if isinstance(geometry, Capsule):
        return "radius and length of the capsule", (geometry.radius, geometry.length)
    return "scale of the mesh", geometry.scale


def _scaled_link(link: Link, lengths: _Lengths) -> Link:
    visuals, collisions = (
        tuple(_scaled_shape(shape, lengths) for shape in shapes)
        for shapes in (link.visuals, link.collisions)
    )
    inertial = link.inertial
    if inertial is not None:
        origin = _scaled_origin(inertial.origin, lengths)
        inertial = replace(inertial, origin=origin)
    return replace(link, visuals=visuals, collisions=collisions, inertial=inertial)


def _scaled_shape(shape: Shape, lengths: _Lengths) -> Shape:
    geometry = shape.geometry
    if lengths.has(geometry):
        geometry = _scaled(geometry, lengths.metres)
    origin = _scaled_origin(shape.origin, lengths)
    return replace(shape, geometry=geometry, origin=origin)


def _scaled(geometry: Geometry, factor: float) -> Geometry:
    match geometry:
        case Box(size):
            return Box(_times(size, factor))
        case Sphere(radius):
            return Sphere(radius * factor)
        case Cylinder(radius, length):
            return Cylinder(radius * factor, length * factor)
        case Capsule(radius, length):
            return Capsule(radius * factor, length * factor)
        case _:
            return geometry


def _scaled_origin(origin: Origin, lengths: _Lengths) -> Origin:
    if not lengths.origins:
        return origin
    return replace(origin, xyz=_times(origin.xyz, lengths.metres))


def _times(values: Vector3, factor: float) -> Vector3:
    x, y, z = values
    return x * factor, y * factor, z * factor
