"""Displays of data in the page: what only a browser can tell."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from inside import session_of
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

DRAWN = """(() => {
  let size = 0;
  window.__viserMutable.scene.traverse((one) => {
    if (one.userData.drawAs === "points" && one.isMesh) size = one.userData.size[0];
  });
  return size;
})()"""
"""The size of the points that the page draws."""
CASE = Path(__file__).parents[1] / "golden" / "messages" / "cloud_intensity_points"


def test_what_was_drawn_before_is_freed(
    make_viz: Callable[..., Visualizer], open_viewer: Callable[..., ViewerPage]
) -> None:
    source = f"bag:{CASE / 'messages.mcap'}"
    viz = make_viz(source=source, config=CASE / "config.rviz")
    viz.player.pause()
    viz.player.jump(viz.player.duration)
    page = open_viewer(viz.url)
    session = session_of(viz)
    (cloud,) = (d for d in session.scene.displays if d.kind.endswith("PointCloud2"))

    def drawn() -> int:
        return int(page.page.evaluate("window.sambotVizLook.geometries"))

    counts = list[int]()
    for size in range(10, 25):
        session.display_edits.set_property(cloud, "Size (Pixels)", float(size))
        page.user.until(lambda size=size: page.page.evaluate(DRAWN) == size)
        page.wait_for_frames()
        counts.append(drawn())
    assert max(counts[5:]) <= max(counts[:5]) + 1
