"""Report one length that is far larger than all others: it is not in metres."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence, Set
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from sambot_viz.checks.clues import Clues, guess, is_measured, is_written_whole
from sambot_viz.checks.model.lengths import (
    LENGTHS,
    UNITS,
    is_lighter_than_foam,
    written_lengths,
)
from sambot_viz.checks.rule import Subject, number
from sambot_viz.edits import write_attribute
from sambot_viz.errors import Edit, Fix, Place, Problem
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Box, Joint, MeshFile, Shape

if TYPE_CHECKING:
    from sambot_viz.robot.xacro.diagnose.source_files import SourceSet

_TIMES, _TIMES_WITH_MESHES = 4.5, 8.0
"""Factor over the size of all others; the sizes of meshes are unknown here."""
_LARGE = 1.5
"""Length below which a value may be right [m]."""
_THIN = 0.001
"""Thickness, as a share of the length, below which a shape is a plane."""
_SMALL = 0.01
"""Length below which a part does not show the size of a robot [m]."""
_LEAST, _SHARE = 8, 0.25
"""Required number of others, and the greatest share of outliers."""
_MOST = 4
"""Maximum number of elements in one slip."""
_CARRIES = 2.5
"""Factor by which a part that carries the others may be larger than these."""
_WHOLE = 10.0
"""Size from which whole numbers are seldom metres [m]."""
_UNIT_IN_NAME = re.compile(r"(?<![a-z])[cm]m(?![a-z])|milli|centi", re.IGNORECASE)
_LINES, _ELEMENT = 4, 2000
"""Numbers of lines and of characters of an element to search for a property."""


class _Written(NamedTuple):
    """Numbers of one element.

    Attributes:
        what: their owner, as part of a sentence.
        values: the numbers in the model [m].
        place: of the element.
        advice: the place of the numbers, as the end of the advice.
        carries: they belong to a part that carries others, and may be the largest.
        link: the link of the shape; "" for an origin.
    """

    what: str
    values: tuple[float, ...]
    place: Place | None
    advice: str = ""
    carries: bool = False
    link: str = ""

    @property
    def largest(self) -> float:
        return max(map(abs, self.values))


def lengths_out_of_proportion(subject: Subject) -> Iterator[Problem]:
    """Report lengths that are many times larger than all others of the robot.

    Each property gives one finding, and so does each element without one.
    """
    robot = subject.robot
    elements = list(_elements(robot))
    usual = _largest_usual(elements, robot)
    if usual is None:
        return
    large = [
        element
        for element in elements
        if element.largest > usual and not _is_rail(element, robot)
    ]
    small = {
        abs(value)
        for element in elements
        for value in element.values
        if _SMALL < abs(value) <= usual
    }
    if not large:
        return
    found = list(_properties(subject, large, usual, small))
    found = found or list(_single(subject, large, usual, small))
    if len(found) <= _MOST:
        yield from found


def _elements(robot: Robot) -> Iterator[_Written]:
    carrying = {joint.parent for joint in robot.joints.values()}
    for link in robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            if not isinstance(shape.geometry, MeshFile) and not _is_plane(shape):
                what, values = written_lengths(shape.geometry)
                place = shape.geometry_place or shape.place
                what = f"link {link.name}: the {what}"
                carries = link.name in carrying
                yield _Written(what, values, place, carries=carries, link=link.name)
            yield _origin(f"link {link.name}: the place of a shape", shape, robot)
    for joint in robot.joints.values():
        # The position of the robot in a map is not a length of the robot.
        if all(_has_shapes(robot, name) for name in (joint.parent, joint.child)):
            yield _origin(f"the place of joint {joint.name}", joint, robot)


def _is_plane(shape: Shape) -> bool:
    """Return whether a shape is a floor or a wall, with hardly any thickness."""
    box = shape.geometry
    return isinstance(box, Box) and min(box.size) < _THIN * max(box.size)


def _is_rail(element: _Written, robot: Robot) -> bool:
    """Return whether a part slides about as far as a length."""
    travels = [
        joint.limit.upper - joint.limit.lower
        for joint in robot.joints.values()
        if joint.type == "prismatic" and joint.limit is not None
    ]
    return any(0.5 <= travel / element.largest <= 2.0 for travel in travels)


def _has_shapes(robot: Robot, name: str) -> bool:
    link = robot.links.get(name)
    return link is not None and bool(link.visuals or link.collisions)


def _origin(what: str, of: Shape | Joint, robot: Robot) -> _Written:
    tag = "the <pose>" if robot.language == "sdf" else "xyz"
    place = of.origin.place or of.place
    return _Written(what, of.origin.xyz, place, f" in {tag}")


def _largest_usual(elements: Sequence[_Written], robot: Robot) -> float | None:
    """Return the largest length below the gap [m]; None without a gap."""
    meshes = any(
        isinstance(shape.geometry, MeshFile)
        for link in robot.links.values()
        for shape in (*link.visuals, *link.collisions)
    )
    times = _TIMES_WITH_MESHES if meshes else _TIMES
    every = (abs(value) for element in elements for value in element.values)
    lengths = sorted(length for length in every if length > _SMALL)
    for count, (below, above) in enumerate(pairwise(lengths), start=1):
        if above > _LARGE and above > times * below:
            few = len(lengths) - count <= _SHARE * len(lengths)
            return below if few and count >= _LEAST else None
    return None


def _properties(
    subject: Subject, large: Sequence[_Written], usual: float, small: Set[float]
) -> Iterator[Problem]:
    """Report the properties that give these lengths."""
    # Most models have none, and must not wait for this to be imported.
    from sambot_viz.robot.xacro.diagnose.source_files import SourceSet, token_place

    least = min(
        abs(value)
        for element in large
        for value in element.values
        if abs(value) > usual
    )
    files = SourceSet.of(subject.files)
    for file, source in files.sources():
        for token in source.tags:
            name, text = token.get("name") or "", token.get("value") or ""
            if token.name != "xacro:property" or token.closes:
                continue
            value = _number(text)
            if value is None or abs(value) < 0.9 * least:
                continue
            used = next((e for e in large if _names(files, e.place, name)), None)
            if used is not None:
                unit, factor = _unit(used, abs(value), usual)
                clues = _clues(subject.robot, used, abs(value), factor, small)
                if _UNIT_IN_NAME.search(f"{name} {token.get('units') or ''}"):
                    clues = clues | {"name"}
                certain = _is_certain(clues, used, abs(value), usual, small)
                place = token_place(source, file, token)
                right = number(value * factor)
                hint = f'write metres: value="{right}"'
                fix = write_attribute(place, "value", text, right, hint=hint)
                what = f"the property {name} is {text} m"
                other = number(value * min(UNITS.values()))
                fix = fix if certain else Fix(f"{hint}, or {other} if in millimetres")
                yield _problem(place, what, usual, unit, fix, clues)


def _names(files: SourceSet, place: Place | None, name: str) -> bool:
    """Return whether an element, or one inside, uses a property."""
    source = None if place is None else files.get(place.file)
    if source is None or place is None:
        return False
    start = source.offset(place.line, 1)
    lines = source.text[start : start + _ELEMENT].split("\n")[:_LINES]
    return re.search(rf"\$\{{[^}}]*\b{re.escape(name)}\b", "\n".join(lines)) is not None


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _single(
    subject: Subject, large: Sequence[_Written], usual: float, small: Set[float]
) -> Iterator[Problem]:
    """Report each element by itself, with its numbers in metres."""
    robot = subject.robot
    seen: set[tuple[Place | None, tuple[float, ...]]] = set()
    for element in large:
        if (element.place, element.values) in seen:
            continue
        seen.add((element.place, element.values))
        unit, factor = _unit(element, element.largest, usual)
        metres = (v * factor if abs(v) > usual else v for v in element.values)
        written = " ".join(map(number, element.values))
        clues = _clues(robot, element, element.largest, factor, small)
        edits = _in_metres(subject, element, usual, factor)
        yield _problem(
            element.place,
            f"{element.what} ({written}) is {number(element.largest)} m",
            usual,
            unit,
            Fix(
                f"write metres: {' '.join(map(number, metres))}{element.advice}", edits
            ),
            clues,
        )


def _in_metres(
    subject: Subject, element: _Written, usual: float, factor: float
) -> tuple[Edit, ...]:
    from sambot_viz.checks.model.rewritten import Rewriting

    rewriting = Rewriting(
        subject.files, lambda value: value * factor if abs(value) > usual else value
    )
    names = LENGTHS if element.link else ("" if "<pose>" in element.advice else "xyz",)
    most = 9 if element.link else 3
    return tuple(rewriting.attributes(element.place, *names, most=most))


def _clues(
    robot: Robot, element: _Written, length: float, factor: float, small: Set[float]
) -> Clues:
    """Return the clues for another unit, except the size."""
    clues = {"size"}
    if length >= _WHOLE and is_written_whole(length):
        clues.add("whole number")
    metres = factor * length
    if is_measured(length) and any(abs(o - metres) < 0.01 * o for o in small):
        clues.add("same elsewhere")
    if element.link and is_lighter_than_foam(robot.links[element.link]):
        clues.add("density")
    return clues


def _unit(element: _Written, length: float, usual: float) -> tuple[str, float]:
    """Return the unit in which a length does not exceed the robot."""
    most = _CARRIES * usual if element.carries else usual
    units = list(UNITS.items())
    return next((unit for unit in units if length * unit[1] <= most), units[-1])


def _is_certain(
    clues: Clues, element: _Written, length: float, usual: float, small: Set[float]
) -> bool:
    """Return whether only one unit makes a length similar to those of the robot."""
    most = _CARRIES * usual if element.carries else usual
    least = min(small, default=0.0)
    fitting = [f for f in UNITS.values() if least <= length * f <= most]
    return len(fitting) < 2 or "same elsewhere" in clues


def _problem(
    place: Place | None, what: str, usual: float, unit: str, fix: Fix, clues: Clues
) -> Problem:
    return guess(
        place,
        "shape-size",
        f"{what}, and no other length of the robot is more than {number(usual)} m: it "
        f"is probably given in {unit}",
        fix,
        clues,
    )
