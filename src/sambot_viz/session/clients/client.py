"""One client of a session: its tools, its selection, its view."""

from __future__ import annotations

import viser

from sambot_viz.session.clients.client_tools import ClientTools
from sambot_viz.session.clients.client_view import ClientView
from sambot_viz.session.signals import Change


class Client:
    """One open page.

    Args:
        client: viser's handle of it.
        change: changes what belongs to this client, and sends it to it alone.
        view: its view and its camera.
        tools: its current tool, selection and measurement.

    Attributes:
        client: viser's handle of it.
        client_id: its number.
        view: its view and its camera.
        tools: its current tool, selection and measurement.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        change: Change,
        view: ClientView,
        tools: ClientTools,
    ) -> None:
        self.client = client
        self.client_id = client.client_id
        self.change = change
        self.view = view
        self.tools = tools

    def download(self, name: str, content: bytes) -> None:
        """Have the page save a file on its user's own computer."""
        self.client.send_file_download(name, content, save_immediately=True)
        self.client.flush()

    def close(self) -> None:
        """Follow the session no longer: the page was closed."""
        self.tools.close()
        self.view.close()
