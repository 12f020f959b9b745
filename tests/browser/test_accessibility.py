"""What axe-core finds in the page: nothing serious, in every panel, light and dark."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from patience import until
from recorded_page import RecordedPage, open_page
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium

pytestmark = pytest.mark.browser

AXE = Path(__file__).parents[1] / ".venv/node/node_modules/axe-core/axe.min.js"
RUN = """axe.run('#sambot').then(found => JSON.stringify(found.violations
  .filter(one => ['serious', 'critical'].includes(one.impact))
  .map(one => [one.id, one.nodes.map(node => node.html.slice(0, 200))])))"""
SAID = """axe.run('#sambot', {runOnly: ['label-content-name-mismatch']})
  .then(found => JSON.stringify(found.violations
    .flatMap(one => one.nodes.map(node => node.html.slice(0, 200)))))"""
TABS = ("Joints", "Frames", "Selection", "Drive", "Tool Properties")


def has_none(page: RecordedPage) -> None:
    """Wait until nothing is found: colours of another theme come little by little."""

    def finds_nothing() -> bool:
        violations: Any = json.loads(page.evaluate(RUN, timeout=60.0))
        assert violations == []
        return True

    until(finds_nothing)


def test_axe_finds_nothing_serious_in_light_and_in_dark(
    viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    if not AXE.is_file():
        pytest.skip("axe-core is not installed; bash tests/page/check installs it")
    viewer = open_viewer(viz.url)
    viewer.user.find("slider", "drivewhl_l_joint")
    viewer.page.evaluate(AXE.read_text("utf-8") + ";0")
    for tab in TABS:
        viewer.user.click("tab", tab)
        viewer.user.find("tabpanel", tab)
        for dark in (False, True):
            viewer.page.set_dark(dark)
            viewer.wait_for_frames()
            has_none(viewer.page)


def test_what_is_said_to_a_button_of_a_phone_is_what_is_written_on_it(
    viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    if not AXE.is_file():
        pytest.skip("axe-core is not installed; bash tests/page/check installs it")
    viewer = open_viewer(viz.url, width=390, height=844, touch=True)
    open_viewer(viz.url)
    viewer.user.find("button", "People: 2 browsers")
    viewer.page.evaluate(AXE.read_text("utf-8") + ";0")
    found = json.loads(viewer.page.evaluate(SAID, timeout=60.0))
    assert found == []


def test_axe_finds_nothing_serious_in_an_exported_page(
    viz: Visualizer, chromium: Chromium, tmp_path: Path
) -> None:
    if not AXE.is_file():
        pytest.skip("axe-core is not installed; bash tests/page/check installs it")
    viz.export(tmp_path / "robot.html")
    page = open_page(chromium, 800, 600)
    page.goto(f"file://{tmp_path}/robot.html")
    page.wait_for("document.querySelector('#sambot[data-ready]')", 30.0)
    page.evaluate(AXE.read_text("utf-8") + ";0")
    for dark in (False, True):
        page.set_dark(dark)
        has_none(page)
    page.close()
