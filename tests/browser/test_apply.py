"""The button Apply in Problems: a user fixes the model without an editor."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options

pytestmark = pytest.mark.browser

GOOD = """<robot name="r">
<link name="hull"/>
<link name="arm"/>
<link name="leg"/>
<joint name="a" type="revolute"><parent link="hull"/><child link="arm"/>
  <origin xyz="0 0 1"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="b" type="fixed"><parent link="hull"/><child link="leg"/></joint>
</robot>
"""
TWO_ERRORS = GOOD.replace('parent link="hull"', 'parent link="hul"', 1).replace(
    'child link="leg"', 'child link="lag"'
)


@pytest.fixture
def model(tmp_path: Path) -> Path:
    file = tmp_path / "r.urdf"
    file.write_text(TWO_ERRORS.replace("origin xyz", "origin xzy"), "utf-8")
    return file


@pytest.fixture
def viz(model: Path) -> Iterator[Visualizer]:
    options = Options(model, edit=True, watch=True, look="rviz")
    with Visualizer.of_inputs(Inputs(options, may_be_broken=True)) as viz:
        yield viz


def test_fixes_are_applied_by_mouse_and_by_keyboard_and_undone(
    viz: Visualizer, model: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url)
    user = viewer.user
    # The list has opened for the errors.
    user.click("button", "Apply")
    user.reads('Applied: write link="hull" in r.urdf line 5')
    user.until(lambda: not user.there("row", re.compile("'hul'")))

    # What the second click of a double one hits is another fix.
    first, second = model.read_text("utf-8"), user.find("button", "Apply")
    user.page.mouse.move(*user.go_to(second))
    user.page.mouse.press(clicks=2)
    user.page.mouse.release(clicks=2)
    viewer.settle(viz)
    assert model.read_text("utf-8") == first
    user.click_on(second)
    user.reads("r.urdf line 8")

    # The robot is there; the list stays for what is left.
    user.row("Joints", "a")
    warning = user.find("row", re.compile("attribute xzy"))
    user.click_on(warning)
    user.keys("ArrowRight")
    user.find("button", "Apply")
    user.keys("ArrowDown", "Tab", "Enter")
    user.reads('Applied: write xyz="0 0 1" in r.urdf line 6')
    user.find("row", "No problems.")
    assert model.read_text("utf-8") == GOOD

    user.click("button", "Undo")
    user.reads("Undone: Fix in r.urdf")
    user.find("row", re.compile("attribute xzy"))
    assert model.read_text("utf-8") == GOOD.replace("origin xyz", "origin xzy")
