"""The saved views of the document: added, named, removed, and all that undone."""

from __future__ import annotations

from functools import partial

from sambot_viz import limits
from sambot_viz.errors import UsageError
from sambot_viz.rviz import ViewConfig
from sambot_viz.rviz.undo_log import Restore
from sambot_viz.rviz.view_list import RemovedView
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.room import require_room
from sambot_viz.session.signals import Change
from sambot_viz.session.undo import History


class SavedViews:
    """Edits the saved views."""

    def __init__(
        self, document: ShownDocument, history: History, change: Change
    ) -> None:
        self._document = document
        self._history = history
        self._change = change

    def add(self, view: ViewConfig) -> ViewConfig:
        """Add a copy of a view to the saved ones, named after its type.

        Raises:
            UsageError: there are too many.
        """
        config = self._document.config
        require_room(
            len(config.saved_views) + 1, limits.SESSION_VIEWS.value, "saved views"
        )
        with self._change(self._document.views):
            saved = config.save_view(view)
        undo, redo = self._removal(saved)
        self._history.record(f"Save view {saved.name}", undo, redo)
        return saved

    def rename(self, saved: ViewConfig, name: str) -> None:
        """Give a saved view another name; an empty one changes nothing.

        Raises:
            UsageError: it is not one of the saved views.
        """
        name, before = name.strip(), saved.name

        def rename(name: str) -> None:
            if saved not in self._document.config.saved_views:
                raise UsageError(f"the view '{saved.name}' was removed")
            with self._change(self._document.views):
                saved.rename(name)

        if name and name != before:
            rename(name)
            self._history.record(
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
        self._history.record(f"Remove view {saved.name}", put_back, remove)

    def _removal(self, saved: ViewConfig) -> tuple[Restore, Restore]:
        """Functions that take a saved view out, and put the same one back."""
        document = self._document
        places: list[RemovedView] = []

        def remove() -> None:
            with self._change(document.views):
                places[:] = [document.config.remove_view(saved)]

        def put_back() -> None:
            with self._change(document.views):
                document.config.put_back_view(places[0])

        return remove, put_back
