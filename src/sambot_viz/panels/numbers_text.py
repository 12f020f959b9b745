"""Numbers as texts that a user reads or copies."""

from __future__ import annotations

from collections.abc import Iterable

DIGITS = 6
"""Decimals: a micrometre is more than a hand can use."""


def plain_numbers(values: Iterable[float], digits: int = DIGITS) -> list[str]:
    """Each number without an exponent, without zeros at the end, and without −0."""
    return [_plain(float(value), digits) for value in values]


def shown_numbers(values: Iterable[float], digits: int = DIGITS) -> str:
    """Several numbers as RViz shows a vector, "1; 0; 0.5"."""
    return "; ".join(plain_numbers(values, digits))


def _plain(value: float, digits: int) -> str:
    shown = f"{round(value, digits) + 0.0:.{digits}f}"
    return shown.rstrip("0").rstrip(".") if "." in shown else shown
