"""Differences between two robots, value by value for each link and joint.

Joints are compared in their parent links, so a moved part counts as one difference, not
as one for each frame below it. Two notations of the same rotation are equal.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from sambot_viz.errors import Place
from sambot_viz.geometry import Vector3, xyzw_from_rpy, xyzw_product
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Inertial,
    Joint,
    Link,
    MeshFile,
    Origin,
    Shape,
    Sphere,
)

Value = str | float | tuple[float, ...] | None
"""A value; None where a robot has none."""
Unit = Literal["", "m", "rad", "kg", "kg m²"]

_THERE = "there"
_SAME = 1e-6
"""Numbers are equal if they differ by less than this, absolutely or relatively."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One value that differs.

    Attributes:
        kind: kind of its owner: "robot", "link" or "joint".
        name: name of that link or joint; "" for the robot.
        what: name of the value: "mass", "origin", "visual 2 size".
        mine: value of the first robot.
        theirs: value of the second robot.
        unit: unit of both.
        apart: distance between the two, if it is a single number [m or rad].
        places: places of the value in the files of the two robots.
    """

    kind: Literal["robot", "link", "joint"]
    name: str
    what: str
    mine: Value
    theirs: Value
    unit: Unit = ""
    apart: float | None = None
    places: tuple[Place | None, Place | None] = (None, None)


@dataclass(frozen=True, slots=True)
class _Fact:
    """A value of a link or joint, to compare with that of another robot."""

    value: Value
    unit: Unit = ""
    is_rotation: bool = False


_Parts = Mapping[str, Mapping[str, _Fact]]
"""Parts of a link or joint → their values; "" for values of the whole."""


def differences(mine: Robot, theirs: Robot) -> list[Difference]:
    """Return the differences between two robots, in the order of the first one's file.

    Parts that only the second robot has come last. Meshes are compared by name, not by
    content.
    """
    names = (("name", mine.name, theirs.name), ("root link", mine.root, theirs.root))
    found = [Difference("robot", "", *each) for each in names if each[1] != each[2]]
    found += _of_parts("link", mine.links, theirs.links, _of_link)
    found += _of_parts("joint", mine.joints, theirs.joints, _of_joint)
    return found


def same_shapes(mine: Link, theirs: Link) -> bool:
    """Return whether two links have the same shapes, whatever their colours."""
    one, other = (
        {str(n): _of_shape(s, with_material=False) for n, s in enumerate(link.visuals)}
        for link in (mine, theirs)
    )
    return not any(_of_values(one, other))


def _of_parts(
    kind: Literal["link", "joint"],
    mine: Mapping[str, Link] | Mapping[str, Joint],
    theirs: Mapping[str, Link] | Mapping[str, Joint],
    parts_of: Callable[[Any], _Parts],
) -> Iterator[Difference]:
    """Compare links or joints by name."""
    for name in dict.fromkeys((*mine, *theirs)):
        one, other = mine.get(name), theirs.get(name)
        places = (one and one.place, other and other.place)
        if one is None or other is None:
            here, there = (None if each is None else _THERE for each in (one, other))
            yield Difference(kind, name, "", here, there, places=places)
            continue
        for what, first, second in _of_values(parts_of(one), parts_of(other)):
            yield Difference(
                kind,
                name,
                what,
                first.value if first else None,
                second.value if second else None,
                (first or second or _Fact(None)).unit,
                _apart(first, second) if first and second else None,
                places,
            )


def _of_values(
    mine: _Parts, theirs: _Parts
) -> Iterator[tuple[str, _Fact | None, _Fact | None]]:
    """Yield the name of each value that differs; a missing part counts as one."""
    for part in dict.fromkeys((*mine, *theirs)):
        facts, others = mine.get(part), theirs.get(part)
        if facts is None or others is None:
            yield part, _summary(facts), _summary(others)
            continue
        for what in dict.fromkeys((*facts, *others)):
            first, second = facts.get(what), others.get(what)
            if first is None or second is None or not _is_same(first, second):
                yield f"{part} {what}".strip(), first, second


def _summary(facts: Mapping[str, _Fact] | None) -> _Fact | None:
    """Return a summary of a part that the other robot does not have."""
    return None if facts is None else facts.get("shape", _Fact(_THERE))


def _is_same(mine: _Fact, theirs: _Fact) -> bool:
    one, other = mine.value, theirs.value
    if isinstance(one, tuple) and isinstance(other, tuple):
        if mine.is_rotation:
            return (_apart(mine, theirs) or 0.0) < _SAME
        pairs = zip(one, other, strict=False)
        return len(one) == len(other) and all(_is_near(a, b) for a, b in pairs)
    if isinstance(one, float) and isinstance(other, float):
        return _is_near(one, other)
    return one == other


def _is_near(one: float, other: float) -> bool:
    return one == other or math.isclose(one, other, rel_tol=_SAME, abs_tol=_SAME**2)


def _apart(mine: _Fact, theirs: _Fact) -> float | None:
    """Return the distance between two values, if it is one length or angle."""
    one, other = mine.value, theirs.value
    if mine.unit not in ("m", "rad"):
        return None
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other)
    if not (isinstance(one, tuple) and isinstance(other, tuple)):
        return None
    if mine.is_rotation:
        a, b = (xyzw_from_rpy(*_three(rpy)) for rpy in (one, other))
        turned = xyzw_product((-a[0], -a[1], -a[2], a[3]), b)
        return 2.0 * math.atan2(math.hypot(*turned[:3]), abs(turned[3]))
    return math.dist(one, other) if len(one) == len(other) else None


def _three(values: Sequence[float]) -> Vector3:
    x, y, z = values
    return x, y, z


def _of_link(link: Link) -> _Parts:
    parts: dict[str, Mapping[str, _Fact]] = {}
    for what, shapes in (("visual", link.visuals), ("collision", link.collisions)):
        for number, shape in enumerate(shapes, 1):
            part = what if number == 1 else f"{what} {number}"
            parts[part] = _of_shape(shape, with_material=what == "visual")
    if link.inertial is not None:
        parts["inertial"] = _of_inertial(link.inertial)
    return parts


def _of_shape(shape: Shape, with_material: bool) -> Mapping[str, _Fact]:
    facts = {**_of_geometry(shape.geometry), **_of_origin(shape.origin)}
    # RViz draws a collision in the colour of the visual.
    if with_material and shape.material is not None:
        facts["colour"] = _Fact(shape.material.rgba)
        if shape.material.texture is not None:
            facts["texture"] = _Fact(shape.material.texture)
    return facts


def _of_geometry(geometry: Geometry) -> Mapping[str, _Fact]:
    match geometry:
        case Box(size):
            return {"shape": _Fact("box"), "size": _Fact(size, "m")}
        case Sphere(radius):
            return {"shape": _Fact("sphere"), "radius": _Fact(radius, "m")}
        case Cylinder(radius, length) | Capsule(radius, length):
            kind = "cylinder" if isinstance(geometry, Cylinder) else "capsule"
            sizes = {"radius": _Fact(radius, "m"), "length": _Fact(length, "m")}
            return {"shape": _Fact(kind), **sizes}
        case MeshFile(filename, scale):
            file = {"mesh": _Fact(filename), "scale": _Fact(scale)}
            return {"shape": _Fact("mesh"), **file}


def _of_origin(origin: Origin) -> Mapping[str, _Fact]:
    return {
        "origin": _Fact(origin.xyz, "m"),
        "rotation": _Fact(origin.rpy, "rad", is_rotation=True),
    }


def _of_inertial(inertial: Inertial) -> Mapping[str, _Fact]:
    of, i = _of_origin(inertial.origin), inertial
    moments = (i.ixx, i.iyy, i.izz, i.ixy, i.ixz, i.iyz)
    return {
        "mass": _Fact(inertial.mass, "kg"),
        **of,
        "ixx iyy izz ixy ixz iyz": _Fact(moments, "kg m²"),
    }


def _of_joint(joint: Joint) -> _Parts:
    own = {
        "type": _Fact(joint.type),
        "parent": _Fact(joint.parent),
        "child": _Fact(joint.child),
        **_of_origin(joint.origin),
    }
    if joint.type not in ("fixed", "floating"):
        own["axis"] = _Fact(joint.axis)
    parts: dict[str, Mapping[str, _Fact]] = {"": own}
    unit: Unit = "m" if joint.type == "prismatic" else "rad"
    limit, soft, mimic = joint.limit, joint.soft_limit, joint.mimic
    if limit is not None and joint.movable:
        force = {"effort": limit.effort, "velocity": limit.velocity}
        parts["limit"] = {name: _Fact(value) for name, value in force.items()}
        if joint.type != "continuous":
            ends = {"lower": limit.lower, "upper": limit.upper}
            parts["limit"] = {
                **{name: _Fact(value, unit) for name, value in ends.items()},
                **parts["limit"],
            }
    if soft is not None:
        ends = {"lower": soft.lower, "upper": soft.upper}
        parts["soft limit"] = {name: _Fact(value, unit) for name, value in ends.items()}
    if mimic is not None:
        parts["mimic"] = {
            "joint": _Fact(mimic.joint),
            "multiplier": _Fact(mimic.multiplier),
            "offset": _Fact(mimic.offset, unit),
        }
    if joint.dynamics is not None:
        braking = {
            "damping": joint.dynamics.damping,
            "friction": joint.dynamics.friction,
        }
        parts["dynamics"] = {name: _Fact(value) for name, value in braking.items()}
    return parts
