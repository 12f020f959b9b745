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

PALETTE = "Go to a display, joint, frame or command"


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


def test_a_topic_is_gone_to_from_anywhere(user: User) -> None:
    user.keys("Control+k")
    user.until(lambda: user.find("combobox", PALETTE).state("focused"))
    user.type("/scan")
    user.keys("Enter")
    # The panel was not open before.
    user.until(lambda: user.row("Topics", "/scan").state("focused"))


TREE = "Topics and their displays"


def names(viz: Visualizer) -> list[str]:
    return [one.name for one in session_of(viz).document.config.displays]


def test_a_topic_is_found_in_the_add_dialog_by_the_keyboard(
    viz: Visualizer, user: User
) -> None:
    before = names(viz)
    user.click("button", "Add", ("region", "Displays"))
    user.keys("Shift+Tab")
    user.until(lambda: user.find("tab", "By display type").state("focused"))
    user.keys("ArrowRight")
    user.until(lambda: user.find("tab", "By topic").state("selected"))
    user.until(lambda: "LaserScan" in user.rows(TREE))
    assert user.find("button", "Add", ("dialog", None)).state("disabled")
    user.keys("Tab")
    # The text is gone before the server has answered.
    user.type("odom")
    user.keys("Escape")
    user.until(lambda: "LaserScan" in user.rows(TREE))
    user.type("scan")
    # Enter goes to what is found, as soon as it is; the next one adds it.
    user.keys("Enter")
    user.until(lambda: user.row(TREE, "/scan").state("focused"))
    assert user.rows(TREE) == ["/scan", "LaserScan"]
    user.keys("ArrowDown")
    user.until(lambda: user.row(TREE, "/scan", "LaserScan").state("focused"))
    user.keys("Enter")
    user.gone("dialog", "Add Display")
    user.row("Displays", "LaserScan", "Topic")
    assert names(viz) == [*before, "LaserScan"]
    assert session_of(viz).document.config.displays[-1].get("Topic") == "/scan"
    user.until(lambda: not user.find("button", "Undo").state("disabled"))
    user.keys("Control+z")
    user.until(lambda: names(viz) == before)


def test_a_topic_is_dragged_into_the_tree_of_displays(
    viz: Visualizer, user: User
) -> None:
    before = names(viz)
    user.tab("Topics")
    x, y = user.go_to(user.row("Topics", "/scan").one("gridcell", "/scan"))
    left, top, _, _ = user.box(user.row("Displays", before[1]))
    mouse = user.page.mouse
    mouse.move(x, y)
    mouse.press()
    mouse.move(left + 40, top + 3)
    user.until(lambda: _line(user) == pytest.approx(top, abs=3))
    # Beside the tree nothing is meant.
    mouse.move(640, 300)
    user.until(lambda: _line(user) is None)
    mouse.move(left + 40, top + 2)
    user.until(lambda: _line(user) == pytest.approx(top, abs=3))
    mouse.release()
    user.until(lambda: user.row("Displays", "LaserScan").state("selected"))
    assert names(viz) == [before[0], "LaserScan", *before[1:]]
    assert _line(user) is None


def _line(user: User) -> float | None:
    """How high on the page the line is that shows a place between displays [px]."""
    where = (
        "(line => line && !line.hidden ? line.getBoundingClientRect().top : null)"
        "(document.querySelector('.drop'))"
    )
    found = user.page.evaluate(where)
    return None if found is None else float(str(found))
