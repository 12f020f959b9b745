"""Numbers as urdfdom reads them: C locale, blanks only."""

from __future__ import annotations

import math
import re

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_WORDS = {2: "two", 3: "three", 4: "four"}


class BadNumber(ValueError):
    """Text that urdfdom does not take for a number.

    Attributes:
        reason: what is wrong, worded to follow the attribute's text.
        hint: what to write.
    """

    def __init__(self, reason: str, hint: str) -> None:
        super().__init__(reason)
        self.reason = reason
        self.hint = hint


def read_number(text: str) -> float:
    """One finite number.

    Blanks around it are taken, though urdfdom refuses them behind a number: the
    caller warns (`has_blank_behind`).

    Raises:
        BadNumber: it is none.
    """
    return _component(text.strip(" "), text)


def has_blank_behind(text: str) -> bool:
    """Tell whether a single number ends with a blank, which urdfdom refuses."""
    return text != text.rstrip()


def read_numbers(text: str, count: int) -> tuple[float, ...]:
    """Exactly `count` finite numbers, separated by blanks.

    Raises:
        BadNumber: another number of numbers, or something that is not a number.
    """
    parts = text.split()
    if "," in text or ";" in text:
        better = " ".join(re.split(r"[\s,;]+", text.strip(" ,;")))
        raise BadNumber(
            "has commas; numbers are separated by blanks only", f'write "{better}"'
        )
    numbers = tuple(_component(part, text) for part in parts)
    if len(numbers) != count:
        needed = _WORDS.get(count, str(count))
        have = f"has {len(parts)} number{'' if len(parts) == 1 else 's'}"
        raise BadNumber(f"{have}, {needed} are needed", _filled_up(parts, count))
    return numbers


def _filled_up(parts: list[str], count: int) -> str:
    if not parts:
        return f"give {_WORDS.get(count, count)} numbers, or delete the attribute"
    if len(parts) == 1 and count == 3:
        return f'for the same value in all directions write "{" ".join(parts * 3)}"'
    return f"give {_WORDS.get(count, count)} numbers with blanks between them"


def _component(part: str, whole: str) -> float:
    if _NUMBER.fullmatch(part):
        value = float(part)
        if math.isfinite(value):
            return value
    raise BadNumber(*_complaint(part, whole))


def _complaint(part: str, whole: str) -> tuple[str, str]:
    if not part:
        return "is empty", "write a number"
    if "$" in part:
        return (
            f"still contains the expression {part}, which xacro has not replaced",
            "declare xmlns:xacro on <robot>, or write the number",
        )
    if part.lower().lstrip("+-") in ("nan", "inf", "infinity"):
        return f"contains {part}, which is not a finite number", "write a finite number"
    if re.fullmatch(r"[+-]?[\d.]+(?:[eE][+-]?\d+)?[A-Za-z°]+", part):
        return (
            f"has a unit in {part}; URDF knows only metres and radians",
            "write the bare number",
        )
    if re.search(r"pi|[*/()]|\d[+-]\d", part):
        shown = whole.replace(part, f"${{{part}}}")
        return (
            f"contains {part}, which is not a number: plain URDF cannot calculate",
            f'write the number{_value_of(part)}, or use xacro: "{shown}"',
        )
    return f"contains {part}, which is not a number", "write a number such as 0.1"


def _value_of(part: str) -> str:
    match = re.fullmatch(r"([+-]?)(?:math\.|M_)?pi(?:/(\d+(?:\.\d+)?))?", part.lower())
    if match is None or (match[2] and float(match[2]) == 0):
        return ""
    value = math.pi / float(match[2] or 1)
    return f" {'-' if match[1] == '-' else ''}{value:.4f}"
