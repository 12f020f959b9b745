"""What of a robot touches the ground, when it stands on its lowest points.

The ground is level in the root link: gravity points along its −z. A link touches it
with its collision shapes, or with its visual ones where it has none.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol
from weakref import WeakKeyDictionary

import numpy as np

from sambot_viz.geometry import Matrix
from sambot_viz.robot.kinematics import JointTree
from sambot_viz.robot.parts import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Joint,
    Link,
    MeshFile,
    Shape,
    Sphere,
)

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh

LARGEST_GAP = 0.004
"""Casters are modelled up to so much too high; bodies are higher above ground [m]."""
GAP_SHARE = 0.02
"""A small robot has smaller gaps: this share of its longest side at most."""
FLATNESS = 0.25
"""A foot is flat where it is uneven by less than this share of the largest gap."""
_UPRIGHT = 0.5
"""A cylinder whose axis is steeper (sine of the slope) stands on its end."""
_LEVEL = 0.1
"""The axle of a wheel is at most so steep."""
_ROUND = 0.95
"""A wheel's mesh reaches this share of its radius in every direction."""
_SIDES = 32
"""A round end of a cylinder is taken for a polygon of so many corners."""


class LinkTree(JointTree, Protocol):
    """The parts of a robot that have weight and shape."""

    @property
    def links(self) -> Mapping[str, Link]:
        """The links by name."""
        ...


Meshes = Callable[[MeshFile], "Mesh | None"]
"""Returns what is in a mesh file; None when that is not known."""


@dataclass(frozen=True, slots=True, eq=False)
class Contacts:
    """Where a robot touches the ground.

    Attributes:
        height: of the ground in the root link [m].
        points: by the name of the link, (N, 3) in the root link [m].
        size: the longest side of the robot [m].
    """

    height: float
    points: Mapping[str, Matrix]
    size: float


@dataclass(frozen=True, slots=True, eq=False)
class _PlacedShape:
    """One shape in the root link.

    Attributes:
        link: its name.
        shape: the shape.
        T_root_shape: (4, 4); it has the scale of a mesh in it.
        axle: direction about which the link turns without end; None for no wheel.
        hub: a point of the axle [m].
        corners: of the box around it, (8, 3) in the root link [m].
        mesh: in its file; None for other shapes.
    """

    link: str
    shape: Shape
    T_root_shape: Matrix
    axle: Matrix | None
    hub: Matrix
    corners: Matrix
    mesh: Mesh | None

    @property
    def bottom(self) -> float:
        """No part of it is lower, in the root link [m]."""
        return float(self.corners[:, 2].min())


def contacts(
    robot: LinkTree,
    poses: Mapping[str, Matrix],
    meshes: Meshes,
    gap: float | None = None,
) -> Contacts | None:
    """Find what touches the ground.

    Args:
        robot: the robot.
        poses: link → T_root_link, (4, 4); other links are left out.
        meshes: gives what is in files; what is not known touches nothing.
        gap: what is so much higher than the lowest point touches the ground too [m];
            `LARGEST_GAP` by default, less for a small robot.

    Returns:
        None where no link has a shape.
    """
    bodies = [*_bodies(robot, poses, meshes)]
    if not bodies:
        return None
    corners: Matrix = np.concatenate([body.corners for body in bodies])
    size = float(np.ptp(corners, axis=0).max())
    if gap is None:
        gap = min(LARGEST_GAP, GAP_SHARE * size)
    flat = FLATNESS * min(gap, LARGEST_GAP)
    # A wheel is taken for round: it may reach a little below its corners.
    sag = (1.0 - _ROUND) * size
    found: list[tuple[str, Matrix]] = []
    lowest = math.inf
    for body in sorted(bodies, key=lambda body: body.bottom):
        if body.bottom > lowest + gap + sag:
            break
        points = _foot(body, flat)
        found.append((body.link, points))
        lowest = min(lowest, float(points[:, 2].min()))
    touching: dict[str, list[Matrix]] = {}
    for link, points in found:
        if float(points[:, 2].min()) <= lowest + gap:
            touching.setdefault(link, []).append(points)
    joined = {link: np.concatenate(parts) for link, parts in touching.items()}
    return Contacts(lowest, joined, size)


def _bodies(
    robot: LinkTree, poses: Mapping[str, Matrix], meshes: Meshes
) -> Iterator[_PlacedShape]:
    above = {joint.child: joint for joint in robot.joints.values()}
    for link in robot.links.values():
        T_root_link = poses.get(link.name)
        if T_root_link is None:
            continue
        axle = axle_of(above.get(link.name), T_root_link)
        for shape in link.collisions or link.visuals:
            mesh: Mesh | None = None
            T = T_root_link @ shape.origin.matrix
            if isinstance(shape.geometry, MeshFile):
                mesh = meshes(shape.geometry)
                if mesh is None:
                    continue
                T[:3, :3] *= shape.geometry.scale
            corners = _placed(_box_corners(shape.geometry, mesh), T)
            yield _PlacedShape(
                link.name, shape, T, axle, T_root_link[:3, 3], corners, mesh
            )


def _placed(points: Matrix, T: Matrix) -> Matrix:
    turned: Matrix = points @ np.transpose(T[:3, :3])
    return turned + T[:3, 3]


