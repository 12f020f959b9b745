"""A page goes on after messages that nobody should send."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hostile_recording import MESSAGES, STEP_S, all_tried, write_hostile
from inside import session_of
from viewer_page import ViewerPage
from visible_steps import steps_to

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser


@pytest.mark.view
def test_the_page_answers_after_hostile_messages(
    make_viz: Callable[..., Visualizer],
    open_viewer: Callable[..., ViewerPage],
    tmp_path: Path,
) -> None:
    tried = [one for one in all_tried() if one.is_attacked and one.number == 0]
    source, config = write_hostile(tmp_path, tried)
    viz = make_viz(source=f"bag:{source}", config=config)
    viz.player.pause()
    page = open_viewer(viz.url)
    for _ in steps_to(viz, MESSAGES * STEP_S, 5 * STEP_S):
        pass
    page.wait_for_frames()
    display = session_of(viz).scene.displays[0]
    row = page.user.row("Displays", display.config.name)
    page.user.click_on(row)
    page.user.keys("Delete")
    page.user.until(lambda: display not in session_of(viz).scene.displays)
    page.wait_for_frames()
    assert page.page.exceptions == []
