"""Trees of rows with the scroll bars of a desktop: what is drawn can be clicked."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

# How far each tree scrolls, and the controls that do not answer in their middle.
_LOOK = """(() => {
  const bars = {}, dead = [];
  let count = 0;
  for (const tree of document.querySelectorAll("[role=treegrid]")) {
    const box = tree.closest(".treebox"), name = tree.ariaLabel;
    bars[name] = Math.max(0, box.scrollHeight - box.clientHeight);
    for (const row of tree.querySelectorAll("[role=row]")) {
      row.scrollIntoView({block: "nearest"});
      const wanted = "input[type=checkbox], input[type=color], .twist:not(.none)";
      for (const control of row.querySelectorAll(wanted)) {
        const {left, top, width, height} = control.getBoundingClientRect();
        const hit = document.elementFromPoint(left + width / 2, top + height / 2);
        count += 1;
        if (hit !== control) dead.push(
          [name, row.textContent, control.className, hit && hit.className].join(": "));
      }
    }
  }
  return {bars, count, dead};
})()"""


@pytest.fixture(scope="module")
def viewer(
    viz_for_all: Visualizer, open_for_all: Callable[..., ViewerPage]
) -> ViewerPage:
    viewer = open_for_all(viz_for_all.url)
    viewer.settle(viz_for_all)
    return viewer


def check_all(user: User) -> dict[str, int]:
    """Check every control of every tree that is shown; how far each scrolls."""

    def all_answer() -> dict[str, int]:
        answer = user.page.evaluate(_LOOK)
        assert answer["dead"] == []
        assert answer["count"] >= 5
        return answer["bars"]

    return user.until(all_answer)


def move_divider(user: User, panel: str, part: float) -> None:
    """Drag the line between names and values of a tree to a part of its width."""
    left, top, width, _ = user.box(user.find("treegrid", panel))

    def lines() -> list[float]:
        boxes = map(user.box, user.see().all("separator", "Width of the names"))
        return [
            x for x, y, _, _ in boxes if 0 <= x - left <= width and abs(y - top) < 2
        ]

    (x,) = user.until(lines)
    user.page.mouse.drag((x + 3, top + 40), (left + part * width, top + 40), steps=5)


@pytest.mark.parametrize("size", [(1280, 720), (1440, 2400), (1024, 768), (390, 844)])
def test_the_middle_of_every_box_and_swatch_answers(
    viewer: ViewerPage, size: tuple[int, int]
) -> None:
    user = viewer.user
    viewer.page.set_viewport(*size)
    viewer.wait_for_frames()
    bars: dict[str, int] = {}
    for tab in ("Views", "Displays") if size[0] < 1100 else ("Frames", "Joints"):
        user.tab(tab)
        bars |= check_all(user)
    for name in ("Grid", "TF", "RobotModel"):
        user.unfold("Displays", name)
    for part in (0.2, 0.8, 0.6):
        move_divider(user, "Displays", part)
        bars |= check_all(user)
    # Which sizes scroll is what makes the rest of this test worth anything.
    assert (bars["Displays"] > 0) == (size[1] < 2000)


_COLORS = """Object.fromEntries(
  [...document.querySelectorAll("[role=treegrid] .name")].map(
    (name) => [name.textContent, getComputedStyle(name).color]))"""


def test_a_group_has_the_colour_of_its_properties(viewer: ViewerPage) -> None:
    viewer.page.set_viewport(1280, 720)

    def are_alike() -> bool:
        colors = viewer.page.evaluate(_COLORS)
        names = ("Global Options", "Global Status: Ok", "Fixed Frame")
        # Rows come one by one.
        return colors.keys() >= set(names) and len({colors[n] for n in names}) == 1

    viewer.user.until(are_alike)
