"""One browser of a session: what belongs to it alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import viser

from sambot_viz.session.shared_state import Listener
from sambot_viz.session.tool_control import ToolControl

if TYPE_CHECKING:
    from sambot_viz.session import Session


class Browser:
    """One browser.

    Args:
        session: what it shows.
        client: viser's handle of it.
    """

    def __init__(self, session: Session, client: viser.ClientHandle) -> None:
        self.client = client
        self.client_id = client.client_id
        self.tools: ToolControl = session.tools
        self.listeners: list[Listener] = []
