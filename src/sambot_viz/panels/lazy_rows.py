"""Rows that are only made when a page has unfolded what they are below."""

from __future__ import annotations

from collections.abc import Callable

from sambot_viz.panels.row import Row


class LazyRows:
    """Which rows a page has unfolded.

    Args:
        unfold_id: the id of the action with which a page asks for the rows below one.
        remake: makes the rows of the panel again.
    """

    def __init__(self, unfold_id: str, remake: Callable[[], None]) -> None:
        self._unfold_id = unfold_id
        self._remake = remake
        self._lazy: set[str] = set()
        self._unfolded: set[str] = set()

    def clear(self) -> None:
        """Forget which rows there are, before they are made again."""
        self._lazy.clear()

    def is_unfolded(self, row_id: str) -> bool:
        """Whether a page wants the rows below this one; else it may ask for them."""
        self._lazy.add(row_id)
        return row_id in self._unfolded

    def action(self) -> Row:
        """The row with which a page asks."""
        return Row(
            self._unfold_id, "", "action", takes=(str,), own=True, set=self._unfold
        )

    def _unfold(self, arguments: tuple[str]) -> None:
        (row_id,) = arguments
        if row_id in self._lazy and row_id not in self._unfolded:
            self._unfolded.add(row_id)
            self._remake()
