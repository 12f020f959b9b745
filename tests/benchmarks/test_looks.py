"""A picture in Studio beside one in RViz's look: drawn in turn, in one page.

python -m pytest tests/benchmarks/test_looks.py -s
"""

from __future__ import annotations

import statistics
from typing import Any

import pytest
from recorded_page import open_page
from viewer_page import viewer_url

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium

MOST = 1.2
"""What a picture in Studio may take, as a part of one in RViz's look."""
ROUNDS = 8
_DRAW = """(async () => {
  const { setLook } = await import("sambot/view/look.js");
  setLook("LOOK");
  const { gl, scene, camera } = __viserMutable.scene.__r3f.root.getState();
  const moving = Object.values(__viserMutable.nodeRefFromName).find(
    (node) => node?.children?.some((one) => one.geometry?.type === "BoxGeometry"));
  const pixel = new Uint8Array(4);
  const took = [];
  for (let i = 0; i < 12; i += 1) {
    if (MOVES) moving.position.x += i % 2 ? 0.01 : -0.01;
    const begin = performance.now();
    gl.render(scene, camera);
    // Reading waits for the picture.
    gl.getContext().readPixels(0, 0, 1, 1, 6408, 5121, pixel);
    if (i > 3) took.push(performance.now() - begin);
    await new Promise((done) => setTimeout(done, 0));
  }
  return took;
})()"""


@pytest.mark.parametrize("moves", [False, True], ids=["camera", "robot"])
def test_a_picture_in_studio_takes_little_more_than_in_rvizs_look(
    chromium: Chromium, moves: bool
) -> None:
    took: dict[str, list[float]] = {"rviz": [], "studio": []}
    with Visualizer(port=0, panels=False) as viz:
        page = open_page(chromium, 1000, 750)
        page.goto(viewer_url(viz.url, 1.0))
        page.wait_for("window.sambotVizLook?.labels === 5", 60.0)
        # Near enough for the robot to fill the picture.
        page.evaluate("__viserMutable.cameraControl.dollyTo(1.4, false)")
        for _ in range(ROUNDS):
            for look, times in took.items():
                script = _DRAW.replace("LOOK", look)
                drawn: Any = page.evaluate(
                    script.replace("MOVES", "true" if moves else "false")
                )
                times += drawn
        page.close()
    rviz, studio = (statistics.median(times) for times in took.values())
    ratio = studio / rviz
    print(f"\nRViz {rviz:.1f} ms, Studio {studio:.1f} ms: {ratio:.2f}")
    assert ratio < MOST
