"""What the panels of the window have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from sambot_viz.panels.row import Json, Row
from sambot_viz.session.signals import Signal


class Panel:
    """A list of rows, made from the state of a session or of one browser.

    Attributes:
        name: the panel of the page that shows the rows.
        remade_by: the rows are made again after these have changed.
        moved_by: only `values` is asked after these.
        period: shortest time between two times that `values` is asked [s].
    """

    name: ClassVar[str]
    remade_by: Sequence[Signal[Any]] = ()
    moved_by: Sequence[Signal[Any]] = ()
    period: ClassVar[float] = 0.0

    def rows(self) -> Sequence[Row]:
        """All rows in the order of the page; a row comes after the one above it."""
        raise NotImplementedError

    def values(self) -> Mapping[str, Json]:
        """The id and value of rows that may show something else after a motion."""
        return {}

    def close(self) -> None:
        """Nothing is asked any more."""
