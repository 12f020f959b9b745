"""A session with one browser, for the tests of its panels."""

from __future__ import annotations

from collections.abc import Callable
from urllib.parse import urlsplit

import pytest
from inside import viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session import Session
from sambot_viz.session.browser.browser import Browser


@pytest.fixture
def join(
    viz: Visualizer, session: Session, protocol: Callable[..., ProtocolClient]
) -> Callable[[], Browser]:
    """Open the page in one more browser."""

    def open_page() -> Browser:
        before = set(session.browsers)
        protocol(urlsplit(viz.url).port or 0).settle(viser_server(viz))
        (new,) = session.browsers.keys() - before
        return session.browsers[new]

    return open_page


@pytest.fixture
def browser(join: Callable[[], Browser]) -> Browser:
    return join()
