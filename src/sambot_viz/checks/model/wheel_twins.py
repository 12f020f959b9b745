"""Report a wheel that differs from its twin on the other side in one property."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from sambot_viz.checks.clues import Clues, guess
from sambot_viz.checks.model.side_of_call import lost_bracket
from sambot_viz.checks.rule import Subject, axis_text, number
from sambot_viz.checks.wheel_clues import is_rotor, shapes_of
from sambot_viz.edits import exchange_parts, write_part
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.geometry import Vector3, dot
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Cylinder, Joint, Shape, Sphere
from sambot_viz.robot.slips.twin_names import LEFT
from sambot_viz.robot.slips.wheel_names import WHEEL

_TO_RIGHT = (("left", "right"), ("Left", "Right"), ("l(?!eft)", "r"), ("L(?!eft)", "R"))
"""Left → right: words in the names of twins."""
_CODE = "wheel-unlike-twin"
_OFF = 0.02
"""Relative difference below which lengths are equal."""
_ALONG = 0.99
"""Smallest cosine between two equal directions (8°)."""


class _Twins(NamedTuple):
    """Two wheels whose names differ only in the side, the left one first."""

    robot: Robot
    left: Joint
    right: Joint

    def axis(self, joint: Joint) -> Vector3:
        return self.robot.at_start[joint.child].turned(joint.axis)

    def radius(self, joint: Joint) -> float | None:
        """Return the radius of the only shape of a wheel [m]."""
        shapes = shapes_of(self.robot, joint.child)
        geometry = shapes[0].geometry if len(shapes) == 1 else None
        round_ = isinstance(geometry, (Cylinder, Sphere))
        return geometry.radius if round_ else None


def unlike_twins(subject: Subject) -> Iterator[Problem]:
    """Report pairs of wheels that differ in rotation, place or size.

    The names show that the two are twins. Where everything else is equal, the
    difference is a slip. Other wheels decide which of the two is wrong.
    """
    for twins in _pairs(subject.robot):
        if twins.left.place == twins.right.place:
            yield from _not_mirrored(twins, subject.files)
            continue
        found = [p for look in _LOOKS for p in look(twins)]
        if len(found) == 1:
            yield found[0]


def _pairs(robot: Robot) -> Iterator[_Twins]:
    for left in robot.joints.values():
        pattern = LEFT.search(left.name)
        if pattern is None or not _is_wheel(left):
            continue
        before, after = left.name[: pattern.start()], left.name[pattern.end() :]
        sides = (re.sub(*pair, pattern[0]) for pair in _TO_RIGHT)
        names = [before + side + after for side in sides if side != pattern[0]]
        right = next((robot.joints[n] for n in names if n in robot.joints), left)
        if right is left or not _is_wheel(right) or right.parent != left.parent:
            continue
        yield _Twins(robot, left, right)


def _not_mirrored(twins: _Twins, files: Sequence[str]) -> Iterator[Problem]:
    """Report twins of one macro, alike but for the number that their calls give."""
    ys = [twins.robot.at_start[joint.child].position[1] for joint in twins[1:]]
    if abs(ys[0] + ys[1]) <= _OFF * max(map(abs, ys)):
        return
    found = lost_bracket(twins.left, twins.right, files)
    if found is not None:
        place, fix = found
        one, other = twins.left.child, twins.right.child
        yield Problem.at(
            place,
            "warning",
            _CODE,
            f"the wheels {one} and {other} are not on opposite sides: y = "
            f"{number(ys[0])} m and {number(ys[1])} m; the minus in this call is for "
            "the first part only",
            fix,
        )


def _is_wheel(joint: Joint) -> bool:
    names = f"{joint.name} {joint.child}".lower()
    return WHEEL.search(names) is not None and not is_rotor(joint)


def _of_types(twins: _Twins) -> Iterator[Problem]:
    types = {joint.type: joint for joint in twins[1:]}
    if set(types) == {"fixed", "continuous"}:
        joint, other = types["fixed"], types["continuous"]
        yield _problem(
            joint.place,
            f"joint {joint.name} is fixed, and {other.name}, its twin, turns: the "
            f"wheel {joint.child} does not roll",
            'write type="continuous"',
            {"names", "type"},
        )


def _of_axes(twins: _Twins) -> Iterator[Problem]:
    one, other = (twins.axis(joint) for joint in twins[1:])
    if (
        twins.left.type != twins.right.type
        or math.hypot(*one) * math.hypot(*other) < 0.5
    ):
        return
    along = dot(one, other)
    if along > _ALONG:
        return
    wrong, right = _odd(twins, lambda joint: abs(twins.axis(joint)[1]) > _ALONG)
    if along < -_ALONG:
        yield from _turned(twins, wrong, right)
        return
    axes = " and ".join(_text(axis) for axis in (twins.axis(wrong), twins.axis(right)))
    place = wrong.place
    angles = [_largest(joint.origin.rpy) for joint in (wrong, right)]
    if _largest(wrong.axis) != _largest(right.axis) or angles[0] == angles[1]:
        hint: str | Fix = _with_axis(twins, wrong, right)
    else:
        place = wrong.origin.place or wrong.place
        sign = math.copysign(1.0, sum(wrong.origin.rpy))
        rpy = _text([sign * abs(angle) for angle in right.origin.rpy])
        hint = Fix(f'write rpy="{rpy}"', exchange_parts(place, "rpy", *angles))
    yield _problem(
        place,
        f"the wheels {wrong.child} and {right.child} do not turn about one axle: their "
        f"axes are {axes} as the robot stands",
        hint,
        {"names", "axle"},
    )


def _with_axis(twins: _Twins, wrong: Joint, right: Joint) -> str:
    """Name the axis that turns a wheel as its twin turns."""
    T_wheel_root = twins.robot.at_start[wrong.child].inverse()
    xyz = _text(T_wheel_root.turned(twins.axis(right)))
    return f"write {axis_text(xyz, twins.robot.language)}"


def _largest(values: Vector3) -> int:
    return max(range(3), key=lambda at: abs(values[at]))


def _turned(twins: _Twins, wrong: Joint, right: Joint) -> Iterator[Problem]:
    """Report wheels that turn against each other, with equally oriented joints."""
    if wrong.origin.rpy != right.origin.rpy:
        # Joints that are also turned are often intended.
        return
    if twins.axis(wrong)[1] > 0 or twins.axis(right)[1] > 0:
        wrong, right = sorted((wrong, right), key=lambda joint: twins.axis(joint)[1])
    yield _problem(
        wrong.place,
        f"joint {wrong.name} turns about {_text(wrong.axis)} and {right.name}, its "
        f"twin, about {_text(right.axis)}: at the same speed the wheels turn against "
        "each other",
        _with_axis(twins, wrong, right),
        {"names"},
    )


def _of_places(twins: _Twins) -> Iterator[Problem]:
    one, other = (joint.origin.xyz for joint in twins[1:])
    reach = max(map(abs, (*one, *other)))
    mirrored = (other[0], -other[1], other[2])
    off = [abs(a - b) > _OFF * reach for a, b in zip(one, mirrored, strict=True)]
    # With both on one side, the parent may have its origin at a corner.
    if sum(off) != 1 or one[1] * other[1] >= 0:
        return
    at = off.index(True)
    wrong, fine = _odd(twins, lambda joint: _is_usual(twins, joint, at))
    value = fine.origin.xyz[at] * (-1 if at == 1 else 1)
    values = [*wrong.origin.xyz]
    values[at] = value
    place, name = wrong.origin.place or wrong.place, "xyz"[at]
    yield _problem(
        place,
        f"the wheel {wrong.child} has {name} = {number(wrong.origin.xyz[at])} m, and "
        f"{fine.child}, its twin, {name} = {number(fine.origin.xyz[at])} m: the robot "
        "does not stand or drive straight",
        Fix(
            f'write xyz="{_text(values)}"',
            write_part(place, "xyz", at, number(wrong.origin.xyz[at]), number(value)),
        ),
        {"names", "places"},
    )


def _is_usual(twins: _Twins, joint: Joint, at: int) -> bool:
    """Return whether a third wheel or the drive also has a number."""
    value = abs(joint.origin.xyz[at])
    others = [
        abs(other.origin.xyz[at])
        for other in twins.robot.joints.values()
        if other not in twins and _is_wheel(other) and other.movable
    ]
    if at == 1:
        others += [said / 2 for said in _said(twins.robot, "separation")]
    return any(math.isclose(value, other, rel_tol=_OFF) for other in others)


def _of_sizes(twins: _Twins) -> Iterator[Problem]:
    for kind in ("visuals", "collisions"):
        shapes = [getattr(twins.robot.links[joint.child], kind) for joint in twins[1:]]
        if [len(each) for each in shapes] != [1, 1]:
            continue
        found = _of_shapes(twins, *(each[0] for each in shapes))
        if found is not None:
            yield found
            return


def _of_shapes(twins: _Twins, one: Shape, other: Shape) -> Problem | None:
    shapes = {twins.left: one, twins.right: other}
    sizes = [_size(shape) for shape in (one, other)]
    if (
        sizes[0] == sizes[1]
        or not all(sizes)
        or type(one.geometry) is not type(other.geometry)
    ):
        return None
    radii = _said(twins.robot, "radius") + [
        d / 2 for d in _said(twins.robot, "diameter")
    ]
    wrong, fine = _odd(twins, lambda joint: _fits(twins, joint, shapes[joint], radii))
    named = " ".join(
        f'{name}="{number(value)}"' for name, value in _size(shapes[fine]).items()
    )
    place = shapes[wrong].geometry_place or shapes[wrong].place
    return _problem(
        place,
        f"the wheel {wrong.child} is not made as {fine.child}, its twin: "
        + " ".join(f"{n} {number(v)}" for n, v in _size(shapes[wrong]).items())
        + " and "
        + " ".join(f"{n} {number(v)}" for n, v in _size(shapes[fine]).items()),
        f"write {named}",
        {"names", "size"},
    )


def _fits(twins: _Twins, joint: Joint, shape: Shape, radii: Sequence[float]) -> bool:
    """Return whether a drive or the other shapes of the link have this size."""
    link = twins.robot.links[joint.child]
    others = [s for s in (*link.visuals, *link.collisions) if s is not shape]
    radius = _size(shape).get("radius", 0.0)
    if any(math.isclose(radius, said, rel_tol=_OFF) for said in radii):
        return True
    return any(_size(other).get("radius") == radius for other in others)


def _size(shape: Shape) -> dict[str, float]:
    match shape.geometry:
        case Cylinder(radius, length):
            return {"radius": radius, "length": length}
        case Sphere(radius):
            return {"radius": radius}
        case _:
            return {}


def _said(robot: Robot, what: str) -> list[float]:
    """Return the numbers of the plugins of a robot for its wheels [m]."""
    found: list[float] = []
    for part in robot.gazebo:
        for element in part.iter():
            if element.tag.lower() in (f"wheel_{what}", f"wheel{what}"):
                try:
                    found.append(float(element.text))
                except ValueError:
                    continue
    return found


def _odd(twins: _Twins, is_right: Callable[[Joint], bool]) -> tuple[Joint, Joint]:
    """Return the wrong wheel and its twin; without a clue, the later one is wrong."""
    _, left, right = twins
    if is_right(left) != is_right(right):
        return (right, left) if is_right(left) else (left, right)
    lines = [joint.place.line if joint.place else 0 for joint in (left, right)]
    return (right, left) if lines[1] >= lines[0] else (left, right)


def _problem(
    place: Place | None, message: str, hint: str | Fix, clues: Clues
) -> Problem:
    return guess(place, _CODE, message, hint, clues)


def _text(values: Sequence[float]) -> str:
    return " ".join(f"{round(value, 4) + 0.0:g}" for value in values)


_LOOKS = (_of_types, _of_axes, _of_places, _of_sizes)
