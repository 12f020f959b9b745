"""Tasks with what leaves the page: links, exported pages, other screens, a class."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from desk import Desk
from judge import nothing_is_cut_off
from recorded_page import open_page
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium

pytestmark = pytest.mark.browser

LEFT = "drivewhl_l_joint"


def number(viewer: ViewerPage) -> str:
    return str(viewer.user.row("Joints", LEFT).one("textbox").value)


@pytest.mark.slow
def test_task_72_a_link_for_another_browser(
    s: Desk, open_more: Callable[..., ViewerPage]
) -> None:
    user = s.user
    user.enter(user.row("Joints", LEFT).one("textbox"), "0.75")
    user.enter(user.row("Views", "Yaw").one("textbox"), "2")
    user.click_on(user.row("Displays", "Grid").one("checkbox"))
    s.settle()
    user.menu("Edit", "Copy permalink")
    user.until(lambda: user.clipboard.startswith(f"{s.viz.url}/#"))
    other = open_more(address=user.clipboard)
    other.user.reads("Opened the link")
    other.user.until(lambda: number(other) == "0.75")
    other.user.until(lambda: other.user.row("Views", "Yaw").one("textbox").value == "2")
    other.user.until(
        lambda: not other.user.row("Displays", "Grid").one("checkbox").is_on
    )


@pytest.mark.slow
@pytest.mark.view
def test_task_73_a_page_that_needs_no_program(s: Desk, chromium: Chromium) -> None:
    user = s.user
    user.menu("File", "Export Page…")
    user.click("radio", re.compile("^All joints"), ("dialog", "Export Page"))
    user.click("button", "Export", ("dialog", "Export Page"))
    file = s.downloads / "sam_bot.html"
    user.until(lambda: file.exists() and b"</html>" in file.read_bytes(), 30.0)
    page = open_page(chromium, 800, 640)
    try:
        page.goto(f"file://{file}?fixedDpr=0.1")
        page.wait_for("document.querySelector('#sambot[data-ready]')", 30.0)
        alone = ViewerPage(page, page.requests[0])
        # The nodes of the file have names of their own, as a page that is new.
        still = turns(alone)
        alone.user.click("button", "Play")
        alone.user.until(lambda: turned(still, turns(alone)), 30.0)
        asked = [url for url in page.requests if not url.startswith("file:")]
        assert asked == [] and alone.errors() == []
    finally:
        page.close()
        file.unlink()


def turns(viewer: ViewerPage) -> dict[str, list[float]]:
    """Node → how it is turned below its parent: x, y, z, w."""
    return viewer.page.evaluate(
        "Object.fromEntries(Object.entries(__viserMutable.nodeRefFromName)"
        ".filter(([, node]) => node)"
        ".map(([name, node]) => [name, node.quaternion.toArray()]))"
    )


def turned(before: dict[str, list[float]], now: dict[str, list[float]]) -> list[str]:
    """The nodes that have turned by more than a radian."""
    return [n for n in before if abs(np.dot(before[n], now[n])) < np.cos(0.5)]


@pytest.mark.parametrize(
    ("size", "scale"), [((1920, 1080), 2.0), ((1910, 1075), 0.67), ((1024, 600), 1.0)]
)
def test_task_75_large_and_small_screens(
    s: Desk, size: tuple[int, int], scale: float
) -> None:
    s.page.set_viewport(*size, scale)
    try:
        s.settle()
        nothing_is_cut_off(s)
        _, _, width, height = s.viewer.view_box()
        assert width * height > 0.3 * size[0] * size[1]
        assert s.page.evaluate("document.documentElement.scrollWidth") <= size[0]
    finally:
        s.page.set_viewport(1280, 720)
        s.user.find("button", "Interact", ("toolbar", "Tools"))


def test_task_76_a_viewer_of_a_class_requests_control(
    make_viz: Callable[..., Visualizer], open_viewer: Callable[..., ViewerPage]
) -> None:
    viz = make_viz(presenter="")
    assert viz.presenter_url is not None
    teacher, pupil = open_viewer(viz.presenter_url), open_viewer(viz.url)

    def is_off() -> bool:
        return pupil.user.row("Joints", LEFT).one("slider").state("disabled")

    pupil.user.until(is_off)
    pupil.page.mouse.move(
        *pupil.user.go_to(pupil.user.row("Joints", LEFT).one("slider"))
    )
    pupil.user.has_tip("View only")
    pupil.user.click("button", re.compile("^People: "))
    pupil.user.enter(pupil.user.find("textbox", "Your name"), "Ann")
    teacher.user.reads("Ann requests control")
    teacher.user.click("button", "Give control to Ann")
    pupil.user.until(lambda: not is_off())
    pupil.user.enter(pupil.user.row("Joints", LEFT).one("textbox"), "0.5")
    teacher.user.until(lambda: number(teacher) == "0.5")
    teacher.user.click("button", re.compile("^People: "))
    teacher.user.click(
        "button", re.compile("^Take back control from"), ("dialog", "People")
    )
    pupil.user.until(is_off)
