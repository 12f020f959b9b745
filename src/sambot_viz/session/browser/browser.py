"""What belongs to one browser alone: its tool, its selection, its view."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import viser

from sambot_viz.session.browser.tool_control import ToolControl
from sambot_viz.session.browser.view import BrowserView
from sambot_viz.session.shared_state import Event, Listener

if TYPE_CHECKING:
    from sambot_viz.session import Session


class Browser:
    """One browser of a session.

    Args:
        session: what it is shown.
        client: viser's handle of it.

    Attributes:
        client: viser's handle of it.
        client_id: its number.
        listeners: called after a change of its tools ("tools") or of its view ("view"),
            with the session locked.
        view: its view and its camera.
        tools: its current tool, selection and measurement.
    """

    def __init__(self, session: Session, client: viser.ClientHandle) -> None:
        self.client = client
        self.client_id = client.client_id
        self.listeners: list[Listener] = []
        self._session = session
        self.view = BrowserView(session, self)
        self.tools = ToolControl(session, self)

    @contextmanager
    def change(self, *events: Event) -> Generator[None]:
        """Change what belongs to this browser; send it together; notify listeners."""
        with self._session.lock:
            with self.client.atomic():
                yield
                for event in events:
                    self._session.call(self.listeners, event)
            self.client.flush()

    def close(self) -> None:
        """It has left: follow the session no longer."""
        self.tools.close()
        self.view.close()
