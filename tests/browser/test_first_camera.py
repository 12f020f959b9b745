"""What is seen of the view while the page is loaded."""

from __future__ import annotations

import pytest
from patience import patience
from recorded_page import open_page
from viewer_page import viewer_url

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium

pytestmark = pytest.mark.browser

# Whether the canvas of the view is seen, for each picture, and the camera in it.
WATCH = """(() => {
  window.seenCameras = [];
  const look = () => {
    const canvas = document.querySelector("#root canvas");
    if (canvas && getComputedStyle(canvas).visibility === "visible")
      window.seenCameras.push(window.sambotVizCamera?.number ?? null);
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
})()"""
UNSEEN = "window.seenCameras.filter(number => number === null).length"


def test_the_view_is_seen_from_the_camera_of_its_config_on(chromium: Chromium) -> None:
    with Visualizer(port=0, look="rviz") as viz:
        page = open_page(chromium, 640, 480)
        page.call("Page.addScriptToEvaluateOnNewDocument", {"source": WATCH})
        # At first, and when it is loaded again.
        for _ in range(2):
            page.goto(viewer_url(viz.url))
            page.wait_for("window.seenCameras.length > 0", patience(30.0))
            assert page.evaluate(UNSEEN) == 0
        page.close()


# The camera of the server is never placed; and time goes faster.
NO_CAMERA = """(() => {
  const set = window.setTimeout;
  window.setTimeout = (call, wait, ...more) => set(call, Math.min(wait, 500), ...more);
  const wait = setInterval(() => {
    const page = window.__viserMutable;
    if (!page) return;
    clearInterval(wait);
    Object.defineProperty(page, "cameraControl", { get: () => null, set: () => {} });
  }, 1);
})()"""


def test_a_view_without_a_camera_is_seen_all_the_same(chromium: Chromium) -> None:
    with Visualizer(port=0, look="rviz") as viz:
        page = open_page(chromium, 640, 480)
        for source in (WATCH, NO_CAMERA):
            page.call("Page.addScriptToEvaluateOnNewDocument", {"source": source})
        page.goto(viewer_url(viz.url))
        page.wait_for("window.seenCameras.length > 0", patience(30.0))
        assert page.evaluate("window.sambotVizCamera.number") is None
        page.close()
