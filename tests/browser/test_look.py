"""The page script takes effect: colours, names and order are RViz's."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from inside import session_of
from recorded_page import open_page
from viewer_page import ViewerPage

from sambot_viz import Visualizer, bundled, load_config, load_robot
from sambot_viz.export.chromium import Chromium

pytestmark = [pytest.mark.browser, pytest.mark.view]

Open = Callable[..., ViewerPage]
BACKGROUND, TOP, SIDE = (48, 48, 48), (19, 127, 127), (19, 96, 96)


@pytest.fixture
def viz(make_viz: Callable[..., Visualizer]) -> Visualizer:
    """A translucent sam_bot with its names, seen from RViz's default direction."""
    config = load_config(bundled.config_path())
    config.view.set("Distance", 1.5)
    for display in config.displays:
        if display.name == "RobotModel":
            display.set("Alpha", 0.6)
        else:
            display.set_enabled(display.name == "TF")
            if display.name == "TF":
                display.set("Show Axes", False)
                display.set("Show Arrows", False)
    return make_viz(config=config)


def shares(pixels: np.ndarray, color: tuple[int, int, int]) -> float:
    """The share of pixels that have a colour, give or take one."""
    near = np.abs(pixels[..., :3].astype(int) - color).max(axis=-1) <= 1
    return float(near.mean())


def test_lit_faces_background_and_names_have_rvizs_colours_and_names_no_box(
    viz: Visualizer, open_viewer: Open
) -> None:
    viewer = open_viewer(viz.url)
    viewer.wait_for("window.sambotVizLook?.labels === 5")
    viewer.settle(viz)
    pixels = viewer.pixels()
    # The numbers are RViz's own; without the script
    # faces are far lighter.
    assert shares(pixels, TOP) > 0.01
    assert shares(pixels, SIDE) > 0.01
    assert shares(pixels, BACKGROUND) > 0.5
    # Names are thin: few of their pixels are fully white.
    assert (pixels[..., :3].min(axis=-1) > 180).mean() > 0.0002
    # viser's boxes are 85 % white, which nothing else in this picture is.
    assert shares(pixels, (224, 224, 224)) < 0.001
    look = viewer.page.evaluate("window.sambotVizLook")
    assert look["lit"] > 0 and look["names"] > 0 and look["boxes"] > 0


def test_the_centre_of_mass_is_seen_through_the_robot(
    make_viz: Callable[..., Visualizer], open_viewer: Open
) -> None:
    config = load_config(bundled.config_path())
    config.view.set("Distance", 1.0)
    for display in config.displays:
        display.set_enabled(display.name == "RobotModel")
        if display.name == "RobotModel":
            display.set("Alpha", 1.0)
            display.set("Mass Properties/Balance", True)
    viz = make_viz(config=config, look="rviz")
    robot = load_robot(bundled.model_path("sam_bot_collision.urdf.xacro"))
    session_of(viz).show_robot(robot)
    viewer = open_viewer(viz.url)
    viewer.set_resolution(1.0)
    viewer.settle(viz)
    column, row = viewer.project("", (-0.05 / 16.5, 0.0, -0.095 / 16.5))

    def around() -> np.ndarray:
        return viewer.pixels()[row - 8 : row + 9, column - 8 : column + 9]

    # It is in the middle of an opaque box.
    viewer.user.until(lambda: shares(around(), (255, 210, 0)) > 0.1)
    assert shares(around(), (0, 0, 0)) > 0.1


def test_the_script_names_nothing_of_any_model_and_fetches_nothing(
    repository: Path,
) -> None:
    script = (repository / "src/sambot_viz/page/view/rviz_look.js").read_text("utf-8")
    for forbidden in ("http", "fetch(", "XMLHttpRequest", "import(", "eval("):
        assert forbidden not in script


_WIDTH = "__viserMutable.canvas.getContext('webgl2').drawingBufferWidth"
_LOWER = """(() => {
  const { setDpr } = __viserMutable.scene.__r3f.root.getState();
  setDpr(0.75);
  __viserMutable.requestRender();
})()"""
_MOVE = """new Promise(done => {
  const widths = new Set();
  const timer = setInterval(() => {
    __viserMutable.requestRender();
    widths.add(__viserMutable.canvas.getContext("webgl2").drawingBufferWidth);
  }, 20);
  setTimeout(() => { clearInterval(timer); done([...widths]); }, 900);
})"""


def test_the_picture_is_sharp_at_rest_and_motions_have_visers_choice(
    viz: Visualizer, chromium: Chromium
) -> None:
    page = open_page(chromium, 800, 600)
    try:
        page.goto(viz.url)
        page.wait_for("__viserMutable.scene && window.sambotVizLook?.labels === 5", 30)
        full = page.evaluate("__viserMutable.canvas.clientWidth")
        page.evaluate(_LOWER)
        page.wait_for(f"Math.abs({_WIDTH} - 0.75 * {full}) < 2")
        page.wait_for(f"{_WIDTH} === {full}")
        page.evaluate("new Promise(done => setTimeout(done, 500))")
        # From there viser may go on to more or fewer, as quick as the machine is.
        widths = page.evaluate(_MOVE)
        reported = page.evaluate("__viserMutable.canvas.width")
        assert reported == full, "the program is told of the window"
        assert any(abs(width - 0.75 * full) < 2 for width in widths), widths
        page.wait_for(f"{_WIDTH} === {full}")
        # From then on only viser's own picture a second is drawn.
        page.evaluate("new Promise(done => setTimeout(done, 700))")
        drawn = page.evaluate("sambotVizLook.frames")
        page.evaluate("new Promise(done => setTimeout(done, 1500))")
        assert page.evaluate("sambotVizLook.frames") - drawn <= 2
    finally:
        page.close()


_DISPOSE = """(() => {
  const { scene } = __viserMutable, batches = [];
  scene.traverse(object => { if (object.isInstancedMesh2) batches.push(object); });
  scene.__r3f.root.getState().gl.getContext().getError();
  for (const batch of batches) batch.dispose();
  return batches.length;
})()"""
_GL_ERROR = "__viserMutable.scene.__r3f.root.getState().gl.getContext().getError()"


def test_a_batch_that_viser_makes_again_gives_no_error_of_webgl(
    open_viewer: Open, make_viz: Callable[..., Visualizer]
) -> None:
    viz = make_viz()
    viewer = open_viewer(viz.url)
    viewer.wait_for("window.sambotVizLook?.labels === 5")
    viewer.settle(viz)
    # viser does so, and takes the old one out of the scene some pictures later.
    assert viewer.page.evaluate(_DISPOSE) > 0
    viewer.wait_for_frames()
    assert viewer.page.evaluate(_GL_ERROR) == 0
