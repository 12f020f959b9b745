"""The lowest points of boxes, cylinders, spheres and capsules."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

from sambot_viz.geometry import UP, PlainPose, Vector3
from sambot_viz.robot.parts import Box, Capsule, Cylinder, Geometry, Sphere

ROUND = 0.95
"""A wheel's mesh reaches this share of its radius in every direction."""
_UPRIGHT = 0.5
"""A cylinder with a steeper axis (sine of the slope) stands on its end."""
_SIDES = 32
"""Corners of the polygon that represents a round end of a cylinder."""
_ANGLES = [2.0 * math.pi * side / _SIDES for side in range(_SIDES)]
CIRCLE = tuple((math.cos(angle), math.sin(angle)) for angle in _ANGLES)
"""Corners of that polygon, for radius 1."""


def half_sides(geometry: Geometry) -> Vector3:
    """Return how far a shape reaches from its origin along x, y and z [m]."""
    if isinstance(geometry, Box):
        x, y, z = geometry.size
        return x / 2.0, y / 2.0, z / 2.0
    if isinstance(geometry, Sphere):
        return geometry.radius, geometry.radius, geometry.radius
    if isinstance(geometry, Cylinder | Capsule):
        cap = geometry.radius if isinstance(geometry, Capsule) else 0.0
        return geometry.radius, geometry.radius, geometry.length / 2.0 + cap
    return 0.0, 0.0, 0.0


def solid_foot(geometry: Geometry, T_root_shape: PlainPose) -> Sequence[Vector3]:
    """Return points of a shape that include its lowest ones.

    Args:
        geometry: a geometry other than a mesh.
        T_root_shape: pose of the shape.

    Returns:
        Points in the root link [m].
    """
    if isinstance(geometry, Box):
        corners = product(*((-half, half) for half in half_sides(geometry)))
        return [T_root_shape.of((x, y, z)) for x, y, z in corners]
    if isinstance(geometry, Cylinder):
        return _cylinder_points(geometry, T_root_shape)
    radius = geometry.radius if isinstance(geometry, Sphere | Capsule) else 0.0
    half = geometry.length / 2.0 if isinstance(geometry, Capsule) else 0.0
    ends = {T_root_shape.of((0.0, 0.0, end)) for end in (half, -half)}
    return [(x, y, z - radius) for x, y, z in ends]


def lowest(points: Sequence[Vector3], flat: float) -> Sequence[Vector3]:
    """Return the points that are at most `flat` higher than the lowest one."""
    bottom = min(z for _, _, z in points)
    return [point for point in points if point[2] <= bottom + flat]


def down_across(axis: Vector3) -> Vector3:
    """Return the unit vector across an axis that points down most."""
    x, y, z = axis
    down = (x * z, y * z, z * z - 1.0)
    length = math.hypot(*down)
    return down[0] / length, down[1] / length, down[2] / length


def _cylinder_points(geometry: Cylinder, T_root_shape: PlainPose) -> Sequence[Vector3]:
    """Return the lowest point of each end; all around an end that it stands on."""
    axis, radius, half = T_root_shape.turned(UP), geometry.radius, geometry.length / 2.0
    if abs(axis[2]) > _UPRIGHT:
        rim = [(radius * x, radius * y) for x, y in CIRCLE]
    else:
        x, y, _ = T_root_shape.inverse().turned(down_across(axis))
        rim = [(radius * x, radius * y)]
    ends = product(rim, (half, -half))
    return [T_root_shape.of((x, y, z)) for (x, y), z in ends]
