"""The lowest points of a mesh, and the line on which a mesh of a wheel rolls."""

from __future__ import annotations

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import numpy as np

from sambot_viz.geometry import Matrix, PlainPose, Vector2, Vector3, rotation_from_xyzw
from sambot_viz.meshes.mesh import Mesh
from sambot_viz.robot.balance.solid_feet import CIRCLE, ROUND, down_across

_known_bounds: WeakKeyDictionary[Mesh, Matrix] = WeakKeyDictionary()
_known_corners: WeakKeyDictionary[Mesh, Matrix] = WeakKeyDictionary()


def mesh_sides(mesh: Mesh, scale: Vector3) -> tuple[Vector2, Vector2, Vector2]:
    """Return the extent of a mesh along its x, y and z [m]."""
    # The computation takes long for a large mesh.
    if mesh not in _known_bounds:
        _known_bounds[mesh] = mesh.bounds
    low, high = (_known_bounds[mesh] * scale).tolist()
    return (low[0], high[0]), (low[1], high[1]), (low[2], high[2])


def mesh_foot(
    mesh: Mesh,
    scale: Vector3,
    T_root_shape: PlainPose,
    wheel: tuple[Vector3, Vector3] | None,
    flat: float,
) -> Sequence[Vector3]:
    """Return the lowest points of a mesh.

    Args:
        mesh: content of the file.
        scale: factors along x, y and z.
        T_root_shape: pose of the mesh.
        wheel: direction of the axle, and a point on it [m]; None for no wheel.
        flat: limit for the unevenness of the points [m].

    Returns:
        Points in the root link [m].
    """
    R = np.array(rotation_from_xyzw(T_root_shape.xyzw))
    points: Matrix = (_corners(mesh) * scale) @ np.transpose(R) + T_root_shape.position
    line = None if wheel is None else _wheel_line(points, *wheel, flat)
    if line is None:
        line = points[points[:, 2] <= points[:, 2].min() + flat]
    return [(x, y, z) for x, y, z in line.tolist()]


def _corners(mesh: Mesh) -> Matrix:
    """Return all corners of a mesh, each once, (N, 3) [m]."""
    if mesh not in _known_corners:
        parts = np.concatenate([part.vertices for part in mesh.parts])
        _known_corners[mesh] = np.unique(parts, axis=0).astype(np.float64)
    return _known_corners[mesh]


def _wheel_line(
    points: Matrix, axle: Vector3, hub: Vector3, flat: float
) -> Matrix | None:
    """Return the line below the axle on which a round mesh rolls; None for others.

    It stays the same while the wheel turns; the lowest corner of its mesh does not.
    """
    down = np.array(down_across(axle))
    frame = np.stack((down, np.cross(axle, down)), axis=1)
    around: Matrix = (points - hub) @ frame
    radii: Matrix = np.linalg.norm(around, axis=1)
    reach: Matrix = np.max(around @ np.transpose(CIRCLE), axis=0)
    radius = float(radii.max())
    if radius <= 0.0 or float(reach.min()) < ROUND * radius:
        return None
    along: Matrix = (points[radii >= radius - flat] - hub) @ np.array(axle)
    ends = np.outer((float(along.min()), float(along.max())), axle)
    return hub + radius * down + ends
