"""Finds the parts of a robot that touch the ground when it stands on its lowest points.

The ground is level in the root link: gravity points along its −z. A link touches it
with its collision shapes, or with its visual ones where it has none.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Protocol

from sambot_viz.geometry import PlainPose, Vector2, Vector3
from sambot_viz.robot.balance.solid_feet import ROUND, half_sides, lowest, solid_foot
from sambot_viz.robot.joint_tree import JointTree
from sambot_viz.robot.parts import Joint, Link, MeshFile, Shape

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh

LARGEST_GAP = 0.004
"""Casters are modelled up to this much too high [m]; bodies are higher above ground."""
GAP_SHARE = 0.02
"""A small robot has smaller gaps: at most this share of its longest side."""
FLATNESS = 0.25
"""A foot counts as flat below this unevenness, as a share of the largest gap."""
_LEVEL = 0.1
"""Largest slope of a wheel's axle."""


class LinkTree(JointTree, Protocol):
    """The parts of a robot that have weight and shape."""

    @property
    def links(self) -> Mapping[str, Link]:
        """The links by name."""
        ...


Meshes = Callable[[MeshFile], "Mesh | None"]
"""Returns the content of a mesh file; None when that is not known."""


@dataclass(frozen=True, slots=True, eq=False)
class Contacts:
    """The contacts of a robot with the ground.

    Attributes:
        height: height of the ground in the root link [m].
        points: link name → contacts in the root link [m].
        size: longest side of the robot [m].
    """

    height: float
    points: Mapping[str, Sequence[Vector3]]
    size: float


@dataclass(frozen=True, slots=True, eq=False)
class _PlacedShape:
    """One shape in the root link.

    Attributes:
        link: name of its link.
        shape: the shape.
        T_root_shape: pose of the shape.
        axle: direction about which the link turns without end; None for no wheel.
        hub: a point of the axle [m].
        corners: corners of its bounding box, in the root link [m].
        mesh: content of its mesh file; None for other shapes.
    """

    link: str
    shape: Shape
    T_root_shape: PlainPose
    axle: Vector3 | None
    hub: Vector3
    corners: Sequence[Vector3]
    mesh: Mesh | None

    @property
    def bottom(self) -> float:
        """Height that no part of it is below, in the root link [m]."""
        return _height(self.corners)

    def foot(self, flat: float) -> Sequence[Vector3]:
        """Return its lowest points, uneven by at most `flat`, in the root link [m]."""
        geometry = self.shape.geometry
        if self.mesh is None or not isinstance(geometry, MeshFile):
            return lowest(solid_foot(geometry, self.T_root_shape), flat)
        from sambot_viz.robot.balance.mesh_feet import mesh_foot

        wheel = None if self.axle is None else (self.axle, self.hub)
        return mesh_foot(self.mesh, geometry.scale, self.T_root_shape, wheel, flat)


def contacts(
    robot: LinkTree,
    poses: Mapping[str, PlainPose],
    meshes: Meshes,
    gap: float | None = None,
) -> Contacts | None:
    """Find the contacts with the ground.

    Args:
        robot: the robot.
        poses: link → T_root_link; other links are ignored.
        meshes: returns the contents of files; unknown ones touch nothing.
        gap: largest height above the lowest point that still touches the ground [m];
            `LARGEST_GAP` by default, less for a small robot.

    Returns:
        None where no link has a shape.
    """
    bodies = [*_bodies(robot, poses, meshes)]
    if not bodies:
        return None
    every = [corner for body in bodies for corner in body.corners]
    size = max(max(values) - min(values) for values in zip(*every, strict=True))
    if gap is None:
        gap = min(LARGEST_GAP, GAP_SHARE * size)
    flat = FLATNESS * min(gap, LARGEST_GAP)
    # A wheel counts as round: it may reach a little below its corners.
    sag = (1.0 - ROUND) * size
    found: list[tuple[str, Sequence[Vector3]]] = []
    ground = math.inf
    for body in sorted(bodies, key=lambda body: body.bottom):
        if body.bottom > ground + gap + sag:
            break
        points = body.foot(flat)
        found.append((body.link, points))
        ground = min(ground, _height(points))
    touching: dict[str, list[Vector3]] = {}
    for link, points in found:
        if _height(points) <= ground + gap:
            touching.setdefault(link, []).extend(points)
    return Contacts(ground, touching, size)


def _height(points: Sequence[Vector3]) -> float:
    return min(z for _, _, z in points)


def _bodies(
    robot: LinkTree, poses: Mapping[str, PlainPose], meshes: Meshes
) -> Iterator[_PlacedShape]:
    above = {joint.child: joint for joint in robot.joints.values()}
    for link in robot.links.values():
        T_root_link = poses.get(link.name)
        if T_root_link is None:
            continue
        axle = axle_of(above.get(link.name), T_root_link)
        for shape in link.collisions or link.visuals:
            mesh: Mesh | None = None
            if isinstance(shape.geometry, MeshFile):
                mesh = meshes(shape.geometry)
                if mesh is None:
                    continue
            T = T_root_link @ shape.origin.pose
            corners = [T.of(corner) for corner in product(*_sides(shape, mesh))]
            yield _PlacedShape(
                link.name, shape, T, axle, T_root_link.position, corners, mesh
            )


def axle_of(joint: Joint | None, T_root_link: PlainPose) -> Vector3 | None:
    """Return the direction of a wheel's axle in the root link, as a unit vector.

    Args:
        joint: joint that moves the link; None for the root link.
        T_root_link: pose of the link.

    Returns:
        None unless the joint turns without end about a level axis.
    """
    if joint is None or not joint.endless:
        return None
    axle = T_root_link.turned(joint.axis)
    return axle if any(joint.axis) and abs(axle[2]) < _LEVEL else None


def _sides(shape: Shape, mesh: Mesh | None) -> tuple[Vector2, Vector2, Vector2]:
    """Return the extent of a shape along its x, y and z [m]."""
    if mesh is not None and isinstance(shape.geometry, MeshFile):
        from sambot_viz.robot.balance.mesh_feet import mesh_sides

        return mesh_sides(mesh, shape.geometry.scale)
    x, y, z = half_sides(shape.geometry)
    return (-x, x), (-y, y), (-z, z)
