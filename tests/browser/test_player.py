"""The player below the view: keys that go through a recording, and its times."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from inside import session_of
from recorded_page import open_page
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium

SKY = (700, 160)

pytestmark = pytest.mark.browser


@pytest.fixture
def viz(make_viz: Callable[..., Visualizer], repository: Path) -> Visualizer:
    return make_viz(source=f"bag:{repository / 'assets' / 'square.mcap'}")


@pytest.fixture
def user(viz: Visualizer, open_viewer: Callable[..., ViewerPage]) -> User:
    return open_viewer(viz.url).user


def test_keys_go_through_a_recording_where_nothing_else_has_them(
    viz: Visualizer, user: User
) -> None:
    data = session_of(viz).data
    assert data is not None and data.player is not None
    player = data.player
    user.find("button", "Pause")
    user.keys(" ")
    user.until(lambda: not player.playback.value.playing)
    user.page.mouse.click(*SKY)
    user.keys("End")
    user.until(lambda: player.time_ns == player.end_ns)
    user.find("button", "Time: 0:19.969 / 0:20.0")
    user.keys("ArrowLeft")
    user.until(lambda: player.time_ns == player.end_ns - 10**9)

    user.click_on(user.row("Displays", "Grid"))
    user.keys("Home")
    user.until(lambda: user.row("Displays", "Global Options").state("focused"))
    assert player.time_ns == player.end_ns - 10**9
    user.click("button", "Time: 0:18.969 / 0:20.0")
    user.reads("ROS Elapsed")


def test_on_a_phone_the_time_bar_has_the_width_of_the_screen(
    viz: Visualizer, chromium: Chromium
) -> None:
    page = open_page(chromium, 390, 844, touch=True)
    page.goto(viz.url)
    user = User(page, finger=True)
    left, _, width, _ = user.box(user.find("slider", "Time"))
    assert left < 20 and width > 350
    for button in ("Loop", "Next message"):
        assert user.can_see(user.find("button", button))
    page.close()
