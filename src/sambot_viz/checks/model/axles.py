"""Report wheels across their axles, and two wheels in one place."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from sambot_viz.checks.clues import guess
from sambot_viz.checks.model.side_of_call import other_side
from sambot_viz.checks.rule import Subject, axis_text, listed, number
from sambot_viz.checks.wheel_clues import is_rotor, wheel_clues
from sambot_viz.edits import overwrite_attribute, put_into, write_part
from sambot_viz.errors import Edit, Fix, Problem
from sambot_viz.geometry import UP, Vector3, cross, dot
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Cylinder, Joint, Language, Shape
from sambot_viz.robot.slips.wheel_names import SWIVELS, WHEEL

_ACROSS = 0.1
"""Largest cosine between two perpendicular directions (84°)."""
_ALONG = 0.99
"""Smallest cosine between two equal directions (8°)."""


def wheels_across_their_axles(subject: Subject) -> Iterator[Problem]:
    """Report wheels that turn end over end, in one finding.

    A wheel turns without limit about a level axis, and all its visuals or all its
    collision shapes are discs. The axis of a swivelling caster is upright. The axis of
    a link is not, when its name means a wheel and not a caster.
    """
    robot = subject.robot
    across: dict[str, tuple[Joint, Shape, Vector3]] = {}
    for joint in robot.joints.values():
        axle = axle_of(joint)
        if axle is None:
            continue
        upright = abs(robot.at_start[joint.child].turned(axle)[2])
        if upright > _ACROSS and (upright < _ALONG or not only_rolls(joint, robot)):
            continue
        link = robot.links[joint.child]
        for shapes in (link.visuals, link.collisions):
            if shapes and all(_is_across(shape, axle) for shape in shapes):
                across.setdefault(link.name, (joint, shapes[0], axle))
    if not across:
        return
    joint, shape, axle = next(iter(across.values()))
    middle = shape.origin.pose.turned(UP)
    along = _through_both_wheels(joint, shape, axle, robot)
    if along is None:
        lies_flat = abs(robot.at_start[joint.child].turned(middle)[2]) > _ACROSS
        along = axle if lies_flat else middle
    advice, edits = list[str](), tuple[Edit, ...]()
    place = joint.place
    if abs(dot(middle, along)) < _ALONG:
        advice.append(_laid_down(shape, along, robot.language))
        edits = _lying(robot, across, shape, along)
        place = shape.place
    if abs(dot(axle, along)) < _ALONG:
        advice.append(_turned_axis(along, robot.language))
    turns = "the wheel {} turns" if len(across) == 1 else "the wheels {} turn"
    clues = {"shape"}.union(
        *(wheel_clues(robot, each) for each, _, _ in across.values())
    )
    yield guess(
        place,
        "wheel-across-axle",
        f"{turns.format(listed(across))} end over end: joint {joint.name} turns "
        f"about {_named(axle)}, but the middle line of the cylinder is along "
        f"{_named(middle)}",
        Fix(", and ".join(advice), () if len(advice) > 1 else edits),
        clues,
    )


def _lying(
    robot: Robot, links: Iterable[str], shape: Shape, axle: Vector3
) -> tuple[Edit, ...]:
    """Return the edits that lay down all shapes with the rotation of one."""
    rpy = _ALONG_AXIS.get(_named(axle), "")
    shapes = (
        s for n in links for s in (*robot.links[n].visuals, *robot.links[n].collisions)
    )
    edits: dict[Edit, None] = {}
    for other in shapes if rpy else ():
        origin = other.origin
        if origin.rpy != shape.origin.rpy:
            continue
        if origin.place is None and robot.language == "urdf":
            added = put_into(other.place, f'<origin xyz="0 0 0" rpy="{rpy}"/>')
        else:
            added = overwrite_attribute(origin.place, "rpy", rpy)
        edits |= dict.fromkeys(added)
    return tuple(edits)


def _through_both_wheels(
    joint: Joint, shape: Shape, axle: Vector3, robot: Robot
) -> Vector3 | None:
    """Return the direction in which another wheel lies, in this wheel's link, or None.

    An axle goes through two wheels. Where another one also lies in front, as with four
    wheels, the axle is across x, the forward direction of the robot. The candidates are
    the axis, the middle line, and the level direction across the axis.
    """
    wheel = robot.at_start[joint.child]
    asked = [wheel.turned(axle), wheel.turned(shape.origin.pose.turned(UP))]
    x, y, z = cross(asked[0], UP)
    length = math.hypot(x, y, z)
    if length > _ACROSS:
        asked.append((x / length, y / length, z / length))
    ways = list(_ways_to_others(joint, shape, robot))
    found = [
        direction
        for direction in asked
        if any(abs(dot(way, direction)) > _ALONG for way in ways)
    ]
    if not found:
        return None
    across = max(found, key=lambda direction: abs(direction[1]))
    return wheel.inverse().turned(across)


def _ways_to_others(joint: Joint, shape: Shape, robot: Robot) -> Iterator[Vector3]:
    """Yield the directions in which wheels of the same size lie, in the root."""
    here = robot.at_start[joint.child].of(shape.origin.xyz)
    for other in robot.joints.values():
        link = robot.links[other.child]
        for found in (link.visuals or link.collisions)[:1]:
            if axle_of(other) is None or not _is_like(found, shape):
                continue
            there = robot.at_start[other.child].of(found.origin.xyz)
            length = math.dist(there, here)
            if length > 0:
                x, y, z = (a - b for a, b in zip(there, here, strict=True))
                yield (x / length, y / length, z / length)


def _is_like(one: Shape, other: Shape) -> bool:
    """Return whether two shapes are discs of the same radius."""
    discs = one.geometry, other.geometry
    return (
        isinstance(discs[0], Cylinder)
        and isinstance(discs[1], Cylinder)
        and abs(discs[0].radius - discs[1].radius) < 0.01 * discs[1].radius
    )


def wheels_in_one_place(subject: Subject) -> Iterator[Problem]:
    """Report a wheel in the place of another one, as when both are on the left.

    Other parts are too, where their names mean two sides, and they move alike.
    """
    robot = subject.robot
    seen: dict[object, Joint] = {}
    for joint in robot.joints.values():
        link = robot.links[joint.child]
        shapes = link.collisions or link.visuals
        is_wheel = axle_of(joint) is not None
        if not shapes:
            continue
        places = tuple((shape.geometry, shape.origin) for shape in shapes)
        ends = joint.limit.ends if joint.limit is not None else None
        moves = () if is_wheel else (joint.type, joint.axis, ends)
        key = (joint.parent, joint.origin, places, is_wheel, moves)
        if is_wheel and all(isinstance(shape.geometry, Cylinder) for shape in shapes):
            # Wheels of two sides may be turned round: their discs look alike.
            key = (joint.parent, *_discs(joint, shapes))
        other = seen.setdefault(key, joint)
        if other is not joint and (is_wheel or _are_sides_of_one(other, joint)):
            yield _in_one_place(other, joint, subject)


def _discs(joint: Joint, shapes: Iterable[Shape]) -> Iterator[object]:
    """Yield the size of cylinders, and the place of their middle in the parent."""
    for shape in shapes:
        middle = joint.origin.pose.of(shape.origin.xyz)
        yield shape.geometry, tuple(round(value, 6) + 0.0 for value in middle)


def _are_sides_of_one(one: Joint, other: Joint) -> bool:
    """Return whether parts are named for two sides, and none moves against another."""
    names = [f"{joint.name} {joint.child}".lower() for joint in (one, other)]
    turned = [j for j in (one, other) if j.mimic is not None and j.mimic.multiplier < 0]
    return not turned and (_are_sides(*names) or _are_sides(*reversed(names)))


def _in_one_place(one: Joint, other: Joint, subject: Subject) -> Problem:
    robot = subject.robot
    x, y, z = one.origin.xyz
    written = _numbers((x, -y, z))
    wrong = _on_wrong_side(one, other)
    both = [f"{joint.name} {joint.child}".lower() for joint in (one, other)]
    element = "<pose>" if robot.language == "sdf" else "<origin>"
    parts = "links" if axle_of(one) is None else "wheels"
    side = f"{written} in its {element}"
    if one.origin.place == other.origin.place:
        side += ", or -1 for 1 in the call of the macro"
    place, fix = other_side(one, other, subject.files) or (
        other.place,
        Fix(
            f"give one of {one.name} and {other.name} the other side: {side}",
            write_part(wrong.origin.place, "xyz", 1, f"{y}", number(-y))
            if one.origin.place != other.origin.place
            else (),
        ),
    )
    return guess(
        place,
        "wheels-in-one-place",
        f"the {parts} {one.child} and {other.child} are in the same place of "
        f"{one.parent}, at {_numbers(one.origin.xyz)}: one hides the other",
        fix,
        {"place"}
        | (wheel_clues(robot, one) & {"name", "drive"})
        | {"sides" for names in (both, reversed(both)) if _are_sides(*names)},
    )


def _on_wrong_side(one: Joint, other: Joint) -> Joint:
    """Return the one of two wheels on the wrong side for its name, else the later."""
    side = "right" if one.origin.xyz[1] > 0 else "left"
    return one if side in f"{one.name} {one.child}".lower() else other


def _are_sides(one: str, other: str) -> bool:
    """Return whether names mean the left and the right side."""
    return "left" in one and "right" in other


def axle_of(joint: Joint) -> Vector3 | None:
    """Return the unit axis of a joint without limits, in the child link."""
    if joint.type not in ("continuous", "revolute") or is_rotor(joint):
        return None
    if joint.limit is not None and joint.limit.ends != (None, None):
        return None
    x, y, z = joint.axis
    length = math.hypot(x, y, z)
    return (x / length, y / length, z / length) if length > 0 else None


def only_rolls(joint: Joint, robot: Robot) -> bool:
    """Return whether a link at the end of the tree is a wheel that does not swivel."""
    names = f"{joint.name} {joint.child}".lower()
    at_end = all(other.parent != joint.child for other in robot.joints.values())
    wheel = WHEEL.search(joint.child.lower())
    return at_end and wheel is not None and not SWIVELS.search(names)


def _is_across(shape: Shape, axle: Vector3) -> bool:
    """Return whether a shape is a disc whose middle line is across the axle."""
    disc = shape.geometry
    if not isinstance(disc, Cylinder) or disc.length > disc.radius:
        return False
    return abs(dot(shape.origin.pose.turned(UP), axle)) < _ACROSS


_ALONG_AXIS = {"x": "0 1.5708 0", "y": "1.5708 0 0", "z": "0 0 0"}
"""Axis → the rotation of a cylinder along it."""
_UNITS = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}


def _named(direction: Vector3) -> str:
    """Name a direction: "y", or its numbers for one between x, y and z."""
    for name, part in zip("xyz", direction, strict=True):
        if abs(part) > _ALONG:
            return name
    return _numbers(direction)


def _numbers(values: Vector3) -> str:
    return " ".join(f"{round(value, 4) + 0.0:g}" for value in values)


def _laid_down(shape: Shape, axle: Vector3, language: Language) -> str:
    """Name the rotation that lays a cylinder along its axle."""
    rpy = _ALONG_AXIS.get(_named(axle))
    if rpy is None:
        return "turn the shape so that its z axis is along the axle"
    xyz = _numbers(shape.origin.xyz)
    if language == "sdf":
        return f"lay it down: <pose>{xyz} {rpy}</pose> for the shape"
    return f'lay it down: <origin xyz="{xyz}" rpy="{rpy}"/> for the shape'


def _turned_axis(middle: Vector3, language: Language) -> str:
    """Name the axis that fits an upright wheel."""
    xyz = _UNITS.get(_named(middle)) or _numbers(middle)
    return f"write {axis_text(xyz, language)}"
