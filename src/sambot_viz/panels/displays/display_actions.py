"""What the page can do with a display: name, move, remove."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from sambot_viz.errors import UsageError
from sambot_viz.panels.row import Row
from sambot_viz.rviz import DisplayConfig
from sambot_viz.session import Session


class DisplayActions:
    """The rows that do something with displays.

    Args:
        session: whose displays these are.
        display_of: finds the display of a row, or raises UsageError.
    """

    def __init__(
        self,
        session: Session,
        display_of: Callable[[str], DisplayConfig],
    ) -> None:
        self._session = session
        self._display_of = display_of

    def rows(self) -> Iterator[Row]:
        """An action for each."""
        yield _action("displays/remove", (str,), self._delete)
        yield _action("displays/rename", (str, str), self._rename)
        yield _action("displays/move", (str, str, int), self._move)

    def _delete(self, arguments: tuple[str]) -> None:
        self._session.remove_display(self._display_of(arguments[0]))

    def _rename(self, arguments: tuple[str, str]) -> None:
        row_id, name = arguments
        if not name.strip():
            raise UsageError("a display needs a name")
        self._session.rename_display(self._display_of(row_id), name.strip())

    def _move(self, arguments: tuple[str, str, int]) -> None:
        row_id, group, index = arguments
        into = self._display_of(group) if group else None
        self._session.move_display(self._display_of(row_id), index, into)


def _action(row_id: str, takes: tuple[Any, ...], act: Callable[[Any], object]) -> Row:
    return Row(row_id, "", "action", takes=takes, set=act)
