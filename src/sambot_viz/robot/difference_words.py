"""A difference between two robots in words, for terminals and pages."""

from __future__ import annotations

import math
from typing import NamedTuple

from sambot_viz.robot.difference import Difference, Unit, Value


class DifferenceWords(NamedTuple):
    """A difference for users, in mm and degrees.

    Attributes:
        whose: "link base_link", or "" for the robot itself.
        what: "visual size"; "" for a link or joint that one robot lacks.
        mine: value of the first robot.
        theirs: value of the second robot.
        apart: distance between the two; "" where it is not a number.
    """

    whose: str
    what: str
    mine: str
    theirs: str
    apart: str


def in_words(found: Difference) -> DifferenceWords:
    """Describe a difference in words."""
    whose = f"{found.kind} {found.name}".strip()
    mine, theirs = (_shown(value, found.unit) for value in (found.mine, found.theirs))
    apart = "" if found.apart is None else _shown(found.apart, found.unit, 4)
    return DifferenceWords(whose, found.what, mine, theirs, apart)


def _shown(value: Value, unit: Unit, digits: int = 6) -> str:
    if value is None or isinstance(value, str):
        return value or "none"
    numbers = value if isinstance(value, tuple) else (value,)
    said = unit
    if unit == "rad":
        numbers, said = tuple(map(math.degrees, numbers)), "°"
    elif unit == "m":
        numbers, said = tuple(1000.0 * number for number in numbers), "mm"
    text = " ".join(f"{number + 0.0:.{digits}g}" for number in numbers)
    return text + said if said == "°" else f"{text} {said}".rstrip()
