"""Long trees: only the rows in sight are drawn whole, and nobody notices."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import robots
from made_recording import write_recording
from presses import press_all
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

FEW, MANY = 50, 300
MOST_NODES = 0.5
"""Of a row that is far out of sight: 25 of them are an element, its cell and a text."""
# The heights of all rows of a panel, one after the other, while it is scrolled through.
_HEIGHTS = """(async () => {
  const tree = document.querySelector("[data-panel=PANEL]"), box = tree.parentElement;
  const heights = () => Object.fromEntries([...tree.querySelectorAll("[data-row]")].map(
    (row) => [row.dataset.row, row.offsetHeight]));
  const place = (row) => row.getBoundingClientRect();
  const frame = () =>
    new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  box.scrollTop = 0;
  await frame();
  const high = tree.offsetHeight, seen = heights(), lines = [], moved = [];
  for (let at = 0; at < box.scrollHeight; at += box.clientHeight) {
    box.scrollTop = at;
    await frame();
    const now = heights(), { top, bottom } = place(box);
    moved.push(...Object.keys(now).filter((id) => id in seen && now[id] !== seen[id]));
    if (tree.offsetHeight !== high) moved.push("the end of the tree");
    Object.assign(seen, now);
    lines.push(...[...tree.querySelectorAll(".line, .lines")].map(place)
      .filter((one) => one.bottom > top + 1 && one.top < bottom - 1));
  }
  return {count: Object.keys(seen).length, moved, lines: lines.length};
})()"""

_SCROLL_TO_FOUND = """(() => {
  const box = document.querySelector("[data-panel=joints]").parentElement;
  const { top } = getSelection().getRangeAt(0).getBoundingClientRect();
  box.scrollTop += top - box.getBoundingClientRect().top - box.clientHeight / 2;
})()"""


@pytest.fixture(scope="module")
def page_of(
    tmp_path_factory: pytest.TempPathFactory, open_for_all: Callable[..., ViewerPage]
) -> Iterator[Callable[[int], ViewerPage]]:
    """The page of a chain with a number of joints."""
    opened: dict[int, tuple[Visualizer, ViewerPage]] = {}

    def page(count: int) -> ViewerPage:
        if count not in opened:
            model = tmp_path_factory.mktemp("chain") / "chain.urdf"
            model.write_text(robots.chain(count), "utf-8")
            viz = Visualizer(model, port=0, look="rviz")
            opened[count] = viz, open_for_all(viz.url)
        viz, viewer = opened[count]
        viewer.settle(viz)
        viewer.user.tab("Joints")
        return viewer

    yield page
    for viz, viewer in opened.values():
        viewer.expects_errors = True
        viz.stop()


def counts(viewer: ViewerPage) -> tuple[int, int]:
    """Nodes and listeners of a page, when nothing changes."""
    page = viewer.page

    def both() -> tuple[int, int]:
        page.call("HeapProfiler.collectGarbage")
        found = page.call("Memory.getDOMCounters")
        return found["nodes"], found["jsEventListeners"]

    last: list[tuple[int, int]] = []

    def same() -> tuple[int, int] | None:
        last.append(both())
        return last[-1] if last[-2:].count(last[-1]) == 2 else None

    found = viewer.user.until(same)
    assert found is not None
    return found


@pytest.mark.parametrize("panel", ["Joints", "Displays"])
def test_nodes_grow_little_with_a_robot_and_listeners_do_not(
    page_of: Callable[[int], ViewerPage], panel: str
) -> None:
    found: list[tuple[int, int]] = []
    rows: list[int] = []
    for count in (FEW, MANY):
        viewer = page_of(count)
        if panel == "Displays":
            viewer.user.unfold("Displays", "TF")
            viewer.user.unfold("Displays", "TF", "Frames")
        viewer.user.until(lambda: len(viewer.user.rows(panel)) >= count)  # noqa: B023
        rows.append(len(viewer.user.rows(panel)))
        found.append(counts(viewer))
        viewer.user.unfold("Displays", "TF", fold=True)
    few, many = found
    more = rows[1] - rows[0]
    assert more >= MANY - FEW
    # Of the rows in sight, and of those near them, some may be others.
    assert many[0] - few[0] <= MOST_NODES * more + 100
    assert many[1] - few[1] <= 30
    assert many[0] < 1200
    assert many[1] < 500


def test_nodes_grow_little_with_the_topics_of_a_recording(
    tmp_path: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    found: list[int] = []
    for count in (FEW, MANY):
        texts = {f"/topic_{at:03}": "said" for at in range(count)}
        bag = write_recording(tmp_path / f"{count}.mcap", texts)
        with Visualizer(source=f"bag:{bag}", port=0, look="rviz") as viz:
            viewer = open_viewer(viz.url)
            viewer.settle(viz)
            viewer.user.tab("Topics")
            viewer.user.until(lambda v=viewer: len(v.user.rows("Topics")) >= FEW)
            found.append(counts(viewer)[0])
            if count == MANY:
                steps = viewer.user.find("combobox", "Step to messages of")
                viewer.user.choose(steps, "/topic_222")
            viewer.expects_errors = True
    # Of the rows in sight, and of those near them, some may be others.
    assert found[1] - found[0] <= MOST_NODES * (MANY - FEW) + 100


@pytest.mark.parametrize("panel", ["joints", "displays"])
def test_a_row_that_comes_into_sight_is_drawn_as_high_as_its_line_was(
    page_of: Callable[[int], ViewerPage], panel: str
) -> None:
    viewer = page_of(FEW)
    if panel == "displays":
        for name in ("Grid", "TF", "RobotModel"):
            viewer.user.unfold("Displays", name)
    found = viewer.page.evaluate(_HEIGHTS.replace("PANEL", panel))
    assert found["count"] >= 50
    assert found["moved"] == []
    assert found["lines"] == 0


def test_a_press_in_the_middle_of_a_long_list_moves_nothing(
    page_of: Callable[[int], ViewerPage],
) -> None:
    viewer = page_of(FEW)
    viewer.user.row("Joints", "joint_30")
    assert press_all(viewer, ".joints .tree", 20) == []


def test_a_screen_reader_knows_all_joints(
    page_of: Callable[[int], ViewerPage],
) -> None:
    names = set(page_of(MANY).user.rows("Joints"))
    assert {f"joint_{at}" for at in range(1, MANY + 1)} <= names


def test_keys_reach_rows_that_were_out_of_sight(
    page_of: Callable[[int], ViewerPage],
) -> None:
    viewer = page_of(MANY)
    user = viewer.user
    user.click_on(user.row("Joints", "joint_2").one("gridcell", "joint_2"))
    user.keys("End")
    last = user.row("Joints", f"joint_{MANY}")
    user.until(lambda: user.can_see(last.one("slider")))
    user.keys("Tab", "ArrowRight")
    user.until(lambda: user.row("Joints", f"joint_{MANY}").one("textbox").value != "0")
    user.keys("Escape", "ArrowUp", "Home", "PageDown")
    viewer.wait_for("document.activeElement.dataset.row === 'j/joint_10'")
    viewer.wait_for("document.activeElement.querySelector('input.num')")
    assert not user.see().one("treegrid", "Joints").all("slider", f"joint_{MANY - 9}")


def test_a_search_goes_to_the_field_of_a_joint_out_of_sight(
    page_of: Callable[[int], ViewerPage],
) -> None:
    viewer = page_of(MANY)
    user = viewer.user
    user.click("searchbox", "Search joints")
    user.keys(*"joint_2", "Enter")
    viewer.wait_for(
        "document.activeElement.closest('[data-row=\"j/joint_2\"] .number')"
    )
    user.click("searchbox", "Search joints")
    user.keys(*"77", "Enter")
    viewer.wait_for(
        "document.activeElement.closest('[data-row=\"j/joint_77\"] .number')"
    )
    user.click("searchbox", "Search joints")
    user.keys("Escape")
    user.until(lambda: len(user.rows("Joints")) >= MANY)


def test_a_browser_finds_a_joint_anywhere(
    page_of: Callable[[int], ViewerPage],
) -> None:
    viewer = page_of(MANY)
    find = "window.find('joint_222', false, false, true)"
    assert viewer.page.evaluate(find)
    # A browser's Find scrolls there too, this function does not.
    viewer.page.evaluate(_SCROLL_TO_FOUND)
    viewer.wait_for("document.querySelector('[data-row=\"j/joint_222\"] input')")
    assert viewer.page.evaluate(find)
