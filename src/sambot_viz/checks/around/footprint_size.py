"""The robot_radius and footprint of Nav2 against the collision shapes."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.place import where
from sambot_viz.checks.rule import number
from sambot_viz.errors import Problem
from sambot_viz.geometry import Matrix
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Box, Cylinder, MeshFile, Shape, Sphere

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_SMALLEST_GAP = 0.03
_SHARE = 0.15
_TOO_LARGE, _TOO_LARGE_WITH_ARM = 2.0, 5.0
"""So many times what the robot needs: less may be meant to keep a distance."""

_STEPS = 16


Points = npt.NDArray[np.float64]
"""Points on the floor (N, 2) [m]."""


class _Reach(NamedTuple):
    """The points of shapes on the floor.

    Attributes:
        points: (N, 2) [m], in the base frame.
        links: the link of each.
        complete: no shape is left out, of those that no arm moves.
    """

    points: Points
    links: list[str]
    complete: bool


def compare(robot: Robot, frame: str, said: Parameter) -> Iterator[Problem]:
    """Report a footprint that the robot does not fit in, or is lost in.

    Args:
        robot: the robot.
        frame: the base frame.
        said: the footprint or the radius.
    """
    reach = _reach(robot, frame, visuals=False)
    if not len(reach.points):
        return
    radius = said.fact.number
    polygon = _polygon(said.fact.value) if radius is None else None
    if polygon is not None:
        outside = _outside(polygon, reach.points)
        size = float(_lengths(polygon).max())
    elif radius is not None and radius > 0:
        outside = _lengths(reach.points) - radius
        size = radius
    else:
        return
    farthest = int(outside.argmax())
    place = robot.links[reach.links[farthest]].place
    if outside[farthest] > max(_SMALLEST_GAP, _SHARE * size):
        yield _finding(
            said,
            f"the robot is larger than its {said.name} here: the collision shape of "
            f"{reach.links[farthest]} ({where(place, said.place)}) is "
            f"{number(round(float(outside[farthest]), 3))} m outside, so it may hit "
            "what Nav2 believes to be free",
            _needed(said, reach),
        )
    else:
        yield from _too_large(robot, frame, said, size)


def _too_large(
    robot: Robot, frame: str, said: Parameter, size: float
) -> Iterator[Problem]:
    """Compare with all shapes: a part that is only visible may need the room."""
    reach = _reach(robot, frame, visuals=True)
    lengths = _lengths(reach.points)
    needed = float(lengths.max())
    arm = len(_rigid(robot)) < len(robot.links)
    most = (_TOO_LARGE_WITH_ARM if arm else _TOO_LARGE) * needed
    if reach.complete and size > most:
        place = robot.links[reach.links[int(lengths.argmax())]].place
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
    """Say which value fits the shapes; without an edit, as these may be wrong."""
    if said.name == "robot_radius":
        needed = float(_lengths(reach.points).max())
        right = f"{_outward(needed, math.ceil):g}"
        return f"write {right}"
    xs, ys = reach.points[:, 0], reach.points[:, 1]
    x0, y0 = (
        _outward(float(xs.min()), math.floor),
        _outward(float(ys.min()), math.floor),
    )
    x1, y1 = _outward(float(xs.max()), math.ceil), _outward(float(ys.max()), math.ceil)
    corners = f"[{x1:g}, {y1:g}], [{x1:g}, {y0:g}], [{x0:g}, {y0:g}], [{x0:g}, {y1:g}]"
    right = f"[ {corners} ]"
    return f'write "{right}"'


def _outward(value: float, rounded: Callable[[float], int]) -> float:
    """Round a length to whole centimetres [m]; half a millimetre does not count."""
    return rounded(round(value, 3) * 100) / 100


def _polygon(text: str) -> Points | None:
    """The corners of a footprint [m], (N, 2); None when they are not readable."""
    numbers = [float(n) for n in _NUMBER.findall(text)[:2000]]
    if len(numbers) < 6 or len(numbers) % 2:
        return None
    corners = np.array(list(zip(numbers[::2], numbers[1::2], strict=True)))
    return corners if np.isfinite(corners).all() else None


def _lengths(points: Points) -> Points:
    """Distance of each point from the origin [m]."""
    return np.hypot(points[:, 0], points[:, 1])


def _outside(polygon: Points, points: Points) -> Points:
    """Distance of each point from a polygon [m]; 0 inside."""
    distance = np.full(len(points), np.inf)
    inside = np.zeros(len(points), dtype=bool)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        edge, to = b - a, points - a
        length = float(edge @ edge)
        share = to @ edge / (length or 1.0)
        share = np.minimum(np.maximum(share, 0.0), 1.0)
        distance = np.minimum(distance, _lengths(to - share[:, None] * edge))
        crosses = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        if edge[1]:
            at = a[0] + edge[0] * (points[:, 1] - a[1]) / edge[1]
            inside ^= crosses & (points[:, 0] < at)
    return np.where(inside, 0.0, distance)


def _reach(robot: Robot, frame: str, *, visuals: bool) -> _Reach:
    """Project the shapes that always have the same place onto the floor.

    Args:
        robot: the robot.
        frame: the base frame.
        visuals: the visual shapes as well as the collision shapes.
    """
    poses = robot.forward_kinematics()
    T_frame_root = np.linalg.inv(poses[frame])
    found: list[Points] = []
    links: list[str] = []
    complete = True
    for name in _rigid(robot):
        link = robot.links[name]
        for shape in (*link.collisions, *(link.visuals if visuals else ())):
            points = _points(shape, T_frame_root @ poses[name])
            complete = complete and points is not None
            if points is not None:
                found.append(points)
                links += [name] * len(points)
    points = np.concatenate(found) if found else np.empty((0, 2))
    return _Reach(points, links, complete)


def _rigid(robot: Robot) -> list[str]:
    """The links that no joint moves away: those of arms and lifts are left out."""
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


def _points(shape: Shape, T_frame_link: Matrix) -> Points | None:
    """Points of a shape, (N, 2) in the frame [m]; None for a mesh."""
    geometry = shape.geometry
    T = T_frame_link @ shape.origin.matrix
    turn = np.linspace(0, 2 * np.pi, _STEPS, endpoint=False)
    circle = np.stack([np.cos(turn), np.sin(turn), np.zeros(_STEPS)], axis=1)
    if isinstance(geometry, MeshFile):
        return None
    if isinstance(geometry, Box):
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        local = signs * np.array(geometry.size) / 2
    elif isinstance(geometry, Cylinder):
        rim, half = geometry.radius * circle, [0, 0, geometry.length / 2]
        local = np.concatenate([rim + half, rim - half])
    else:
        half = 0.0 if isinstance(geometry, Sphere) else geometry.length / 2
        ends = T[:2, 3] + np.outer([half, -half], T[:2, 2])
        around = geometry.radius * circle[:, :2]
        return np.concatenate([ends[0] + around, ends[1] + around])
    return (local @ np.transpose(T[:3, :3]) + T[:3, 3])[:, :2]
