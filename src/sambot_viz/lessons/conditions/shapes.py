"""Conditions about shapes: sizes, colours, collisions, and what stands on what."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from sambot_viz.checks.rule import number
from sambot_viz.geometry import UP, PlainPose, Rgba, Vector3, dot
from sambot_viz.lessons.conditions.condition import (
    LENGTH,
    Unmet,
    far,
    link_of,
    pose_in,
    vector,
)
from sambot_viz.lessons.reading.records import given
from sambot_viz.lessons.reading.values import (
    NUMBER,
    TEXT,
    TEXTS,
    VECTOR,
    numbers,
    one_of,
)
from sambot_viz.lessons.work import Work
from sambot_viz.robot.balance.solid_feet import half_sides, solid_foot
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import (
    Geometry,
    Link,
    MeshFile,
    Shape,
    Sphere,
    written_sizes,
)

_STRAIGHT = 0.9999


def measured(geometry: Geometry) -> tuple[str, tuple[float, ...]]:
    """Return the element of a shape and its sizes [m]; none for a mesh."""
    if isinstance(geometry, MeshFile):
        return "mesh", ()
    return type(geometry).__name__.lower(), written_sizes(geometry)


def in_words(geometry: Geometry) -> str:
    """Write a shape: "a cylinder of radius 0.1 and length 0.04"."""
    if isinstance(geometry, MeshFile):
        return f"the mesh {geometry.filename}"
    return _words(*measured(geometry))


def _words(kind: str, sizes: Sequence[float]) -> str:
    if kind == "box":
        return f"a box of {vector(sizes)}"
    length = f" and length {number(sizes[1])}" if len(sizes) > 1 else ""
    return f"a {kind} of radius {number(sizes[0])}{length}"


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapeCondition:
    """A link has a shape of some kind, size and pose.

    A cylinder is given by radius and length; `along` is its middle line in the link.
    """

    link: str = given(TEXT)
    of: str = given(one_of("visual", "collision"), "visual")
    box: Vector3 | None = given(VECTOR, None)
    cylinder: tuple[float, ...] | None = given(numbers(2), None)
    sphere: float | None = given(NUMBER, None)
    mesh: str = given(TEXT, "")
    xyz: Vector3 | None = given(VECTOR, None)
    along: Vector3 | None = given(VECTOR, None)
    tolerance: float = given(NUMBER, LENGTH)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Look for one shape of the link that is so; else describe the nearest one."""
        link = link_of(work.robot, self.link)
        shapes = link.visuals if self.of == "visual" else link.collisions
        if not shapes:
            expected = self._size() or f"a <{self.of}>"
            yield Unmet(self._without(link, work.robot), expected, link.place)
            return
        faults = [list(self._faults(link, shape)) for shape in shapes]
        yield from min(faults, key=len)

    def _without(self, link: Link, robot: Robot) -> str:
        """Say what is seen of a link that lacks the shapes."""
        lacks = f"{link.name} has no <{self.of}>"
        if self.of != "visual":
            return lacks
        if not any(each.visuals for each in robot.links.values()):
            return f"{lacks}, and no other link has one: only axes are shown"
        return f"{link.name} is invisible: it has no <visual>"

    def _size(self) -> str:
        if self.mesh:
            return f"the mesh {self.mesh}"
        for kind, sizes in self._sizes():
            return _words(kind, sizes)
        return ""

    def _sizes(self) -> Iterator[tuple[str, tuple[float, ...]]]:
        if self.box is not None:
            yield "box", self.box
        if self.cylinder is not None:
            yield "cylinder", self.cylinder
        if self.sphere is not None:
            yield "sphere", (self.sphere,)

    def _faults(self, link: Link, shape: Shape) -> Iterator[Unmet]:
        geometry, place = shape.geometry, shape.geometry_place or shape.place
        kind, sizes = measured(geometry)
        what = f"the <{self.of}> of {link.name}"
        for wanted, wanted_sizes in self._sizes():
            if kind != wanted or not self._near(sizes, wanted_sizes):
                found = f"{what} is {in_words(geometry)}"
                yield Unmet(found, _words(wanted, wanted_sizes), place)
        is_mesh = isinstance(geometry, MeshFile) and geometry.filename
        if self.mesh and not (is_mesh and is_mesh.endswith(self.mesh)):
            yield Unmet(f"{what} is {in_words(geometry)}", self._size(), place)
        pose = shape.origin.pose
        if self.xyz is not None and far(pose.position, self.xyz) > self.tolerance:
            found = f"{what} is at {vector(pose.position)} in the link"
            yield Unmet(found, f"at {vector(self.xyz)}", shape.place)
        if self.along is not None:
            middle = pose.turned(UP)
            length = math.hypot(*self.along) or 1.0
            if abs(dot(middle, self.along)) / length < _STRAIGHT:
                found = f"the middle line of {what} is along {vector(middle)}"
                yield Unmet(found, f"along {vector(self.along)}", shape.place)

    def _near(self, sizes: Sequence[float], wanted: Sequence[float]) -> bool:
        if len(sizes) != len(wanted):
            return False
        pairs = zip(sizes, wanted, strict=True)
        return all(abs(a - b) <= self.tolerance for a, b in pairs)


