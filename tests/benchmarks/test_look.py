"""The page script costs nothing worth mentioning, also with a thousand parts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
import viser

from sambot_viz import page
from sambot_viz.export.chromium import Chromium
from sambot_viz.export.find_browser import find_browser, how_to_get_a_browser
from sambot_viz.server.bind import close, listen

PARTS = 1000
# Seconds for twenty pictures of a scene that is drawn again and again.
TWENTY_FRAMES = """new Promise(resolve => {
  const mutable = window.__viserMutable;
  let left = 20;
  const start = performance.now();
  const next = () => {
    if (left-- === 0) { resolve((performance.now() - start) / 1000); return; }
    mutable.requestRender();
    requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
})"""


@pytest.fixture(scope="module")
def chromium() -> Iterator[Chromium]:
    if find_browser() is None:
        pytest.skip(how_to_get_a_browser())
    with Chromium() as browser:
        yield browser


@contextmanager
def thousand_boxes(script: bool) -> Iterator[viser.ViserServer]:
    server = listen("127.0.0.1", 0)
    server.scene.configure_default_lights(enabled=False)
    server.scene.configure_environment_map(None)
    server.scene.add_light_ambient("/light")
    for i in range(PARTS):
        server.scene.add_box(
            f"/{i}",
            (0, 200, 200),
            (0.05, 0.05, 0.05),
            position=(i % 10 / 10, i // 10 % 10 / 10, i // 100 / 10),
            opacity=0.9 if i % 2 else None,
            cast_shadow=False,
            receive_shadow=False,
        )
    if script:
        server.gui.add_html(page.script_element())
    try:
        yield server
    finally:
        close(server)


def test_a_thousand_parts_are_drawn_as_fast_as_without_the_script(
    chromium: Chromium, compare: Callable[..., Any]
) -> None:
    with thousand_boxes(True) as ours, thousand_boxes(False) as theirs:
        pages = []
        for server in (ours, theirs):
            url = f"http://127.0.0.1:{server.get_port()}/?fixedDpr=1"
            opened = chromium.open(url, width=640, height=480)
            opened.wait_for(
                "window.__viserMutable && "
                f"Object.keys(window.__viserMutable.nodeRefFromName).length >= {PARTS}",
                timeout=60.0,
            )
            pages.append(opened)
        pages[0].wait_for("window.sambotVizLook?.frames > 2", timeout=60.0)
        result = compare(
            "twenty pictures of a thousand parts",
            lambda: pages[0].evaluate(TWENTY_FRAMES, timeout=120.0),
            lambda: pages[1].evaluate(TWENTY_FRAMES, timeout=120.0),
        )
    assert result.ratio <= 1.1, str(result)
