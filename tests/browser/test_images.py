"""The Images panel: the picture of a camera beside that of RViz's panel."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from inside import session_of
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

CASES = Path(__file__).parents[1] / "golden" / "images"
WIDTH, HEIGHT = 342, 203
"""The size of the recorded panels [pixels]."""
PLACE = f"""(() => {{
  const place = document.querySelector(".camera .picture");
  Object.assign(place.style, {{ position: "fixed", left: "0", top: "0", zIndex: 99,
    width: "{WIDTH}px", height: "{HEIGHT}px" }});
}})()"""
SHOWN = "document.querySelector('.camera canvas')?.width === 8"
OTHER_TAB = "document.querySelector('[data-tab=topics]').click()"
TAB = "document.querySelector('[data-tab=images]').click()"


def test_the_panel_shows_what_rvizs_shows(
    make_viz: Callable[..., Visualizer],
    open_viewer: Callable[..., ViewerPage],
) -> None:
    """Of other encodings, tests/displays/data/test_image.py has the pixels."""
    folder = CASES / "image_rgb8"
    source = f"bag:{folder / 'messages.mcap'}"
    viz = make_viz(source=source, config=folder / "config.rviz")
    viz.player.pause()
    viz.player.jump(viz.player.duration)
    session = session_of(viz)
    pictures, key = session.scene.context.pictures, session.scene.displays[1].key
    page = open_viewer(viz.url)
    page.page.wait_for("document.querySelector('[data-tab=images]')")
    page.page.evaluate(TAB)
    page.page.wait_for(SHOWN)
    page.page.evaluate(PLACE)
    page.wait_for_frames()
    values = json.loads((folder / "values.json").read_text())
    ours = page.screenshot()[:HEIGHT, :WIDTH]
    for probe in values["probes"]:
        column, row = probe["xy"]
        assert abs(ours[row, column][:3].astype(int) - probe["render_rgb"]).max() <= 8
    left, _, width, _ = values["image_rectangle_in_panel_xywh"]
    bars = [(int(left) - 2, 100), (int(left + width) + 3, 100)]
    for column, row in bars:
        assert ours[row, column][:3].tolist() == [239, 235, 231]
    assert page.errors() == []
    # Nobody looks any longer.
    page.page.evaluate(OTHER_TAB)
    page.user.until(lambda: not pictures.is_wanted(key))