def axle_of(joint: Joint | None, T_root_link: Matrix) -> Matrix | None:
    """Return the direction of a wheel's axle in the root link, of length 1.

    Args:
        joint: that moves the link; None for the root link.
        T_root_link: (4, 4).

    Returns:
        None where the joint does not turn without end about a level axis.
    """
    if joint is None or not joint.endless:
        return None
    axle: Matrix = T_root_link[:3, :3] @ np.array(joint.axis)
    return axle if any(joint.axis) and abs(float(axle[2])) < _LEVEL else None


def _box_corners(geometry: Geometry, mesh: Mesh | None) -> Matrix:
    """Return the corners of the box around a shape, (8, 3) in the shape [m]."""
    if mesh is not None:
        bounds = _bounds(mesh)
    else:
        half = _half_sides(geometry)
        bounds = np.stack((-half, half))
    return bounds[0] + _CORNERS * (bounds[1] - bounds[0])


_known_bounds: WeakKeyDictionary[Mesh, Matrix] = WeakKeyDictionary()
_known_corners: WeakKeyDictionary[Mesh, Matrix] = WeakKeyDictionary()


def _bounds(mesh: Mesh) -> Matrix:
    """Return the lowest and the highest corner; of a large mesh they take long."""
    if mesh not in _known_bounds:
        _known_bounds[mesh] = mesh.bounds
    return _known_bounds[mesh]


def _corners(mesh: Mesh) -> Matrix:
    """Return all corners of a mesh, each once, (N, 3) [m]."""
    if mesh not in _known_corners:
        parts = np.concatenate([part.vertices for part in mesh.parts])
        _known_corners[mesh] = np.unique(parts, axis=0).astype(np.float64)
    return _known_corners[mesh]


def _half_sides(geometry: Geometry) -> Matrix:
    if isinstance(geometry, Box):
        return np.array(geometry.size) / 2.0
    if isinstance(geometry, Sphere):
        return np.full(3, geometry.radius)
    if isinstance(geometry, Cylinder | Capsule):
        cap = geometry.radius if isinstance(geometry, Capsule) else 0.0
        return np.array((geometry.radius, geometry.radius, geometry.length / 2.0 + cap))
    return np.zeros(3)


def _foot(body: _PlacedShape, flat: float) -> Matrix:
    """Return the lowest points of a shape, (N, 3) in the root link [m]."""
    geometry, T = body.shape.geometry, body.T_root_shape
    if body.mesh is not None:
        return _mesh_foot(body, _placed(_corners(body.mesh), T), flat)
    if isinstance(geometry, Box):
        return _lowest(body.corners, flat)
    if isinstance(geometry, Cylinder):
        return _lowest(_cylinder_points(geometry, T), flat)
    if isinstance(geometry, Capsule):
        ends = np.outer((0.5, -0.5), geometry.length * T[:3, 2])
        return _lowest(_below(T[:3, 3] + ends, geometry.radius), flat)
    radius = geometry.radius if isinstance(geometry, Sphere) else 0.0
    return _below(T[:3, 3][None], radius)


def _below(points: Matrix, height: float) -> Matrix:
    return points - np.array((0.0, 0.0, height))


def _lowest(points: Matrix, flat: float) -> Matrix:
    return points[points[:, 2] <= points[:, 2].min() + flat]


def _cylinder_points(geometry: Cylinder, T: Matrix) -> Matrix:
    """Return the lowest point of each end; all around an end that it stands on."""
    axis: Matrix = T[:3, 2]
    if abs(float(axis[2])) > _UPRIGHT:
        rim: Matrix = geometry.radius * (_CIRCLE @ np.transpose(T[:3, :2]))
    else:
        rim = geometry.radius * _down(axis)[None]
    ends = np.outer((0.5, -0.5), geometry.length * axis)
    return np.reshape(T[:3, 3] + ends[:, None] + rim, (-1, 3))


def _mesh_foot(body: _PlacedShape, points: Matrix, flat: float) -> Matrix:
    line = None if body.axle is None else _wheel_line(points, body.axle, body.hub, flat)
    return _lowest(points, flat) if line is None else line


def _wheel_line(
    points: Matrix, axle: Matrix, hub: Matrix, flat: float
) -> Matrix | None:
    """Return the line below the axle on which a round mesh rolls; None for others.

    It stays the same while the wheel turns; the lowest corner of its mesh does not.
    """
    down = _down(axle)
    frame = np.stack((down, np.cross(axle, down)), axis=1)
    around: Matrix = (points - hub) @ frame
    radii: Matrix = np.linalg.norm(around, axis=1)
    reach: Matrix = np.max(around @ np.transpose(_CIRCLE), axis=0)
    radius = float(radii.max())
    if radius <= 0.0 or float(reach.min()) < _ROUND * radius:
        return None
    along: Matrix = (points[radii >= radius - flat] - hub) @ axle
    ends = np.outer((float(along.min()), float(along.max())), axle)
    return hub + radius * down + ends


def _down(axis: Matrix) -> Matrix:
    """Return the direction at right angles to an axis that is down most, length 1."""
    down: Matrix = axis * float(axis[2]) - np.array((0.0, 0.0, 1.0))
    return down / float(np.linalg.norm(down))


_ANGLES = np.linspace(0.0, 2.0 * math.pi, _SIDES, endpoint=False)
_CIRCLE = np.stack((np.cos(_ANGLES), np.sin(_ANGLES)), axis=1)
_CORNERS = np.array([[corner >> axis & 1 for axis in range(3)] for corner in range(8)])
