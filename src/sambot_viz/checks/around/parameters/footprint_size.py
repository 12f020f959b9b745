"""The robot_radius and footprint of Nav2 against the collision shapes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.parameters.polygon import distance, polygon_of
from sambot_viz.checks.around.place import where
from sambot_viz.checks.rule import number
from sambot_viz.errors import Place, Problem
from sambot_viz.geometry import PlainPose, Vector2, Vector3
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Box, Cylinder, MeshFile, Shape, Sphere

_SMALLEST_GAP = 0.03
_SHARE = 0.15
_TOO_LARGE, _TOO_LARGE_WITH_ARM = 2.0, 5.0
"""Factor over the size of the robot; a lower one may keep a distance on purpose."""

_STEPS = 16
_CIRCLE = tuple(
    (math.cos(2 * math.pi * n / _STEPS), math.sin(2 * math.pi * n / _STEPS))
    for n in range(_STEPS)
)


Points = list[Vector2]
"""Points on the floor [m]."""


class _Reach(NamedTuple):
    """The points of shapes on the floor.

    Attributes:
        points: in the base frame [m].
        links: the link of each.
        complete: it has all shapes that no arm moves.
    """

    points: Points
    links: list[str]
    complete: bool


def compare(robot: Robot, frame: str, said: Parameter) -> Iterator[Problem]:
    """Report a footprint that is too small or much too large for the robot.

    Args:
        robot: the robot.
        frame: the base frame.
        said: the footprint or the radius.
    """
    reach = _reach(robot, frame, visuals=False)
    if not reach.points:
        return
    radius = said.fact.number
    polygon = polygon_of(said.fact.value) if radius is None else None
    if polygon is not None:
        outside = [_outside(polygon, point) for point in reach.points]
        size = max(math.hypot(*corner) for corner in polygon)
    elif radius is not None and radius > 0:
        outside = [math.hypot(*point) - radius for point in reach.points]
        size = radius
    else:
        return
    farthest = outside.index(max(outside))
    place = robot.links[reach.links[farthest]].place
    gap = max(_SMALLEST_GAP, _SHARE * size)
    beyond = {name for name, far in zip(reach.links, outside, strict=True) if far > gap}
    if outside[farthest] > size and 2 * len(beyond) <= len(set(reach.links)):
        yield _far_outside(said, reach.links[farthest], place, outside[farthest])
    elif outside[farthest] > gap:
        yield _finding(
            said,
            f"the robot is larger than its {said.name} here: the collision shape of "
            f"{reach.links[farthest]} ({where(place, said.place)}) is "
            f"{number(round(outside[farthest], 3))} m outside, so it may hit "
            "what Nav2 believes to be free",
            _needed(said, reach),
        )
    else:
        yield from _too_large(robot, frame, said, size)


def _far_outside(
    said: Parameter, link: str, place: Place | None, outside: float
) -> Problem:
    """Report a part farther outside than the footprint reaches, where the rest fits."""
    return Problem.at(
        place,
        "warning",
        "footprint-size",
        f"the collision shape of {link} is {number(round(outside, 3))} m outside of "
        f"the {said.name} ({where(said.place, place)}), which the rest of the robot "
        "fits: one of the two is wrong",
        f"correct the size or the place of {link}, or the footprint and radius of Nav2",
    )


def _too_large(
    robot: Robot, frame: str, said: Parameter, size: float
) -> Iterator[Problem]:
    """Compare with all shapes: a part without a collision shape may need the room."""
    reach = _reach(robot, frame, visuals=True)
    lengths = [math.hypot(*point) for point in reach.points]
    needed = max(lengths)
    arm = len(_rigid(robot)) < len(robot.links)
    most = (_TOO_LARGE_WITH_ARM if arm else _TOO_LARGE) * needed
    if reach.complete and size > most:
        place = robot.links[reach.links[lengths.index(needed)]].place
        yield _finding(
            said,
            f"the {said.name} reaches {number(size)} m, but the shapes of the robot "
            f"only {number(round(needed, 3))} m ({where(place, said.place)}): Nav2 "
            "keeps out of passages that it fits through",
            _needed(said, reach),
        )


def _finding(said: Parameter, message: str, hint: str) -> Problem:
    return Problem.at(said.place, "warning", "footprint-size", message, hint)


def _needed(said: Parameter, reach: _Reach) -> str:
    """Name the value that fits; without an edit, as the shapes may be wrong."""
    if said.name == "robot_radius":
        needed = max(math.hypot(*point) for point in reach.points)
        right = f"{_outward(needed, math.ceil):g}"
        return f"write {right}"
    xs, ys = zip(*reach.points, strict=True)
    x0, y0 = (_outward(min(values), math.floor) for values in (xs, ys))
    x1, y1 = (_outward(max(values), math.ceil) for values in (xs, ys))
    corners = f"[{x1:g}, {y1:g}], [{x1:g}, {y0:g}], [{x0:g}, {y0:g}], [{x0:g}, {y1:g}]"
    right = f"[ {corners} ]"
    return f'write "{right}"'


def _outward(value: float, rounded: Callable[[float], int]) -> float:
    """Round a length to whole centimetres [m]; half a millimetre does not count."""
    return rounded(round(value, 3) * 100) / 100


def _outside(polygon: Points, point: Vector2) -> float:
    """Return the distance of a point from a polygon [m]; 0 inside."""
    away, inside = math.inf, False
    for a, b in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
        away = min(away, distance(point, a, b))
        if (a[1] > point[1]) != (b[1] > point[1]):
            share = (point[1] - a[1]) / (b[1] - a[1])
            inside ^= point[0] < a[0] + (b[0] - a[0]) * share
    return 0.0 if inside else away


def _reach(robot: Robot, frame: str, *, visuals: bool) -> _Reach:
    """Project the shapes that always have the same place onto the floor.

    Args:
        robot: the robot.
        frame: the base frame.
        visuals: include the visual shapes, not only the collision shapes.
    """
    poses = robot.at_start
    T_frame_root = poses[frame].inverse()
    found: Points = []
    links: list[str] = []
    complete = True
    for name in _rigid(robot):
        link = robot.links[name]
        for shape in (*link.collisions, *(link.visuals if visuals else ())):
            points = _points(shape, T_frame_root @ poses[name])
            complete = complete and points is not None
            if points is not None:
                found += points
                links += [name] * len(points)
    return _Reach(found, links, complete)


def _rigid(robot: Robot) -> list[str]:
    """Return the links that no joint moves away, without those of arms and lifts."""
    moved: set[str] = set()
    waiting = [j.child for j in robot.joints.values() if j.type not in _STEADY]
    children: dict[str, list[str]] = {}
    for joint in robot.joints.values():
        children.setdefault(joint.parent, []).append(joint.child)
    while waiting:
        link = waiting.pop()
        if link not in moved:
            moved.add(link)
            waiting += children.get(link, [])
    return [name for name in robot.links if name not in moved]


_STEADY = frozenset({"fixed", "continuous"})


def _points(shape: Shape, T_frame_link: PlainPose) -> Points | None:
    """Return points of a shape in the frame [m]; None for a mesh."""
    geometry = shape.geometry
    T = T_frame_link @ shape.origin.pose
    if isinstance(geometry, MeshFile):
        return None
    if isinstance(geometry, Box):
        x, y, z = (side / 2 for side in geometry.size)
        local = [(i, j, k) for i in (-x, x) for j in (-y, y) for k in (-z, z)]
        return _on_floor(T, local)
    half = 0.0 if isinstance(geometry, Sphere) else geometry.length / 2
    circle = [(geometry.radius * x, geometry.radius * y) for x, y in _CIRCLE]
    if isinstance(geometry, Cylinder):
        return _on_floor(T, [(x, y, z) for z in (half, -half) for x, y in circle])
    ends = _on_floor(T, [(0.0, 0.0, half), (0.0, 0.0, -half)])
    return [(ex + x, ey + y) for ex, ey in ends for x, y in circle]


def _on_floor(T: PlainPose, points: Sequence[Vector3]) -> Points:
    return [T.of(point)[:2] for point in points]
