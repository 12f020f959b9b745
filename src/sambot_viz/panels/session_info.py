"""Facts of the session for scripts of the page: frames, ids, version, read files."""

from __future__ import annotations

import secrets
import weakref
from collections.abc import Sequence

from sambot_viz._version import __version__
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.scene.scene import Scene

_STARTED_AGAIN, _PRIVATE = "The server was restarted.", "The session was reset."


class SessionInfoPanel(Panel):
    """Facts that no panel shows.

    Args:
        private: whether only one client sees the session.
        fullscreen: whether pages open with their panels hidden.
    """

    name = "names"

    def __init__(
        self, document: ShownDocument, scene: Scene, private: bool, fullscreen: bool
    ) -> None:
        self.remade_by = (scene.frames, document.replaced)
        self._document = document
        self._fullscreen = fullscreen
        self._tree = scene.context.tree
        # A page that comes back after a restart finds another id here.
        self._session_value = {
            "id": secrets.token_hex(8),
            "again": _PRIVATE if private else _STARTED_AGAIN,
        }
        self._shown = weakref.ref(document.config)
        self._documents = 0

    def data(self) -> Sequence[Data]:
        """Return the frames, which session and document this is, and the version."""
        if self._shown() is not self._document.config:
            self._shown = weakref.ref(self._document.config)
            self._documents += 1
        return [
            Data("names/frames", sorted(self._tree.frames)),
            Data("names/session", self._session_value),
            Data("names/document", self._documents),
            Data("names/version", __version__),
            Data("names/fullscreen", self._fullscreen),
        ]


class StatusBarPanel(Panel):
    """Data of the status bar; its hint is a row of each browser.

    Args:
        scene: reads files.
    """

    name = "statusbar"

    def __init__(self, scene: Scene) -> None:
        self.remade_by = (scene.progress,)
        self._scene = scene

    def data(self) -> Sequence[Data]:
        """Return how many files of how many are read."""
        return [Data("statusbar/progress", self._scene.progress.value)]
