"""A session with one browser, for the tests of its panels."""

from __future__ import annotations

from collections.abc import Callable
from urllib.parse import urlsplit

import pytest
from inside import viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client


@pytest.fixture
def join(
    viz: Visualizer, session: Session, protocol: Callable[..., ProtocolClient]
) -> Callable[[], Client]:
    """Open the page in one more browser."""

    def open_page() -> Client:
        before = set(session.clients.all)
        protocol(urlsplit(viz.url).port or 0).settle(viser_server(viz))
        (new,) = session.clients.all.keys() - before
        return session.clients.all[new]

    return open_page


@pytest.fixture
def client(join: Callable[[], Client]) -> Client:
    return join()
