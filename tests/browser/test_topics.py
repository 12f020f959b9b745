"""The Topics panel: what a recording has, and why nothing of a topic is seen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser


@pytest.fixture
def user(
    make_viz: Callable[..., Visualizer],
    open_viewer: Callable[..., ViewerPage],
    repository: Path,
) -> User:
    viz = make_viz(source=f"bag:{repository / 'assets' / 'square.mcap'}")
    return open_viewer(viz.url).user


def test_a_topic_that_shows_nothing_says_why_and_a_search_finds_it(user: User) -> None:
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
