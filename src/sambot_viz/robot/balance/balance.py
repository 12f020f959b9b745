"""A robot's mass, its centre of mass, and the tilt that tips it over.

All coordinates are in the root link, whose −z is down.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from operator import mul

from sambot_viz.geometry import PlainPose, Vector2, Vector3
from sambot_viz.robot.balance.ground import Contacts, LinkTree, Meshes, contacts

WORLD = "world"
"""A robot with this root link is fixed to the world, as in Gazebo."""
SAME_POINT = 1e-6
"""Corners closer together than this count as one [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Support:
    """The support of a robot on the ground.

    Attributes:
        height: height of the ground [m].
        links: links that touch it.
        polygon: convex hull of the contacts, counter-clockwise from above [m]; two
            corners are a line, one is a point.
        size: longest side of the robot [m].
    """

    height: float
    links: tuple[str, ...]
    polygon: tuple[Vector2, ...]
    size: float


@dataclass(frozen=True, slots=True, eq=False)
class Tipping:
    """The easiest way for a robot to tip over.

    Attributes:
        angle: tilt of the ground that the robot withstands [rad]; negative where it
            falls over on level ground.
        margin: distance of the centre of mass from the edge of the support polygon,
            along the ground [m]; negative outside.
        directions: unit vectors out of the polygon across that edge, and across edges
            that are as near.
    """

    angle: float
    margin: float
    directions: tuple[Vector2, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Balance:
    """The mass of a robot, and its stability, in one pose of its joints.

    Attributes:
        mass: mass of all links together [kg].
        center: centre of mass [m].
        massless: links with a shape but without mass, which do not count.
        fixed: whether the robot is fixed to the world and cannot tip over.
        support: its support; None where no link has a shape.
    """

    mass: float
    center: Vector3
    massless: tuple[str, ...]
    fixed: bool
    support: Support | None

    @property
    def tipping(self) -> Tipping | None:
        """The easiest way to tip it over.

        None for a fixed robot, and for one without a support polygon.
        """
        if self.fixed or self.support is None or len(self.support.polygon) < 3:
            return None
        x, y, z = self.center
        corners = self.support.polygon
        edges: list[tuple[float, Vector2]] = []
        for one, other in zip(corners, (*corners[1:], corners[0]), strict=True):
            length = math.dist(one, other)
            outside = (other[1] - one[1]) / length, (one[0] - other[0]) / length
            margin = (one[0] - x) * outside[0] + (one[1] - y) * outside[1]
            edges.append((margin, outside))
        least = min(margin for margin, _ in edges)
        nearest = (way for margin, way in edges if margin < least + SAME_POINT)
        angle = math.atan2(least, z - self.support.height)
        return Tipping(angle, least, tuple(nearest))


def balance(
    robot: LinkTree,
    poses: Mapping[str, PlainPose],
    meshes: Meshes,
    gap: float | None = None,
) -> Balance | None:
    """Weigh a robot.

    Args:
        robot: the robot.
        poses: link → T_root_link; other links are ignored.
        meshes: returns the contents of files; unknown ones support nothing.
        gap: height above the lowest point that still touches, as for `contacts` [m].

    Returns:
        None where no link has a mass.
    """
    masses: list[float] = []
    centers: list[Vector3] = []
    massless: list[str] = []
    for link in robot.links.values():
        T_root_link, inertial = poses.get(link.name), link.inertial
        if T_root_link is None:
            continue
        # A mass that no body can have is a separate finding.
        if inertial is None or not 0.0 < inertial.mass < math.inf:
            if link.visuals or link.collisions:
                massless.append(link.name)
            continue
        masses.append(inertial.mass)
        centers.append(T_root_link.of(inertial.origin.xyz))
    if not masses:
        return None
    mass = sum(masses)
    x, y, z = (
        sum(map(mul, masses, values)) / mass for values in zip(*centers, strict=True)
    )
    fixed = robot.root == WORLD
    support = _support(contacts(robot, poses, meshes, gap))
    return Balance(mass, (x, y, z), tuple(massless), fixed, support)


def _support(found: Contacts | None) -> Support | None:
    if found is None:
        return None
    points = [(x, y) for feet in found.points.values() for x, y, _ in feet]
    links = tuple(found.points)
    return Support(found.height, links, convex_hull(points), found.size)


def convex_hull(points: Iterable[Vector2]) -> tuple[Vector2, ...]:
    """Return the corners of the convex hull, counter-clockwise from the left.

    Args:
        points: at least one; points on a line give its two ends.
    """
    ordered = sorted({(round(x, 9), round(y, 9)) for x, y in points})
    # Andrew's monotone chain.
    corners = [*_chain(ordered)[:-1], *_chain(ordered[::-1])[:-1]] or ordered
    return tuple(_simplified(corners))


def _chain(points: Sequence[Vector2]) -> list[Vector2]:
    """Return the lower corners of points that are sorted along x."""
    chain: list[Vector2] = []
    for point in points:
        while len(chain) > 1 and not _is_left(chain[-2], chain[-1], point):
            chain.pop()
        chain.append(point)
    return chain


def _is_left(a: Vector2, b: Vector2, c: Vector2) -> bool:
    """Return whether c lies left of the line from a to b."""
    return (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0])


def _simplified(ring: list[Vector2]) -> list[Vector2]:
    """Omit corners that lie on the line between others.

    This needs the whole hull: if points lie on one line except for rounding, sorting
    may put the ends of the line in the middle.
    """
    # The corner farthest from any other is an end, also of a line.
    start = _farthest(ring, ring[0])
    ring = ring[start:] + ring[:start]
    other = _farthest(ring, ring[0])
    if math.dist(ring[0], ring[other]) <= SAME_POINT:
        return ring[:1]
    there, back = ring[: other + 1], ring[other:] + ring[:1]
    corners = [*_bends(there)[:-1], *_bends(back)[:-1]]
    left = corners.index(min(corners))
    return corners[left:] + corners[:left]


def _farthest(points: Sequence[Vector2], point: Vector2) -> int:
    return max(range(len(points)), key=lambda at: math.dist(points[at], point))


def _bends(line: Sequence[Vector2]) -> list[Vector2]:
    """Return the ends of a line, and its points that lie off the way between them.

    This is the algorithm of Ramer, Douglas and Peucker.
    """
    (x, y), end = line[0], line[-1]
    ahead, aside = end[0] - x, end[1] - y
    square = ahead * ahead + aside * aside

    def beside(at: int) -> float:
        to_x, to_y = line[at][0] - x, line[at][1] - y
        share = min(max((to_x * ahead + to_y * aside) / square, 0.0), 1.0)
        return math.hypot(to_x - share * ahead, to_y - share * aside)

    most = max(range(len(line)), key=beside)
    if beside(most) <= SAME_POINT:
        return [line[0], end]
    return [*_bends(line[: most + 1])[:-1], *_bends(line[most:])]
