"""A part of the page that cannot be drawn says so, and the others stay."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from patience import until
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

_BREAK = """import("sambot/window/panels.js").then(({ TABS }) => {
  const whole = TABS.frames.content;
  window.isBroken = true;
  TABS.frames.content = (props) => {
    if (window.isBroken) throw new Error("no such thing");
    return whole(props);
  };
})"""


def test_a_panel_that_fails_says_so_and_can_be_shown_again(
    viz_for_all: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz_for_all.url)
    viewer.expects_errors = True
    user = viewer.user
    viewer.page.evaluate(_BREAK)
    user.tab("Frames")
    user.reads("Frames cannot be shown: no such thing.")
    until(lambda: any("no such thing" in error for error in viewer.errors()))
    # The rest is there and works.
    user.row("Displays", "Grid")
    user.tab("Joints")
    user.row("Joints", "drivewhl_l_joint")
    user.tab("Frames")
    viewer.page.evaluate("isBroken = false")
    user.click("button", "Show it again")
    user.row("Frames", "Static transforms")
