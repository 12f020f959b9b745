"""Base of the panels: what they send to the page, and when it is made again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, ClassVar, TypeAlias

from sambot_viz.panels.command import Command, declared_commands
from sambot_viz.panels.rows.row import Data, Json, Row
from sambot_viz.session.signals import Signal

Item: TypeAlias = Row | Data | Command
"""One of the three that are sent to the page."""


class Panel:
    """Rows, data and commands, from the state of a session or of one client.

    Attributes:
        name: the panel of the page that shows the rows.
        remade_by: the rows are made again after these have changed; read after
            `refresh`.
        changed_by: only `changed_rows` is asked after these; read after `refresh`.
        period: shortest time between two times that `values` is asked [s].
    """

    name: ClassVar[str]
    remade_by: Sequence[Signal[Any]] = ()
    changed_by: Sequence[Signal[Any]] = ()
    period: ClassVar[float] = 0.0
    _declared: ClassVar[tuple[Command, ...]] = ()

    def __init_subclass__(cls) -> None:
        cls._declared = tuple(declared_commands(cls))

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """After these only `values` is asked; it is read when rows have been made."""
        return ()

    def refresh(self) -> None:
        """Look at what there is to show by now, before all rows are made."""

    def items(self) -> list[Item]:
        """Return all that the page gets now."""
        return [*self.rows(), *self.data(), *self.commands()]

    def rows(self) -> Sequence[Row]:
        """Return all rows in the order of the page, each after its parent."""
        return ()

    def data(self) -> Sequence[Data]:
        """Return what scripts of the page read."""
        return ()

    def commands(self) -> list[Command]:
        """Return what the page can call at present."""
        return [
            replace(declared, run=partial(declared.run, self))
            for declared in self._declared
            if self.offers(declared.id)
        ]

    def offers(self, command_id: str) -> bool:
        """Return whether a declared command can be called at present."""
        return True

    def changed_rows(self) -> Sequence[Row] | None:
        """Return the rows that differ from before; None when there may be others."""
        return None

    def values(self) -> Mapping[str, Json]:
        """Return the values of rows and data that a motion may have changed, by id."""
        return {}

    def close(self) -> None:
        """Ask nothing more."""
