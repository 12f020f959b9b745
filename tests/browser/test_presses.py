"""Pressing moves nothing: what is under the pointer at a press is what is clicked."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import pytest
from presses import press_all
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

MIDDLE = pytest.param((1024, 768), marks=pytest.mark.slow)
SIZES = [(1280, 720), MIDDLE, (390, 844)]
TABS = ("Frames", "Selection", "Drive", "Tool Properties")
BESIDE = ("Displays", "Views", "Problems")
"""Panels that are tabs only where the window is narrow."""
DIALOGS = [
    ("File", "Open Config…"),
    ("File", "Save Config As…"),
    ("File", "Save Image…"),
    ("File", "Export Page…"),
    ("Edit", "Go to…"),
    ("Help", "Keys"),
]
# How much higher the rows of Displays are than what they are in [px].
_BEYOND = """(() => {
  const box = document.querySelector(".displays .treebox");
  const ends = [...box.querySelectorAll("[role=row]")].map((row) =>
    row.getBoundingClientRect().bottom);
  const top = box.getBoundingClientRect().top - box.scrollTop;
  return Math.ceil(Math.max(...ends) + 2 - top) - box.clientHeight;
})()"""


@pytest.fixture(scope="module")
def page_of(
    viz_for_all: Visualizer, open_for_all: Callable[..., ViewerPage]
) -> Callable[[tuple[int, int]], ViewerPage]:
    """The page with the bundled robot in a window of a size; a phone's is narrow."""
    return cache(partial(quick_page, open_for_all, viz_for_all))


def quick_page(
    opened: Callable[..., ViewerPage], viz: Visualizer, size: tuple[int, int]
) -> ViewerPage:
    """Open a page that draws no pictures: nobody looks at them."""
    width, height = size
    viewer = opened(viz.url, width=width, height=height, touch=width < 640)
    viewer.settle(viz)
    viewer.sleep()
    return viewer


@pytest.mark.parametrize("size", SIZES)
def test_a_press_in_a_panel_moves_nothing(
    page_of: Callable[[tuple[int, int]], ViewerPage], size: tuple[int, int]
) -> None:
    viewer = page_of(size)
    faults = press_all(viewer, least=20)
    for tab in (*TABS, *BESIDE) if size[0] < 1100 else TABS:
        viewer.user.tab(tab)
        if tab == "Frames":
            viewer.user.click("button", "Add static transform …")
        faults += press_all(viewer, "[role=tabpanel]", 0)
    assert faults == []


def test_a_press_moves_nothing_where_the_rows_just_fit(
    page_of: Callable[[tuple[int, int]], ViewerPage],
) -> None:
    viewer = page_of((1280, 720))
    viewer.user.menu("Panels", "Views")
    viewer.user.gone("treegrid", "Views")
    height = 720 + viewer.page.evaluate(_BEYOND)
    viewer.page.set_viewport(1280, height)
    viewer.user.until(lambda: viewer.page.evaluate(_BEYOND) == 0)
    assert press_all(viewer, ".displays", 30) == []


@pytest.mark.parametrize("size", [SIZES[0], SIZES[-1]])
def test_a_press_in_a_dialog_moves_nothing(
    page_of: Callable[[tuple[int, int]], ViewerPage], size: tuple[int, int]
) -> None:
    viewer = page_of(size)
    user = viewer.user
    faults: list[str] = []
    for head, entry in DIALOGS:
        user.menu("Menu" if size[0] < 640 else head, re.compile(entry))
        user.until(lambda: user.see().all("dialog"))
        faults += press_all(viewer, "dialog")
        user.keys("Escape")
        user.until(lambda: not user.see().all("dialog"))
    assert faults == []


@pytest.mark.parametrize("size", SIZES)
def test_a_press_in_what_pops_up_moves_nothing(
    page_of: Callable[[tuple[int, int]], ViewerPage], size: tuple[int, int]
) -> None:
    viewer = page_of(size)
    user = viewer.user
    faults: list[str] = []
    user.tab("Joints")
    for name in ("Poses", "Copy as"):
        user.click("button", name)
        faults += press_all(viewer, ".popped")
        user.keys("Escape")
    for head in ("File", "View") if size[0] > 1100 else ("Menu",):
        user.click("menuitem", head)
        faults += press_all(viewer, ".menu", 5)
        user.keys("Escape")
    if size[0] < 1100:
        user.tab("Displays")
    user.click("combobox", "Fixed Frame")
    user.click("combobox", "Fixed Frame")
    faults += press_all(viewer, ".choices", 3)
    assert faults == []


@pytest.mark.parametrize("size", SIZES)
def test_a_press_beside_a_recording_moves_nothing(
    make_viz: Callable[..., Visualizer],
    repository: Path,
    open_viewer: Callable[..., ViewerPage],
    size: tuple[int, int],
) -> None:
    viz = make_viz(source=f"bag:{repository / 'assets' / 'square.mcap'}")
    viewer = quick_page(open_viewer, viz, size)
    viewer.user.tab("Topics")
    viewer.user.row("Topics", "/tf")
    viewer.user.tab("Joints")
    viewer.user.tab("Topics")
    assert press_all(viewer, "[role=tabpanel], .player-bar, .statusbar", 10) == []
