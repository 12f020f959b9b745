"""Numbers that were written with a unit, in the units of ROS."""

from __future__ import annotations

import math
import re

_LENGTHS = {
    "m": 1.0,
    "meter": 1.0,
    "meters": 1.0,
    "metre": 1.0,
    "metres": 1.0,
    "cm": 0.01,
    "mm": 0.001,
    "in": 0.0254,
    "inch": 0.0254,
    "inches": 0.0254,
}
_DEGREES = ("deg", "degree", "degrees", "°")
_ANGLES = dict.fromkeys(_DEGREES, math.pi / 180) | {"rad": 1.0, "radians": 1.0}
_FACTORS = _LENGTHS | _ANGLES | {"kg": 1.0, "g": 0.001}
"""Unit → how many metres, radians or kilograms it is."""

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?"
_LETTERS = str.maketrans("OolI", "0011")
_UNIT = "|".join(sorted(map(re.escape, _FACTORS), key=len, reverse=True))
_ENDS = r"(?=[\s,;]|$)"
_WITH_UNIT = re.compile(rf"(?<![\w.])({_NUMBER})\s*({_UNIT}){_ENDS}", re.IGNORECASE)
_QUANTITY = re.compile(rf"({_NUMBER})\s*({_UNIT})?", re.IGNORECASE)
_UNIT_BEHIND_ALL = re.compile(
    rf"({_NUMBER}(?:[\s,;]+{_NUMBER})+)\s+({_UNIT})", re.IGNORECASE
)
_HAS_UNIT = re.compile(rf"(?:{_NUMBER}\s*)?(?:{_UNIT})", re.IGNORECASE)


def is_with_unit(part: str) -> bool:
    """Return whether a text is one number with a known unit, or such a unit alone."""
    return _HAS_UNIT.fullmatch(part) is not None


def meant_number(part: str) -> str | None:
    """Return the number that was meant: O for 0, l for 1, a sign or point twice."""
    better = re.sub(r"([.+-])\1+", r"\1", part.translate(_LETTERS))
    return better if better != part and re.fullmatch(_NUMBER, better) else None


def without_units(text: str, *, degrees: bool = False) -> str:
    """Return numbers in metres, radians and kilograms, without the units behind them.

    Args:
        text: the numbers as they are written; what has no known unit stays.
        degrees: angles are wanted in degrees.
    """
    behind = _UNIT_BEHIND_ALL.fullmatch(text.strip())
    if behind is not None:
        numbers, unit = re.split(r"[\s,;]+", behind[1]), behind[2]
        # In a pose of six numbers the first three are lengths, the others angles.
        is_pose, is_angle = len(numbers) == 6, unit.lower() in _ANGLES
        meant = slice(3 * is_angle, 3 + 3 * is_angle) if is_pose else slice(None)
        numbers[meant] = [_in_si(number, unit, degrees) for number in numbers[meant]]
        return " ".join(numbers)
    return _WITH_UNIT.sub(lambda found: _in_si(found[1], found[2], degrees), text)


def _in_si(number: str, unit: str, degrees: bool) -> str:
    unit = unit.lower()
    factor = _FACTORS[unit]
    if degrees and unit in _ANGLES:
        factor *= 180 / math.pi
    if factor == 1.0:
        return number
    # A converted length is short; an angle is as long as one writes π.
    digits = 5 if unit in _ANGLES else 10
    return f"{float(number) * factor:.{digits}g}"


def quantity(text: str) -> float | None:
    """Return a number with or without a unit [m, rad or kg]; None for other texts."""
    found = _QUANTITY.fullmatch(text.strip())
    if found is None:
        return None
    unit = (found[2] or "").lower()
    # Division by 180 comes last, as in the page: 90deg is exactly pi/2.
    if unit in _DEGREES:
        return float(found[1]) * math.pi / 180
    return float(found[1]) * _FACTORS.get(unit, 1.0)


def usual_degrees(value: float) -> bool:
    """Return whether a number is an angle that people write in degrees."""
    return any(abs(value / step - round(value / step)) < 1e-9 for step in (15, 22.5))
