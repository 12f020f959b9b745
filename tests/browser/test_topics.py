"""The Topics panel: what a recording has, and why nothing of a topic is seen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from inside import session_of
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser


@pytest.fixture
def viz(make_viz: Callable[..., Visualizer], repository: Path) -> Visualizer:
    return make_viz(source=f"bag:{repository / 'assets' / 'square.mcap'}")


@pytest.fixture
def user(viz: Visualizer, open_viewer: Callable[..., ViewerPage]) -> User:
    return open_viewer(viz.url).user


def test_a_topic_is_found_by_a_search_and_a_display_is_added_for_it(
    viz: Visualizer, user: User
) -> None:
    user.click_on(user.find("tab", "Topics"))
    user.until(lambda: "/scan" in user.rows("Topics"))
    assert "/tf" in user.rows("Topics")
    user.click_on(user.find("searchbox", "Search topics"))
    # Enter goes to what is found, though nothing is until the server has searched.
    user.type("scan")
    user.keys("Enter")
    user.until(
        lambda: "/scan" in user.rows("Topics") and "/tf" not in user.rows("Topics")
    )
    user.until(lambda: user.row("Topics", "/scan").state("focused"))
    user.click("button", "Add display")
    user.row("Displays", "LaserScan", "Topic")
    added = session_of(viz).document.config.displays[-1]
    assert added.get("Topic") == "/scan"
