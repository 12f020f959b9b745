"""Values as libsdformat reads them: the longest start that C++ takes for a number.

What is behind that start is ignored by ROS: ``0,5`` is 0 and ``0.5m`` is 0.5. Each
reader returns the value and what was ignored, so that the caller can warn.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from sambot_viz import limits
from sambot_viz.errors import nearest
from sambot_viz.robot.slips.colour_range import in_unit_range

# numpy takes longer to import than a small model to check, and only poses need it.
if TYPE_CHECKING:
    from sambot_viz.geometry import Matrix, Rgba

LARGEST = float(limits.NUMBER.value)
"""Lengths beyond this leave the range in which pictures and poses can be computed."""

_BLANKS = re.compile(r"[ \t\n\r\v\f]+")
_DECIMAL = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[+-]?[0-9]+)?"
_HEX = r"0x(?:[0-9a-f]+\.?[0-9a-f]*|\.[0-9a-f]+)(?:p[+-]?[0-9]+)?"
_START = re.compile(
    rf"[+-]?(?:{_HEX}|{_DECIMAL}|infinity|inf|nan)", re.IGNORECASE | re.ASCII
)
# A stream knows no hexadecimal number, and none that is not finite.
_STREAMED = re.compile(rf"[ \t\n\r\v\f]*([+-]?{_DECIMAL})(e?)", re.IGNORECASE)
_INTEGER = re.compile(r"[+-]?(?:0x[0-9a-f]+|[0-9]+)", re.IGNORECASE)
_SEPARATORS = re.compile(r"[\s,;]+")
_SMALLEST = 2.2250738585072014e-308
_COUNTS = {3: "three", 4: "four", 6: "six", 7: "seven"}


class BadValue(ValueError):
    """A text that libsdformat does not take.

    Attributes:
        reason: what is wrong, worded to follow the text itself.
        hint: what to write.
        right: the right value, where it is certain.
        added: what is missing at the end, where it is certain.
    """

    def __init__(
        self, reason: str, hint: str, right: str = "", added: str = ""
    ) -> None:
        super().__init__(reason)
        self.reason = reason
        self.hint = f"write {right}" if right else hint
        self.right = right
        self.added = added


@dataclass(frozen=True, slots=True)
class Number:
    """A number, and the text behind it that ROS ignores."""

    value: float
    ignored: str = ""


def trimmed(text: str) -> str:
    """Return a text without the blanks around it."""
    return text.strip(" \t\n\r\v\f")


def words_of(text: str) -> list[str]:
    """Return the parts of a text between blanks."""
    return [word for word in _BLANKS.split(text) if word]


def read_number(text: str) -> Number:
    """Read one number; it may be infinite or not a number at all ("nan").

    Raises:
        BadValue: it does not begin with one.
    """
    text = trimmed(text)
    # For numbers libsdformat replaces these two words, whatever they are meant for.
    if text.lower() in ("true", "false"):
        return Number(float(text.lower() == "true"))
    match = _START.match(text)
    if match is None:
        raise BadValue(*_complaint(text))
    start = match[0]
    value = float.fromhex(start) if "x" in start.lower() else float(start)
    spelt_out = start.lower().lstrip("+-")[0] in "in"
    too_large = math.isinf(value) and not spelt_out
    too_small = abs(value) < _SMALLEST and re.search("[1-9a-f]", _mantissa(start))
    if too_large or too_small:
        raise BadValue("is beyond the numbers of a computer", "write a usual number")
    return Number(value, text[match.end() :])


def _mantissa(number: str) -> str:
    is_hex = "x" in number.lower()
    digits = number.lower().partition("x")[2] if is_hex else number.lower()
    return digits.partition("p" if is_hex else "e")[0]


def _complaint(text: str) -> tuple[str, str]:
    if not text:
        return "is empty", "write a number"
    if "$" in text:
        return (
            "still contains an expression, which xacro has not replaced",
            'declare xmlns:xacro="http://www.ros.org/wiki/xacro" on <sdf>, or write '
            "the number",
        )
    if re.search(r"pi", text, re.IGNORECASE):
        return (
            "is not a number: SDF cannot calculate",
            f"write the number, or use xacro: ${{{text}}}",
        )
    return "is not a number", "write a number such as 0.1"


def read_integer(text: str, signed: bool) -> Number:
    """Read a whole number, of 32 bits where it may be negative, else of 64.

    Raises:
        BadValue: it does not begin with one.
    """
    text = trimmed(text)
    if text.lower() in ("true", "false"):
        return Number(float(text.lower() == "true"))
    match = _INTEGER.match(text)
    if match is None:
        raise BadValue("is not a whole number", "write a number such as 1")
    value = int(match[0], 16 if "x" in match[0].lower() else 10)
    # C++ turns a negative number into a large one, where only positive ones may be.
    if abs(value) >= (2**31 if signed else 2**64):
        raise BadValue("is beyond the numbers of a computer", "write a usual number")
    return Number(value, text[match.end() :])


def read_boolean(text: str) -> bool:
    """Read true, false, 1 or 0.

    Raises:
        BadValue: it is something else.
    """
    word = trimmed(text).lower()
    if word not in ("true", "false", "1", "0"):
        right = nearest(word, ("true", "false")) or ""
        raise BadValue("is neither true nor false", "write true or false", right)
    return word in ("true", "1")


def read_vector(text: str, count: int) -> tuple[float, ...]:
    """Read numbers between blanks; what follows them is ignored.

    Raises:
        BadValue: there are fewer, or something else.
    """
    numbers: list[float] = []
    at = 0
    for _ in range(count):
        match = _STREAMED.match(text, at)
        if match is None or match[2] or math.isinf(float(match[1])):
            raise BadValue(*_vector_complaint(text, count))
        numbers.append(float(match[1]))
        at = match.end()
    return tuple(numbers)


def _vector_complaint(text: str, count: int) -> tuple[str, str]:
    needed = _COUNTS.get(count, "two")
    if re.search("[,;]", text):
        apart = _SEPARATORS.sub(" ", text).split()
        pointed = re.sub(r"(?<=\d),(?=\d)", ".", text)
        with_points = _SEPARATORS.sub(" ", pointed).split()
        if len(apart) != count == len(with_points):
            better = " ".join(with_points)
            return "has decimal commas; numbers have a point", f"write {better}"
        better = " ".join(apart)
        return _separated(text), f"write {better}"
    parts = words_of(text)
    if len(parts) < count and all(_START.match(part) for part in parts):
        only = f"has {len(parts)} number{'' if len(parts) == 1 else 's'}"
        if len(parts) == 1:
            return f"{only}, {needed} are needed", f"write {' '.join(parts * count)}"
        return f"{only}, {needed} are needed", f"write {needed} numbers"
    bad = next((part for part in parts if not _START.match(part)), text)
    reason, hint = _complaint(bad)
    return (reason if bad == text else f"contains {bad}, which {reason}"), hint


def _separated(text: str) -> str:
    marks = "commas" if "," in text else "semicolons"
    return f"has {marks}; numbers are separated by blanks only"


def read_colour(text: str) -> Rgba:
    """Read three or four numbers from 0 to 1; without the fourth, opaque.

    Raises:
        BadValue: there is another number of them, or one that is not from 0 to 1.
    """
    parts = [read_number(word).value for word in words_of(text)]
    if any(part < 0.0 or part > 1.0 for part in parts):
        looks, better = in_unit_range(parts)
        hint = f"write {better or 'numbers from 0 to 1'}"
        raise BadValue(f"leaves the range 0 to 1{looks}", hint)
    if len(parts) == 3:
        parts.append(1.0)
    if len(parts) != 4:
        raise BadValue(
            f"has {len(parts)} number{'' if len(parts) == 1 else 's'}, four are needed",
            "write red, green, blue and opacity, each 0 to 1",
        )
    r, g, b, a = (0.0 if math.isnan(part) else part for part in parts)
    return (r, g, b, a)


@dataclass(frozen=True, slots=True)
class PoseText:
    """A pose as it is written.

    Attributes:
        numbers: x y z [m] and roll pitch yaw [rad], or x y z and a quaternion xyzw.
        ignored: whether there was text behind a number, which ROS ignores.
    """

    numbers: tuple[float, ...]
    ignored: bool = False

    @property
    def matrix(self) -> Matrix:
        """The (4, 4) transform; a quaternion is brought to length 1."""
        import numpy as np

        from sambot_viz.geometry import SHORTEST, rotation_from_rpy, rotation_from_xyzw

        T = np.eye(4)
        if len(self.numbers) == 6:
            T[:3, :3] = rotation_from_rpy(*self.numbers[3:])
        elif self.length > SHORTEST:
            x, y, z, w = (part / self.length for part in self.numbers[3:])
            T[:3, :3] = rotation_from_xyzw((x, y, z, w))
        T[:3, 3] = self.numbers[:3]
        return T

    @property
    def length(self) -> float:
        """The length of the quaternion; 1 where there is none."""
        return math.hypot(*self.numbers[3:]) if len(self.numbers) == 7 else 1.0


def read_pose(text: str, degrees: bool, rotation_format: str) -> PoseText:
    """Read a pose; an empty one is that of its frame.

    Args:
        text: the numbers.
        degrees: whether the angles are degrees.
        rotation_format: "euler_rpy" or "quat_xyzw".

    Raises:
        BadValue: another number of numbers, or one that is not finite.
    """
    count = _count(rotation_format, degrees)
    words = words_of(text)
    if not words:
        return PoseText((0.0,) * 6)
    read = [_finite(word) for word in words]
    apart = _SEPARATORS.split(text.strip(" ,;"))
    if len(read) != count == len(apart):
        raise BadValue(_separated(text), f"write {' '.join(apart)}")
    if len(read) != count:
        raise BadValue(
            f"has {len(read)} numbers, {_COUNTS[count]} are needed",
            "write x y z qx qy qz qw"
            if count == 7
            else "write x y z roll pitch yaw, in metres and "
            + ("degrees" if degrees else "radians"),
            added={3: " 0 0 0", 5: " 0"}.get(len(read), "") if count == 6 else "",
        )
    numbers = [number.value for number in read]
    if degrees:
        numbers[3:] = map(math.radians, numbers[3:])
    # A comma behind a number separates; anything else was meant to count.
    ignored = any(number.ignored not in ("", ",") for number in read)
    return PoseText(tuple(numbers), ignored)


def _count(rotation_format: str, degrees: bool) -> int:
    if rotation_format not in ("euler_rpy", "quat_xyzw"):
        raise BadValue(
            f'has rotation_format="{rotation_format}", which is not known',
            'write "euler_rpy" or "quat_xyzw"',
        )
    if rotation_format == "euler_rpy":
        return 6
    if degrees:
        raise BadValue(
            'is a quaternion, to which degrees="true" does not apply',
            'delete degrees="true"',
        )
    return 7


def _finite(word: str) -> Number:
    try:
        number = read_number(word)
    except BadValue as bad:
        raise BadValue(f"contains {word}, which {bad.reason}", bad.hint) from None
    if not math.isfinite(number.value):
        raise BadValue(f"contains {word}, which is not finite", "write a usual number")
    return number
