"""What belongs to one browser alone: its tool, its selection, its view."""

from __future__ import annotations

from typing import TYPE_CHECKING

import viser

from sambot_viz.session.browser.tool_control import ToolControl
from sambot_viz.session.browser.view import BrowserView
from sambot_viz.session.signals import Change

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
        change: changes what belongs to this browser, and sends it to it alone.
        view: its view and its camera.
        tools: its current tool, selection and measurement.
    """

    def __init__(self, session: Session, client: viser.ClientHandle) -> None:
        self.client = client
        self.client_id = client.client_id
        self.change = Change(session.worker, client)
        self.view = BrowserView(session, self)
        self.tools = ToolControl(session, self)

    def close(self) -> None:
        """It has left: follow the session no longer."""
        self.tools.close()
        self.view.close()
