"""A page without a view: the same window, round an empty place of the same size."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

# Every element of the window: what it is, what it says, where it is, how it looks.
# How often the view draws is said where there is one.
_WINDOW = """[...document.querySelectorAll("#sambot *:not(.fps)")].map((element) => {
  const { x, y, width, height } = element.getBoundingClientRect();
  const look = getComputedStyle(element);
  const says = element.children.length ? "" : element.textContent;
  return [element.tagName, String(element.className), says, x, y, width, height,
    ...["font", "color", "backgroundColor", "padding", "margin", "border"].map(
      (name) => look[name])].join(" | ");
})"""
_PLACE = """(({ x, y, width, height }) => [x, y, width, height].join(" | "))(
  document.querySelector("#root").getBoundingClientRect())"""


@pytest.mark.parametrize("size", [(1280, 720), (390, 844)])
def test_the_window_is_the_same(
    make_viz: Callable[..., Visualizer],
    open_viewer: Callable[..., ViewerPage],
    size: tuple[int, int],
) -> None:
    seen: list[list[str]] = []
    for view in (True, False):
        viz = make_viz()
        viewer = open_viewer(viz.url, width=size[0], height=size[1], view=view)
        viewer.user.row("Joints", "drivewhl_l_joint")
        viewer.settle(viz)
        assert viewer.page.evaluate("typeof __viserMutable") == (
            "object" if view else "undefined"
        )
        seen.append([*viewer.page.evaluate(_WINDOW), viewer.page.evaluate(_PLACE)])
    assert len(seen[0]) > 100
    assert seen[0] == seen[1]
