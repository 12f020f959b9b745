"""Facts of the session for scripts of the page: frames, ids, version, what is read."""

from __future__ import annotations

import secrets
import weakref
from collections.abc import Sequence

import viser

from sambot_viz._version import __version__
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Data
from sambot_viz.session import Session
from sambot_viz.session.scene.scene import Scene

_STARTED_AGAIN, _PRIVATE = "The program was started again.", "The session was reset."


class SessionInfoPanel(Panel):
    """Facts that no panel shows.

    Args:
        session: whose facts these are.
    """

    name = "names"

    def __init__(self, session: Session) -> None:
        self.remade_by = (session.scene.frames, session.document.replaced)
        self._session = session
        # A page that comes back after a restart finds another id here.
        private = isinstance(session.audience, viser.ClientHandle)
        self._session_value = {
            "id": secrets.token_hex(8),
            "again": _PRIVATE if private else _STARTED_AGAIN,
        }
        self._document = weakref.ref(session.document.config)
        self._documents = 0

    def data(self) -> Sequence[Data]:
        """Return the frames, which session and document this is, and the version."""
        if self._document() is not self._session.document.config:
            self._document = weakref.ref(self._session.document.config)
            self._documents += 1
        frames = sorted(self._session.frames.tree.frames)
        return [
            Data("names/frames", frames),
            Data("names/session", self._session_value),
            Data("names/document", self._documents),
            Data("names/version", __version__),
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
