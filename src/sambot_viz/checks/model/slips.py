"""Report names and values that ROS accepts and that are rarely intended."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from sambot_viz.checks.clues import Clues, guess
from sambot_viz.checks.model.lengths import written_lengths
from sambot_viz.checks.rule import Subject, number
from sambot_viz.edits import together, write_attribute
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.robot.parts import Box, Joint, Language, Limit, Link, MeshFile, Origin
from sambot_viz.robot.slips.units import usual_degrees

_FULL_TURN = 2 * math.pi + 1e-3
_SMALLEST_LIMIT = 15.0
_LARGEST_LIMIT = 720.0


def _is_round(value: float) -> bool:
    """Return whether it is a multiple of a half, as people write degrees."""
    return abs(value * 2 - round(value * 2)) < 1e-9


def limits_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Report limits of a revolute joint that only make sense in degrees.

    Below 15 rad (2.4 turns) a round number is more likely a generous limit, and above
    720 it usually means "no limit".
    """
    others = [
        end
        for joint in subject.robot.joints.values()
        if joint.type == "revolute" and joint.limit is not None
        for end in (joint.limit.lower, joint.limit.upper)
        if abs(end) <= _FULL_TURN
    ]
    for joint in subject.robot.joints.values():
        limit = joint.limit
        if joint.type != "revolute" or limit is None:
            continue
        ends = [v for v in (limit.lower, limit.upper) if v]
        if not ends or not _SMALLEST_LIMIT <= max(abs(v) for v in ends):
            continue
        if any(abs(v) > _LARGEST_LIMIT for v in ends):
            continue
        if not all(_is_round(v) and abs(v) > _FULL_TURN for v in ends):
            continue
        yield guess(
            limit.place or joint.place,
            "limit-in-degrees",
            f"joint {joint.name}: the limits {number(limit.lower)} and "
            f"{number(limit.upper)} look like degrees, but "
            f"{subject.robot.language.upper()} uses radians",
            _limits_in_radians(limit, subject.robot.language),
            _clues(ends, others),
        )


def _clues(angles: Iterable[float], in_radians: Iterable[float] = ()) -> Clues:
    """Return the clues for degrees, except too large numbers."""
    clues = {"size"}
    if all(map(usual_degrees, angles)):
        clues.add("usual degrees")
    if any(not _is_round(angle) for angle in in_radians):
        clues.add("other angles")
    return clues


def _limits_in_radians(limit: Limit, language: Language) -> str | Fix:
    lower, upper = (number(math.radians(v)) for v in (limit.lower, limit.upper))
    if language == "sdf":
        return f"write <lower>{lower}</lower> and <upper>{upper}</upper>"
    return together(
        f'write lower="{lower}" upper="{upper}"',
        write_attribute(limit.place, "lower", [limit.lower], lower),
        write_attribute(limit.place, "upper", [limit.upper], upper),
    )


def rpy_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Report an rpy of more than a full turn in round numbers."""
    files = subject.files
    for joint in subject.robot.joints.values():
        yield from _rpy(joint.origin, joint.place, files)
    for _, shape in subject.shapes():
        yield from _rpy(shape.origin, shape.place, files)
    for link in subject.robot.links.values():
        if link.inertial is not None:
            yield from _rpy(link.inertial.origin, link.inertial.place, files)


def _rpy(
    origin: Origin, place: Place | None, files: Sequence[str]
) -> Iterator[Problem]:
    if not any(abs(v) > _FULL_TURN for v in origin.rpy):
        return
    if not all(_is_round(v) for v in origin.rpy):
        return
    from sambot_viz.checks.model.rewritten import Rewriting

    written = " ".join(number(v) for v in origin.rpy)
    corrected = " ".join(number(math.radians(v)) for v in origin.rpy)
    yield guess(
        origin.place or place,
        "rpy-in-degrees",
        f'rpy="{written}" looks like degrees, but URDF uses radians',
        Fix(
            f'write rpy="{corrected}"',
            tuple(Rewriting(files, math.radians).attributes(origin.place, "rpy")),
        ),
        _clues(origin.rpy),
    )


def sizes_not_positive(subject: Subject) -> Iterator[Problem]:
    """Report a length of zero or less; RViz draws nothing or the inside."""
    for link, shape in subject.shapes():
        what, values = written_lengths(shape.geometry)
        mirrored = isinstance(shape.geometry, MeshFile)
        wrong = [v for v in values if v == 0 or (v < 0 and not mirrored)]
        if not wrong:
            continue
        kind = "zero" if not any(wrong) else "negative"
        written = " ".join(number(v) for v in values)
        # A box with one zero may be a plate without thickness, such as a floor.
        plate = isinstance(shape.geometry, Box) and wrong == [0.0]
        yield Problem.at(
            shape.geometry_place or shape.place,
            "info" if plate else "warning",
            "size-not-positive",
            f"link {link.name}: the {what} ({written}) contains a {kind} number, so "
            "nothing useful can be drawn",
            "give full lengths in metres, each larger than 0",
        )


def invisible_materials(subject: Subject) -> Iterator[Problem]:
    """Report materials whose opacity is 0, each once."""
    reported: set[str] = set()
    for link in subject.robot.links.values():
        for shape in link.visuals:
            material = shape.material
            if material is None or material.rgba is None or material.rgba[3] > 0:
                continue
            if material.name in reported and material.name:
                continue
            reported.add(material.name)
            named = f"the material {material.name} of " if material.name else ""
            yield Problem.at(
                shape.place,
                "info",
                "alpha-zero",
                f"{named}link {link.name} has the alpha 0: it is invisible",
                "the fourth number of a colour is the opacity: write 1 there",
            )


def names_that_differ_in_case(subject: Subject) -> Iterator[Problem]:
    """Report two links, or two joints, such as "arm" and "Arm"."""
    yield from _case_among("link", subject.robot.links.values())
    yield from _case_among("joint", subject.robot.joints.values())


def _case_among(kind: str, named: Iterable[Link | Joint]) -> Iterator[Problem]:
    seen: dict[str, Link | Joint] = {}
    for item in named:
        other = seen.setdefault(item.name.lower(), item)
        if other is item:
            continue
        where = f" (line {other.place.line})" if other.place else ""
        yield Problem.at(
            item.place,
            "warning",
            "names-differ-in-case",
            f"the {kind} names {other.name}{where} and {item.name} differ only "
            "in capital letters; ROS treats them as two different names",
            "rename one of them, or use one name if the other is a typing error",
        )


def names_with_spaces(subject: Subject) -> Iterator[Problem]:
    """Report a link or joint such as "left wheel"."""
    robot = subject.robot
    for item in (*robot.links.values(), *robot.joints.values()):
        if any(c.isspace() for c in item.name):
            kind = "link" if isinstance(item, Link) else "joint"
            yield Problem.at(
                item.place,
                "info",
                "name-with-blank",
                f'the {kind} name "{item.name}" contains a space: it works, but '
                "commands and launch files split it in two",
                f'write name="{"_".join(item.name.split())}", and the same wherever '
                f"the {kind} is named",
            )