@dataclass(frozen=True, slots=True, kw_only=True)
class ColorCondition:
    """A link is seen in a colour, 0 to 1 for red, green, blue and opacity."""

    link: str = given(TEXT)
    rgba: Rgba = given(numbers(4))
    tolerance: float = given(NUMBER, 0.05)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Look for one shape with that colour."""
        link = link_of(work.robot, self.link)
        seen = [s.material.rgba for s in link.visuals if s.material is not None]
        colors = [rgba for rgba in seen if rgba is not None]
        for rgba in colors:
            both = zip(rgba, self.rgba, strict=True)
            if all(abs(a - b) <= self.tolerance for a, b in both):
                return
        found = f"is {vector(colors[0])}" if colors else "has no colour of its own"
        yield Unmet(f"{link.name} {found}", vector(self.rgba), link.place)


@dataclass(frozen=True, slots=True, kw_only=True)
class CollisionCondition:
    """Links have collision shapes that are where the visual ones are."""

    links: tuple[str, ...] = given(TEXTS)
    within: float = given(NUMBER, 0.01)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare the boxes around the shapes of each link."""
        for name in self.links:
            link = link_of(work.robot, name)
            if not link.collisions:
                found = f"{name} has no <collision>"
                yield Unmet(found, "one of the shape that is seen", link.place)
                continue
            seen, hit = _around(link.visuals), _around(link.collisions)
            if seen is None or hit is None:
                continue
            off = max(abs(a - b) for a, b in zip(seen, hit, strict=True))
            if off > self.within:
                yield Unmet(
                    f"the collision shape of {name} is up to {number(1000 * off)} mm "
                    "away from the visual one",
                    f"at most {number(1000 * self.within)} mm",
                    link.collisions[0].place,
                )


def _around(shapes: Sequence[Shape]) -> tuple[float, ...] | None:
    """Return the least and greatest x, y, z of shapes [m]; None where one is a mesh."""
    if not shapes or any(isinstance(s.geometry, MeshFile) for s in shapes):
        return None
    low, high = [math.inf] * 3, [-math.inf] * 3
    for shape in shapes:
        pose, half = shape.origin.pose, half_sides(shape.geometry)
        is_ball = isinstance(shape.geometry, Sphere)
        rows = [pose.turned(axis) for axis in ((1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0))]
        for k in range(3):
            reach = sum(
                abs(row[k]) * side for row, side in zip(rows, half, strict=True)
            )
            reach = half[k] if is_ball else reach
            low[k] = min(low[k], pose.position[k] - reach)
            high[k] = max(high[k], pose.position[k] + reach)
    return (*low, *high)


@dataclass(frozen=True, slots=True, kw_only=True)
class GroundCondition:
    """The lowest points of links are at height 0 of a frame."""

    links: tuple[str, ...] = given(TEXTS)
    frame: str = given(TEXT, "base_footprint")
    tolerance: float = given(NUMBER, LENGTH)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare the height of the lowest point of each link."""
        for name in self.links:
            T_frame_link = pose_in(work.robot, self.frame, name)
            link = link_of(work.robot, name)
            low = lowest_point(link, T_frame_link)
            if low is None:
                yield Unmet(f"{name} has no shape", "one", link.place)
            elif abs(low) > self.tolerance:
                side = "above" if low > 0 else "below"
                found = f"{name} ends {number(1000 * abs(low))} mm {side} {self.frame}"
                yield Unmet(found, f"at the height of {self.frame}", link.place)


def lowest_point(link: Link, T_frame_link: PlainPose) -> float | None:
    """Return the height of the lowest point of a link's shapes in a frame [m]."""
    heights = [
        z
        for shape in (link.visuals or link.collisions)
        if not isinstance(shape.geometry, MeshFile)
        for _, _, z in solid_foot(shape.geometry, T_frame_link @ shape.origin.pose)
    ]
    return min(heights, default=None)
