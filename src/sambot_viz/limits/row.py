"""A row of the table of limits."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LimitRow:
    """A row of the table.

    Attributes:
        what: what is counted, and of which sources.
        value: the most that is taken.
        unit: of the value; "" for a plain number of what is counted.
        above: what becomes of the rest, and where that is said.
    """

    what: str
    value: int
    unit: str
    above: str

    def said(self, found: int) -> str:
        """Return the figures for a sentence: "900 bytes; the limit is 100"."""
        unit = f" {self.unit}" if self.unit else ""
        return f"{found:,}{unit}; the limit is {self.value:,}"
