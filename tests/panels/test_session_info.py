"""What the status bar shows to everyone."""

from __future__ import annotations

from panel_rows import data_of
from patience import patience

from sambot_viz.panels.session_info import StatusBarPanel
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client


def test_nothing_is_being_read_at_rest(session: Session, client: Client) -> None:
    assert session.scene.context.assets.wait(patience(30.0))
    assert data_of(StatusBarPanel(session.scene))["statusbar/progress"] is None
