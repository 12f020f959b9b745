"""The saved views of the document: added, named, removed, and all that undone."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from sambot_viz.errors import UsageError
from sambot_viz.rviz import ViewConfig
from sambot_viz.rviz.undo_log import Restore
from sambot_viz.rviz.view_list import RemovedView
from sambot_viz.session.limits import MOST_VIEWS, require_room

if TYPE_CHECKING:
    from sambot_viz.session import Session


class SavedViews:
    """The edits of the saved views.

    Args:
        session: whose document they are in.
    """

    def __init__(self, session: Session) -> None:
        self._session = session

    def add(self, view: ViewConfig) -> ViewConfig:
        """Add a copy of a view to the saved ones, named after its type.

        Raises:
            UsageError: there are too many.
        """
        config = self._session.config
        require_room(len(config.saved_views) + 1, MOST_VIEWS, "saved views")
        with self._session.change(self._session.signals.config):
            saved = self._session.config.save_view(view)
        undo, redo = self._removal(saved)
        self._session.history.record(f"Save view {saved.name}", undo, redo)
        return saved

    def rename(self, saved: ViewConfig, name: str) -> None:
        """Give a saved view another name; an empty one changes nothing.

        Raises:
            UsageError: it is not one of the saved views.
        """
        name, before = name.strip(), saved.name

        def rename(name: str) -> None:
            if saved not in self._session.config.saved_views:
                raise UsageError(f"the view '{saved.name}' was removed")
            with self._session.change(self._session.signals.config):
                saved.rename(name)

        if name and name != before:
            rename(name)
            self._session.history.record(
                f"Rename view {before} to {name}",
                partial(rename, before),
                partial(rename, name),
            )

    def remove(self, saved: ViewConfig) -> None:
        """Remove a saved view from the document.

        Raises:
            UsageError: it is not one of them.
        """
        remove, put_back = self._removal(saved)
        remove()
        self._session.history.record(f"Remove view {saved.name}", put_back, remove)

    def _removal(self, saved: ViewConfig) -> tuple[Restore, Restore]:
        """Functions that take a saved view out, and put the same one back."""
        session = self._session
        places: list[RemovedView] = []

        def remove() -> None:
            with session.change(session.signals.config):
                places[:] = [session.config.remove_view(saved)]

        def put_back() -> None:
            with session.change(session.signals.config):
                session.config.put_back_view(places[0])

        return remove, put_back
