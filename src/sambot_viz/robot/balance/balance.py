"""How heavy a robot is, where its centre of mass is, and what it takes to tip it over.

All is in the root link, whose −z is down.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sambot_viz.geometry import Matrix
from sambot_viz.robot.balance.ground import Contacts, LinkTree, Meshes, contacts

WORLD = "world"
"""A robot with this root link is fixed to the world, as in Gazebo."""
SAME_POINT = 1e-6
"""Corners that are nearer to each other are one [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Support:
    """What a robot stands on.

    Attributes:
        height: of the ground [m].
        links: those that touch it.
        polygon: the convex hull of where they do, counter-clockwise from above, (N, 2)
            [m]; two corners are a line, one is a point.
        size: the longest side of the robot [m].
    """

    height: float
    links: tuple[str, ...]
    polygon: Matrix
    size: float


@dataclass(frozen=True, slots=True, eq=False)
class Tipping:
    """The way in which a robot tips over most easily.

    Attributes:
        angle: by which the ground may be tilted [rad]; negative where the robot falls
            over on level ground.
        margin: of the centre of mass to the edge of the support polygon, along the
            ground [m]; negative outside.
        directions: from the polygon across that edge, and across those that are as
            near, (N, 2), of length 1.
    """

    angle: float
    margin: float
    directions: Matrix


@dataclass(frozen=True, slots=True, eq=False)
class Balance:
    """The mass of a robot, and whether it stands, in one pose of its joints.

    Attributes:
        mass: of all links together [kg].
        center: the centre of mass, (3,) [m].
        massless: links that have a shape and no mass, so that they do not count.
        fixed: whether the robot is fixed to the world, and cannot tip over.
        support: what it stands on; None where no link has a shape.
    """

    mass: float
    center: Matrix
    massless: tuple[str, ...]
    fixed: bool
    support: Support | None

    @property
    def tipping(self) -> Tipping | None:
        """The easiest way to tip it over.

        None for a robot that is fixed, and for one that no polygon supports.
        """
        if self.fixed or self.support is None or len(self.support.polygon) < 3:
            return None
        corners = self.support.polygon
        edges: Matrix = np.roll(corners, -1, axis=0) - corners
        outside = np.stack((edges[:, 1], -edges[:, 0]), axis=1)
        outside /= np.linalg.norm(outside, axis=1)[:, None]
        margins: Matrix = ((corners - self.center[:2]) * outside).sum(axis=1)
        margin = float(margins.min())
        height = float(self.center[2]) - self.support.height
        nearest = margins < margin + SAME_POINT
        return Tipping(math.atan2(margin, height), margin, outside[nearest])


def balance(
    robot: LinkTree,
    poses: Mapping[str, Matrix],
    meshes: Meshes,
    gap: float | None = None,
) -> Balance | None:
    """Weigh a robot.

    Args:
        robot: the robot.
        poses: link → T_root_link, (4, 4); links that are not in it are left out.
        meshes: gives what is in files; what is not known supports nothing.
        gap: of what stands on the ground too, as for `contacts` [m].

    Returns:
        None where no link has a mass.
    """
    masses: list[float] = []
    centers: list[Matrix] = []
    massless: list[str] = []
    for link in robot.links.values():
        T_root_link, inertial = poses.get(link.name), link.inertial
        if T_root_link is None:
            continue
        # A mass that no body has is a finding of its own.
        if inertial is None or not 0.0 < inertial.mass < math.inf:
            if link.visuals or link.collisions:
                massless.append(link.name)
            continue
        masses.append(inertial.mass)
        at: Matrix = T_root_link @ np.array((*inertial.origin.xyz, 1.0))
        centers.append(at[:3])
    if not masses:
        return None
    center = np.average(centers, axis=0, weights=masses)
    fixed = robot.root == WORLD
    support = _support(contacts(robot, poses, meshes, gap))
    return Balance(sum(masses), center, tuple(massless), fixed, support)


def _support(found: Contacts | None) -> Support | None:
    if found is None:
        return None
    points = np.concatenate([*found.points.values()])[:, :2]
    links = tuple(found.points)
    return Support(found.height, links, convex_hull(points), found.size)


def convex_hull(points: Matrix) -> Matrix:
    """Return the corners of the convex hull, counter-clockwise from the left, (M, 2).

    Args:
        points: (N, 2), at least one; points on a line give its two ends.
    """
    ordered: list[list[float]] = np.unique(np.round(points, 9), axis=0).tolist()
    # Andrew's monotone chain.
    corners = [*_chain(ordered)[:-1], *_chain(ordered[::-1])[:-1]] or ordered
    return _simplified(np.array(corners))


def _chain(points: Sequence[list[float]]) -> list[list[float]]:
    """Return the corners below points that are sorted along x."""
    chain: list[list[float]] = []
    for point in points:
        while len(chain) > 1 and not _is_left(chain[-2], chain[-1], point):
            chain.pop()
        chain.append(point)
    return chain


def _is_left(a: Sequence[float], b: Sequence[float], c: Sequence[float]) -> bool:
    """Return whether c lies left of the way from a to b."""
    return (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0])


def _simplified(ring: Matrix) -> Matrix:
    """Leave out corners that are on the line between others.

    Only a hull tells them: of points on one line but for a rounding, those that sorting
    puts in the middle may be the ends of it.
    """
    # The corner that is farthest from any is an end, also of a line.
    ring = np.roll(ring, -_farthest(ring, ring[0]), axis=0)
    other = _farthest(ring, ring[0])
    if math.dist(ring[0], ring[other]) <= SAME_POINT:
        return ring[:1]
    there, back = ring[: other + 1], np.concatenate((ring[other:], ring[:1]))
    corners = [*_bends(there)[:-1], *_bends(back)[:-1]]
    left = min(range(len(corners)), key=lambda at: tuple(corners[at]))
    return np.roll(corners, -left, axis=0)


def _farthest(points: Matrix, point: Matrix) -> int:
    return int(np.linalg.norm(points - point, axis=1).argmax())


def _bends(line: Matrix) -> list[Matrix]:
    """Return the ends of a line, and its points that are beside the way between them.

    This is the way of Ramer, Douglas and Peucker.
    """
    start, way = line[0], line[-1] - line[0]
    shares: Matrix = (line - start) @ way / float(way @ way)
    shares = np.minimum(np.maximum(shares, 0.0), 1.0)
    beside: Matrix = np.linalg.norm(line - start - np.outer(shares, way), axis=1)
    most = int(beside.argmax())
    if float(beside[most]) <= SAME_POINT:
        return [start, line[-1]]
    return [*_bends(line[: most + 1])[:-1], *_bends(line[most:])]
