"""The Compare panel: a row of the table lights its link, and leads to its text."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from viewer_page import ViewerPage

from sambot_viz import Visualizer, bundled

pytestmark = [pytest.mark.browser, pytest.mark.view]

# Draws after all else: what a row lights.
GLOWING = """(() => {
  let found = 0;
  __viserMutable.scene.traverse(one => { found += one.renderOrder === 10; });
  return found;
})()"""
LINE = "document.querySelector('.model .cm-activeLine')?.textContent ?? ''"


def test_a_row_lights_its_link_or_the_ghost_and_leads_to_the_text(
    tmp_path: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    sam_bot = bundled.model_path()
    text = sam_bot.read_text("utf-8")
    begin, end = text.index('<link name="front_caster"'), text.index("</robot>")
    model = tmp_path / "mine.urdf.xacro"
    model.write_text(text[:begin].replace('"0.18"', '"0.14"') + text[end:])
    with Visualizer(model, reference=sam_bot, port=0, look="rviz") as viz:
        viewer = open_viewer(viz.url)
        user, page = viewer.user, viewer.page
        user.click("tab", "Compare")
        user.reads("420 310 140 mm")
        assert page.evaluate(GLOWING) == 0
        user.click("row", "link front_caster none there")
        user.until(lambda: page.evaluate(GLOWING) == 1)
        user.keys("ArrowUp")
        user.until(
            lambda: (
                page.evaluate("document.activeElement.textContent")[:14]
                == "link base_link"
            )
        )
        user.keys("Enter")
        # The selection ends where the link does.
        user.until(lambda: page.evaluate(LINE).strip() == "</link>")
        assert page.evaluate(GLOWING) == 0
