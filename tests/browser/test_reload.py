"""A save with a mistake, as a user of the page sees it."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from inside import node_of
from patience import patience, until
from viewer_page import Pixels, ViewerPage

from sambot_viz import Visualizer, bundled

pytestmark = pytest.mark.browser

LINK = "drivewhl_l_link"
NOTE = "showing the last version that worked"


@pytest.fixture
def model(tmp_path: Path) -> Path:
    shutil.copytree(bundled.assets_folder(), tmp_path, dirs_exist_ok=True)
    return tmp_path / "sam_bot.urdf.xacro"


@pytest.fixture
def viz(model: Path) -> Iterator[Visualizer]:
    with Visualizer(model, port=0, look="rviz", watch=True) as viz:
        yield viz


def shows(text: str) -> str:
    """The condition that the page shows a text."""
    return f"document.body.innerText.includes({text!r})"


def settled_picture(viewer: ViewerPage) -> Pixels:
    """The picture once nothing is missing in it any more, such as a name."""
    viewer.wait_for("window.sambotVizLook?.labels > 0")
    end = time.monotonic() + patience(30.0)
    before, after = viewer.pixels(), viewer.pixels()
    while not np.array_equal(before, after):
        assert time.monotonic() < end, "the picture kept changing"
        before, after = after, viewer.pixels()
    return after


@pytest.mark.view
def test_a_mistake_is_shown_beside_the_last_good_robot_until_it_is_fixed(
    viz: Visualizer, model: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url)
    viewer.wait_for_nodes(node_of(viz, LINK))
    viewer.wait_for(f"!({shows('Problems')})")
    viewer.settle(viz)
    before = settled_picture(viewer)
    content = model.read_text("utf-8")
    line = content[: content.rindex("</robot>")].count("\n") + 1

    model.write_text(content.replace("</robot>", "</rob>"), "utf-8")
    viewer.wait_for(shows(NOTE))
    viewer.wait_for(shows(f"{model.name}:{line}"))
    viewer.user.find("button", "Problems: 1 error")
    for frame in ("base_link", LINK):
        place = [float(v) for v in viz.frames.lookup("base_link", frame).translation]
        until(lambda p=place: not viewer.is_covered(*viewer.project("", p)))
    # The list lies over the view: nothing gets smaller while somebody types elsewhere.
    viewer.settle(viz)
    until(lambda: np.array_equal(settled_picture(viewer), before))
    # Opened by a hand, it is beside the view.
    viewer.user.click("button", "Problems: 1 error")
    viewer.user.gone("treegrid", "Problems")
    viewer.user.click("button", "Problems: 1 error")
    viewer.user.find("treegrid", "Problems")
    viewer.user.until(lambda: settled_picture(viewer).shape[0] < before.shape[0])
    viewer.user.click("button", "Close Problems")

    model.write_text(content, "utf-8")
    viewer.wait_for(f"!({shows(NOTE)})")
    viewer.wait_for(f"!({shows('Problems')})")


def test_what_was_refused_goes_away_with_its_joint_and_comes_back_from_a_fold(
    viz: Visualizer, model: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    # An error of the page fails the test: `open_viewer` sees to that.
    viewer = open_viewer(viz.url)
    user, content = viewer.user, model.read_text("utf-8")
    assert "${name}_joint" in content
    for end in ("axle", "joint"):
        other = "joint" if end == "axle" else "axle"
        joint = user.row("Joints", f"drivewhl_l_{other}")
        user.enter(joint.one("textbox"), "")
        user.until(lambda: "Enter a number" in user.see().text)
        model.write_text(content.replace("${name}_joint", f"${{name}}_{end}"), "utf-8")
        user.row("Joints", f"drivewhl_l_{end}")
        viewer.wait_for("!document.querySelector('.validation')")
        names = [f"drivewhl_{side}_{end}" for side in "lr"]
        user.until(lambda names=names: user.rows("Joints") == names)

    user.unfold("Displays", "Grid")
    user.enter(user.row("Displays", "Grid", "Cell Size").one("textbox"), "")
    user.until(lambda: "Enter a number" in user.see().text)
    user.unfold("Displays", "Grid", fold=True)
    user.until(lambda: "Enter a number" not in user.see().text)
    user.unfold("Displays", "Grid")
    user.until(lambda: "Enter a number" in user.see().text)
