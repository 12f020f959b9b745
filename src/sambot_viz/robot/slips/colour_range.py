"""Colours in a range other than 0 to 1."""

from __future__ import annotations

from collections.abc import Iterable

_TENS = (10.0, 100.0, 1000.0)
"""1.0 without its point, percent, and thousandths."""
_BYTE = 255.0


def in_unit_range(parts: Iterable[float]) -> tuple[str, str | None]:
    """Describe a colour outside of 0 to 1, and return the correct values.

    Args:
        parts: its components; those from 0 to 1 stay, as an opacity of 1 often does.

    Returns:
        Words for a message, which may be empty, and the components from 0 to 1; None
        where the intended range is not certain.
    """
    values = list(parts)
    largest = max(values)
    full = next((ten for ten in _TENS if largest == ten), _BYTE)
    if largest <= 1:
        looks, full = "", 1.0
    elif full != _BYTE:
        looks = f" (it looks like 0 to {full:.0f})"
    elif 100 < largest <= _BYTE:
        looks = " (it looks like 0 to 255)"
    else:
        return "", None
    units = (part if part <= 1 else part / full for part in values)
    # A negative component has a sign too many.
    return looks, " ".join(f"{min(abs(part), 1.0):.3g}" for part in units)
