"""What many rows of the page need to know: the frames there are, the version."""

from __future__ import annotations

import secrets
import weakref
from collections.abc import Sequence

import viser

from sambot_viz._version import __version__
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Row
from sambot_viz.session import Session

_STARTED_AGAIN, _PRIVATE = "The program was started again.", "This page begins again."


class NamesPanel(Panel):
    """Facts without a panel of their own.

    Args:
        session: whose facts these are.
    """

    name = "names"

    def __init__(self, session: Session) -> None:
        signals = session.signals
        self.remade_by = (signals.robot, signals.frames, signals.config)
        self._session = session
        # A page that comes back after a restart finds another id here.
        private = isinstance(session.audience, viser.ClientHandle)
        self._session_value = {
            "id": secrets.token_hex(8),
            "again": _PRIVATE if private else _STARTED_AGAIN,
        }
        self._document = weakref.ref(session.config)
        self._documents = 0

    def rows(self) -> Sequence[Row]:
        """The frames, which session and which document this is, and the version."""
        if self._document() is not self._session.config:
            self._document = weakref.ref(self._session.config)
            self._documents += 1
        frames = sorted(self._session.tree.frames)
        return [
            Row("names/frames", "", "names", value=frames),
            Row("names/session", "", "names", value=self._session_value),
            Row("names/document", "", "names", value=self._documents),
            Row("names/version", "", "names", value=__version__),
        ]
