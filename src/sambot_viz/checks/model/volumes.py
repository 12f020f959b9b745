"""Measure the volume of links by their shapes."""

from __future__ import annotations

import math

from sambot_viz.robot.parts import Box, Capsule, Cylinder, Geometry, Link, Sphere


def volume_of(link: Link) -> float:
    """Return the volume of the shapes of a link [m³]; inf when unknown."""
    shapes = link.collisions or link.visuals
    volumes = [volume_of_shape(shape.geometry) for shape in shapes]
    return sum(volumes) if volumes else math.inf


def volume_of_shape(geometry: Geometry) -> float:
    """Return the volume of a shape [m³]; inf for a mesh."""
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
