"""Angles written in degrees; URDF uses radians."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.checks.rule import Subject, number
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.origin import Origin

_FULL_TURN = 2 * math.pi + 1e-3
_SMALLEST_LIMIT = 15.0
_LARGEST_LIMIT = 720.0


def _is_round(value: float) -> bool:
    """Whether it is a multiple of a half, as people write degrees."""
    return abs(value * 2 - round(value * 2)) < 1e-9


def limits_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Limits of a revolute joint that only make sense in degrees.

    Below 15 rad (2.4 turns) a round number is more likely a generous limit, and above
    720 it usually means "no limit".
    """
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
        yield Problem.at(
            limit.place or joint.place,
            "warning",
            "limit-in-degrees",
            f"joint {joint.name}: the limits {number(limit.lower)} and "
            f"{number(limit.upper)} look like degrees, but URDF uses radians",
            f'write lower="{number(math.radians(limit.lower))}" '
            f'upper="{number(math.radians(limit.upper))}"',
        )


def rpy_in_degrees(subject: Subject) -> Iterator[Problem]:
    """Report an rpy of more than a full turn in round numbers."""
    for joint in subject.robot.joints.values():
        yield from _rpy(joint.origin, joint.place)
    for link in subject.robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            yield from _rpy(shape.origin, shape.place)
        if link.inertial is not None:
            yield from _rpy(link.inertial.origin, link.inertial.place)


def _rpy(origin: Origin, place: Place | None) -> Iterator[Problem]:
    if not any(abs(v) > _FULL_TURN for v in origin.rpy):
        return
    if not all(_is_round(v) for v in origin.rpy):
        return
    written = " ".join(number(v) for v in origin.rpy)
    corrected = " ".join(number(math.radians(v)) for v in origin.rpy)
    yield Problem.at(
        origin.place or place,
        "warning",
        "rpy-in-degrees",
        f'rpy="{written}" looks like degrees, but URDF uses radians',
        f'write rpy="{corrected}"',
    )
