"""The look Studio: chosen in the menu View, kept by the browser, and drawn."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

Open = Callable[..., ViewerPage]
LOOK = "window.sambotVizLook"


@pytest.fixture
def viewer(make_viz: Callable[..., Visualizer], open_viewer: Open) -> ViewerPage:
    """A page that begins with RViz's look."""
    viz = make_viz(look="rviz")
    viewer = open_viewer(viz.url)
    viewer.wait_for(f"{LOOK}?.labels === 5")
    viewer.settle(viz)
    return viewer


def choose(viewer: ViewerPage, look: str) -> None:
    viewer.user.click("menuitem", "View")
    viewer.user.click("menuitemcheckbox", f"Look: {look}")


def test_the_menu_changes_the_look_and_back_and_the_browser_keeps_it(
    viewer: ViewerPage,
) -> None:
    before = viewer.pixels()
    assert viewer.page.evaluate(f"{LOOK}.studio") == 0
    choose(viewer, "Studio")
    viewer.wait_for(f"{LOOK}.studio > 0")
    viewer.user.until(lambda: not np.array_equal(viewer.pixels(), before))
    choose(viewer, "RViz")
    viewer.user.until(lambda: np.array_equal(viewer.pixels(), before))
    choose(viewer, "Studio")
    viewer.page.goto(viewer.url)
    viewer.wait_for(f"{LOOK}?.studio > 0 && {LOOK}.lit === 0")
