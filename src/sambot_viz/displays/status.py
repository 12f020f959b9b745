"""The statuses of a display, with RViz's levels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Level = Literal["Ok", "Warn", "Error"]
_ORDER: dict[Level, int] = {"Ok": 0, "Warn": 1, "Error": 2}


@dataclass(frozen=True, slots=True)
class Status:
    """One row of a status: a level and a sentence."""

    level: Level
    text: str


class StatusList:
    """The rows of one display in order of first use.

    `version` grows with every change, so that a panel knows when to write again.
    """

    def __init__(self) -> None:
        self._rows: dict[str, Status] = {}
        self.version = 0

    @property
    def rows(self) -> dict[str, Status]:
        """Key → status; a copy."""
        return dict(self._rows)

    @property
    def level(self) -> Level:
        """The worst level of all rows; Ok without rows."""
        worst: Level = "Ok"
        for row in self._rows.values():
            if _ORDER[row.level] > _ORDER[worst]:
                worst = row.level
        return worst

    def set(self, key: str, level: Level, text: str) -> None:
        """Set one row."""
        status = Status(level, text)
        if self._rows.get(key) != status:
            self._rows[key] = status
            self.version += 1

    def replace(self, rows: dict[str, Status]) -> None:
        """Set all rows at once."""
        if self._rows != rows:
            self._rows = dict(rows)
            self.version += 1

    def clear(self) -> None:
        """Remove all rows, as RViz's reset does."""
        self.replace({})
