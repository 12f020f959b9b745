"""The question mark beside a problem: what its code means, on a telephone too."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.explanations import as_html, codes
from sambot_viz.export.chromium import Chromium
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options

pytestmark = pytest.mark.browser
TOO_WIDE = "document.documentElement.scrollWidth > innerWidth"


@pytest.fixture
def viz(tmp_path: Path) -> Iterator[Visualizer]:
    model = tmp_path / "robot.urdf"
    model.write_text('<robot name="r"></robot>\n<link name="a"/>\n', "utf-8")
    options = Options(model, watch=True, look="rviz")
    with Visualizer.of_inputs(Inputs(options, may_be_broken=True)) as viz:
        yield viz


def test_the_link_beside_a_problem_opens_a_page_that_fits_a_telephone(
    viz: Visualizer, open_viewer: Callable[..., ViewerPage], chromium: Chromium
) -> None:
    viewer = open_viewer(viz.url)
    code = "xml-root-closed-early"
    viewer.user.find("link", f"What {code} means, with an example")
    place = viewer.page.evaluate("document.querySelector('a.about').href")
    assert place == f"{viz.url}/help/{code}"

    longest = max(codes(), key=lambda code: len(as_html(code)))
    widest = max(codes(), key=lambda code: max(map(len, as_html(code).split())))
    page = chromium.open(width=390, height=844)
    try:
        for read in (code, longest, widest, ""):
            page.goto(f"{viz.url}/help/{read}")
            page.wait_for(f"document.body.innerText.includes({read!r})")
            assert page.evaluate("getComputedStyle(document.body).fontSize") == "16px"
            assert not page.evaluate(TOO_WIDE), read
    finally:
        page.close()
