"""Compare the names of two parts that differ only in their side or number."""

from __future__ import annotations

import re

_SIDES = (
    {"left", "right", "front", "rear", "back", "center", "middle"},
    {"l", "r", "f", "b", "fl", "fr", "rl", "rr", "bl", "br", "lf", "rf", "lr"},
    {"upper", "lower"},
    {"top", "bottom"},
    {"first", "second", "third"},
)
"""Words of which the names of two similar parts have one each."""
LEFT = re.compile(r"left|(?<![a-z])[fbrm]?l[fbr]?(?![a-z])", re.IGNORECASE)
RIGHT = re.compile(r"right|(?<![a-z])[fbrm]?r[fbr]?(?![a-z])", re.IGNORECASE)
"""What means a side in the name of a part."""
_PIECE = re.compile(r"[A-Za-z]+|\d+|[^A-Za-z\d]+")


def swapped(name: str, pair: tuple[str, str]) -> str:
    """Return a name with the second word of a pair for the first."""
    return "".join(pair[1] if p == pair[0] else p for p in _PIECE.findall(name))


def swap(one: str, other: str) -> tuple[str, str] | None:
    """Return the words in which the names of two similar parts differ."""
    pieces = [_PIECE.findall(name) for name in (one, other)]
    if len(pieces[0]) != len(pieces[1]):
        return None
    pairs = [(a, b) for a, b in zip(*pieces, strict=True) if a != b]
    if len(pairs) != 1:
        return None
    (pair,) = pairs
    alike = {each.lower() for each in pair}
    numbers = all(each.isdecimal() for each in pair)
    return pair if numbers or any(alike <= side for side in _SIDES) else None
