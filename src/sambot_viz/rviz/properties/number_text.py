"""Numbers in text: how RViz reads them and how it writes them."""

from __future__ import annotations

import math
import re
import struct

_INT = re.compile(r"\s*[+-]?\d+\s*")
_FLOAT = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*")
_GERMAN = re.compile(r"\s*[+-]?(?:\d{1,3}(?:\.\d{3})+|\d+)?,\d*(?:[eE][+-]?\d+)?\s*")
_NOT_FINITE = {"inf": math.inf, "infinity": math.inf, "nan": math.nan}
INT_LIMIT = 2**31
"""RViz's integers have 32 bits."""


def parse_int(text: str) -> int | None:
    """Return a decimal integer of 32 bits, or None."""
    if len(text) > 40 or _INT.fullmatch(text) is None:
        return None
    value = int(text)
    return value if -INT_LIMIT <= value < INT_LIMIT else None


def parse_float(text: str) -> float | None:
    """A number as the C locale has it ("1.5", "-2e-05", "inf", "nan"), or None."""
    if len(text) > 400:
        return None
    if _FLOAT.fullmatch(text):
        return float(text)
    bare = text.strip().lower()
    sign = -1.0 if bare.startswith("-") else 1.0
    value = _NOT_FINITE.get(bare.lstrip("+-").removeprefix("."))
    return None if value is None else sign * value


def parse_german(text: str) -> float | None:
    """Return a number with a decimal comma and points between thousands, or None.

    RViz reads the parts of vectors so, too.
    """
    if len(text) > 400 or _GERMAN.fullmatch(text) is None:
        return None
    return parse_float(text.replace(".", "").replace(",", "."))


def float32(value: float) -> float:
    """Return the nearest number of 32 bits, which is what RViz keeps and saves."""
    try:
        return float(struct.unpack("f", struct.pack("f", value))[0])
    except OverflowError:
        return math.copysign(math.inf, value)


def float_text(value: float) -> str:
    """Return a number as RViz saves it.

    The number is rounded to 32 bits and its shortest 64-bit text is written: 0.1
    becomes "0.10000000149011612", 10 stays "10". Large round numbers have an exponent
    when that is shorter ("1e+06").
    """
    single = float32(value)
    if not math.isfinite(single):
        return str(single)
    sign = "-" if math.copysign(1.0, single) < 0 else ""
    digits, point = _shortest(abs(single))
    if point > 0:
        # "e", its sign and at least one digit would have to be saved by it.
        cutoff = len(digits) + 4 + (1 if point <= 10 else 2)
    else:
        cutoff = 6
    if point != len(digits) and (point <= -4 or point > cutoff):
        tail = f".{digits[1:]}" if len(digits) > 1 else ""
        return f"{sign}{digits[0]}{tail}e{point - 1:+03d}"
    if point <= 0:
        return f"{sign}0.{'0' * -point}{digits}"
    if point >= len(digits):
        return sign + digits + "0" * (point - len(digits))
    return f"{sign}{digits[:point]}.{digits[point:]}"


def _shortest(value: float) -> tuple[str, int]:
    """Shortest digits that give the number back, and where the point is in them."""
    if value == 0:
        return "0", 1
    mantissa, _, exponent = f"{value!r}".partition("e")
    whole, _, fraction = mantissa.partition(".")
    point = len(whole) + int(exponent or 0)
    digits = whole + fraction
    stripped = digits.lstrip("0")
    point -= len(digits) - len(stripped)
    return stripped.rstrip("0"), point
