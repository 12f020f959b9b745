"""What the page costs a browser and the network."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
import robots
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

Open = Callable[..., ViewerPage]
COUNT = 60
ROWS = "document.querySelectorAll('#sambot .joints .k-slider')"


@pytest.fixture(scope="module")
def viewer(
    tmp_path_factory: pytest.TempPathFactory, open_for_all: Open
) -> Iterator[ViewerPage]:
    """So many joints that they are in groups."""
    model = tmp_path_factory.mktemp("cost") / "chain.urdf"
    model.write_text(robots.chain(COUNT), "utf-8")
    with Visualizer(model, port=0, look="rviz") as viz:
        viewer = open_for_all(viz.url, view=True)
        yield viewer
        # The server is closed before the page is.
        assert viewer.errors() == []
        viewer.expects_errors = True


def test_a_page_at_rest_sends_and_gets_nothing(viewer: ViewerPage) -> None:
    viewer.wait_until_drawn()
    assert viewer.page.messages > 0
    # It takes a moment to come to rest.
    assert any(is_quiet(viewer, 1.5) for _ in range(4))


def is_quiet(viewer: ViewerPage, seconds: float) -> bool:
    before = viewer.page.messages
    viewer.page.evaluate(f"new Promise(done => setTimeout(done, {1000 * seconds}))")
    return viewer.page.messages == before


def test_a_page_at_rest_draws_nothing(viewer: ViewerPage) -> None:
    viewer.wait_until_drawn()
    assert any(draws_nothing(viewer, 2.5) for _ in range(4))
    # The same after the tab was hidden and shown.
    viewer.minimize()
    viewer.minimize(False)
    viewer.wait_until_drawn()
    assert any(draws_nothing(viewer, 2.5) for _ in range(4))


def draws_nothing(viewer: ViewerPage, seconds: float) -> bool:
    """Whether no picture is drawn; before, viser drew one each second."""
    pictures = "sambotVizLook.frames"
    before = viewer.page.evaluate(pictures)
    viewer.page.evaluate(f"new Promise(done => setTimeout(done, {1000 * seconds}))")
    return viewer.page.evaluate(pictures) == before


def test_a_joint_is_a_few_elements_and_a_folded_one_none(viewer: ViewerPage) -> None:
    tree = "document.querySelector('#sambot .joints [role=treegrid]')"
    viewer.wait_for(f"{tree}.ariaRowCount > {COUNT} && {ROWS}.length")
    most = viewer.page.evaluate(
        f"Math.max(...[...{ROWS}].map(row => row.querySelectorAll('*').length))"
    )
    assert most <= 13
    viewer.user.click("button", "Collapse all groups")
    viewer.wait_for(f"{ROWS}.length === 0")
