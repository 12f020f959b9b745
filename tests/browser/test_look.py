"""The page script: sharp pictures, no error of WebGL, nothing fetched.

The colours and names that it makes are in tests/golden.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from patience import patience
from recorded_page import RecordedPage, open_page

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium

pytestmark = [pytest.mark.browser, pytest.mark.view]


@pytest.fixture(scope="module")
def page(chromium: Chromium, viz_for_all: Visualizer) -> Iterator[RecordedPage]:
    """A page that has viser's number of pixels, which may change."""
    page = open_page(chromium, 800, 600)
    page.goto(viz_for_all.url)
    shown = "__viserMutable.scene && window.sambotVizLook?.labels === 5"
    page.wait_for(shown, patience(30.0))
    yield page
    page.close()
    assert page.exceptions == []


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
    page: RecordedPage,
) -> None:
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


_DISPOSE = """(() => {
  const { scene } = __viserMutable, batches = [];
  scene.traverse(object => { if (object.isInstancedMesh2) batches.push(object); });
  scene.__r3f.root.getState().gl.getContext().getError();
  for (const batch of batches) batch.dispose();
  return batches.length;
})()"""
_TWO_FRAMES = """new Promise(done => {
  __viserMutable.requestRender();
  requestAnimationFrame(() => requestAnimationFrame(() => done(null)));
})"""
_GL_ERROR = "__viserMutable.scene.__r3f.root.getState().gl.getContext().getError()"


def test_a_batch_that_viser_makes_again_gives_no_error_of_webgl(
    page: RecordedPage,
) -> None:
    # viser does so, and takes the old one out of the scene some pictures later.
    assert page.evaluate(_DISPOSE) > 0
    page.evaluate(_TWO_FRAMES)
    assert page.evaluate(_GL_ERROR) == 0
