"""Tasks with two people, phones, tablets, the keyboard alone, and mishaps."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import cast

import pytest
from ax_tree import Thing
from desk import Desk
from judge import nothing_is_cut_off, on_page
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

AT_ONCE = 12.0
LEFT = "drivewhl_l_joint"
SKY = (420.0, 120.0)


def field(viewer: ViewerPage) -> str:
    return str(viewer.user.row("Joints", LEFT).one("textbox").value)


def test_task_54_one_types_while_another_drags(
    s: Desk, open_more: Callable[..., ViewerPage]
) -> None:
    other = open_more()
    s.user.click_into(s.user.row("Joints", LEFT).one("textbox"))
    s.user.type("2.")
    other.user.drag_slider(other.user.row("Joints", LEFT).one("slider"), -1.0)
    s.user.until(lambda: s.viz.joint_positions[LEFT] < -0.5, why="not dragged")
    s.user.until(lambda: float(s.user.row("Joints", LEFT).one("slider").value) < -0.5)
    assert field(s.viewer) == "2."
    s.user.type("5")
    s.user.keys("Enter")
    s.user.until(lambda: s.viz.joint_positions[LEFT] == 2.5)
    for viewer in (s.viewer, other):
        viewer.user.until(lambda v=viewer: field(v) == "2.5")


@pytest.mark.view
def test_task_55_one_measures_while_another_turns(
    s: Desk, open_more: Callable[..., ViewerPage]
) -> None:
    other = open_more()

    def yaw(viewer: ViewerPage) -> str:
        return viewer.user.row("Views", "Yaw").text

    def tools(viewer: ViewerPage) -> list[str]:
        buttons = viewer.user.find("toolbar", "Tools").all("button")
        return [b.name for b in buttons if b.is_on]

    mine, theirs = yaw(s.viewer), yaw(other)
    s.choose_tool("Measure")
    s.page.mouse.click(*on_page(s, 0.0, 0.0, 0.09))
    s.user.reads("second point")
    other.page.mouse.drag(SKY, (SKY[0] - 60, SKY[1]))
    other.user.until(lambda: yaw(other) != theirs)
    s.settle()
    assert tools(other) == ["Interact"]
    assert "second point" not in other.user.see().text
    assert yaw(s.viewer) == mine
    s.page.mouse.click(*on_page(s, 0.1, 0.1, 0.09))
    s.user.reads(" m. ")


@pytest.mark.parametrize("size", [(390, 844), (844, 390)])
def test_task_56_a_joint_on_a_phone(
    s: Desk, open_more: Callable[..., ViewerPage], size: tuple[int, int]
) -> None:
    phone = open_more(*size, touch=True)
    user = phone.user
    slider = user.row("Joints", LEFT).one("slider")
    user.go_to(slider)
    place = phone.view_box()
    assert place[2] * place[3] > 0.3 * size[0] * size[1]
    user.drag_slider(user.row("Joints", LEFT).one("slider"), 1.5)
    user.until(lambda: s.viz.joint_positions[LEFT] > 0.5)
    for kind in ("slider", "textbox"):
        user.until(lambda kind=kind: user.can_see(user.row("Joints", LEFT).one(kind)))
    assert font(phone) >= 12


def font(viewer: ViewerPage) -> float:
    """The size of the smallest text of the panels [px]."""
    return float(
        viewer.page.evaluate(
            "Math.min(...[...document.querySelectorAll('[role=row] *')]"
            ".filter(e => e.childNodes[0]?.nodeType === 3 && e.offsetHeight)"
            ".map(e => parseFloat(getComputedStyle(e).fontSize)))"
        )
    )


@pytest.mark.view
def test_task_57_a_tablet_by_touch_alone(
    s: Desk, open_more: Callable[..., ViewerPage]
) -> None:
    tablet = open_more(1024, 768, touch=True)
    user, touch = tablet.user, tablet.page.touch
    left, top, width, height = tablet.view_box()
    assert width * height > 0.5 * 1024 * 768
    tools = user.find("toolbar", "Tools").all("button")
    assert len({user.box(button)[1] for button in tools}) == 1, "one line"
    tabs = user.find("tablist").all("tab")
    assert len({user.box(tab)[1] for tab in tabs}) <= 2, "two lines"
    assert all(user.can_see(tab) and not user.is_cut_off(tab) for tab in tabs)
    assert too_small(tablet) == []

    # Turn, pinch, move.
    user.tab("Views")

    def number(name: str) -> str:
        return str(user.row("Views", name).one("textbox").value)

    user.until(lambda: seen_rows(user, "Views") >= 8)
    x, y = left + 0.5 * width, top + 0.15 * height
    yaw = number("Yaw")
    user.swipe((x, y), (x + 60, y))
    user.until(lambda: number("Yaw") != yaw)
    distance = number("Distance")
    touch.start((x - 40, y), (x + 40, y))
    touch.move((x - 60, y), (x + 60, y))
    touch.move((x - 80, y), (x + 80, y))
    touch.end()
    user.until(lambda: 0 < float(number("Distance")) < 0.51 * float(distance))
    tablet.settle(s.viz)
    distance, point = number("Distance"), number("Focal Point")
    touch.start((x - 40, y), (x + 40, y))
    touch.move((x - 40, y + 20), (x + 40, y + 20))
    touch.move((x - 40, y + 40), (x + 40, y + 40))
    touch.end()
    user.until(lambda: number("Focal Point") != point)
    tablet.settle(s.viz)
    assert number("Distance") == distance
    assert too_small(tablet) == []

    # Tick a display, and see it on another page.
    user.tab("Displays")
    user.until(lambda: seen_rows(user, "Displays") >= 8)
    assert too_small(tablet) == []
    for on in (False, True):
        user.click_on(user.row("Displays", "Grid").one("checkbox"))
        s.user.until(
            lambda on=on: s.user.row("Displays", "Grid").one("checkbox").is_on == on
        )

    user.tab("Joints")
    user.drag_slider(user.row("Joints", LEFT).one("slider"), 1.5)
    user.until(lambda: s.viz.joint_positions[LEFT] > 0.5)
    assert user.box(user.row("Joints", LEFT).one("slider"))[3] >= 44


def seen_rows(user: User, panel: str) -> int:
    """How many rows of a panel are on the screen."""
    return sum(user.can_see(r) for r in user.see().one("treegrid", panel).all("row"))


def too_small(viewer: ViewerPage) -> list[str]:
    """What a finger can touch and is lower than 36 px."""
    found = viewer.page.evaluate(
        "[...document.querySelectorAll('[role=row], button, input, select')]"
        ".map(e => e.closest('label.tick') || e)"
        ".filter(e => e.offsetHeight && (e.offsetHeight < 36 || e.offsetWidth < 30))"
        ".map(e => `${e.ariaLabel || e.textContent} ${e.offsetWidth}"
        " x ${e.offsetHeight}`)"
    )
    return cast("list[str]", found)


def test_task_58_the_keyboard_alone(s: Desk) -> None:
    user = s.user

    def focused() -> tuple[str, str]:
        """The innermost thing that has the keys."""
        found = [t for t in user.see().walk() if t.state("focused")]
        return (found[-1].role, found[-1].name) if found else ("", "")

    def tab_to(role: str, name: str) -> None:
        for _ in range(60):
            if focused() == (role, name):
                return
            user.keys("Tab")
        raise AssertionError(f"the Tab key does not come to {role} {name}")

    def rows(panel: str) -> list[Thing]:
        return user.find("treegrid", panel).all("row")

    def go_down_to(label: str, panel: str) -> None:
        for _ in range(60):
            chosen = [r for r in rows(panel) if r.state("focused")]
            if chosen and chosen[0].all("gridcell")[0].name == label:
                return
            user.keys("ArrowDown")
        raise AssertionError(f"the arrow keys do not come to {label}")

    s.page.mouse.click(*SKY)
    things = user.see()
    nameless = [
        t.role
        for t in things.walk()
        if t.role in ("button", "slider", "textbox", "combobox", "checkbox", "tab")
        and not t.name
    ]
    assert nameless == []
    for _ in range(60):
        user.keys("Tab")
        if any(row.state("focused") for row in rows("Displays")):
            break
    user.keys("Home")
    user.until(lambda: focused()[1].startswith("Global Options"))
    go_down_to("RobotModel", "Displays")
    user.keys("ArrowRight")
    user.until(lambda: user.row("Displays", "RobotModel").state("expanded"))
    go_down_to("Alpha", "Displays")
    user.keys("Enter")
    user.keys("Control+a")
    user.type("0.5")
    user.keys("Enter")
    session = s.viz.server.sessions.all()[0]
    user.until(lambda: session.document.config.displays[1].get("Alpha") == 0.5)
    user.keys("Escape")
    tab_to("slider", LEFT)
    user.keys("End")
    user.until(lambda: s.viz.joint_positions[LEFT] > 3.1)
    tab_to("button", "Interact")
    for _ in range(10):
        if focused() == ("button", "Select"):
            break
        user.keys("ArrowRight")
    user.keys("Enter")
    user.until(lambda: user.find("button", "Select", ("toolbar", "Tools")).is_on)


@pytest.mark.parametrize(
    ("size", "scale"), [((853, 480), 1.5), ((600, 800), 1.0), ((1440, 900), 1.0)]
)
@pytest.mark.parametrize("dark", [False, True])
def test_task_59_other_windows(
    s: Desk, size: tuple[int, int], scale: float, dark: bool
) -> None:
    user = s.user
    s.page.set_viewport(*size, scale)
    s.page.set_dark(dark)
    try:
        user.row("Joints", LEFT)
        s.viewer.wait_for_frames()
        nothing_is_cut_off(s)

        def light() -> float:
            """The part of the page that is light."""
            shown = s.viewer.screenshot()[..., :3].mean(axis=-1)
            return float((shown > 200).mean())

        user.until(lambda: light() < 0.1 if dark else light() > 0.2)
    finally:
        s.page.set_viewport(1280, 720)
        s.page.set_dark(False)
        user.find("button", "Interact", ("toolbar", "Tools"))


def test_task_59_a_high_window_has_no_empty_rows_beside_ones_to_scroll(
    viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    # A server of its own: at a desk, tasks before may have unfolded displays.
    viewer = open_viewer(viz.url)
    user = viewer.user
    user.row("Joints", LEFT)
    lead = ("row", re.compile("^Lead all views"))
    assert not user.can_see(user.find(*lead))
    viewer.page.set_viewport(1440, 900)
    user.until(lambda: user.can_see(user.find(*lead)))
    user.until(lambda: user.can_see(user.find("button", "Forwards")))
    user.tab("Drive")
    user.until(lambda: len(user.see().all("button", "Forwards")) == 1)


def test_task_59_one_panel_folded_one_widened(
    s: Desk, open_more: Callable[..., ViewerPage]
) -> None:
    viewer = open_more()
    user, page = viewer.user, viewer.page

    def share() -> float:
        """The part of the window's width that is view."""
        return viewer.view_box()[2] / page.evaluate("innerWidth")

    # The panels on the right are there as soon as they have rows.
    user.row("Joints", LEFT)
    before = viewer.view_box()
    user.click("button", "Hide the left panels")
    user.until(lambda: viewer.view_box()[2] > before[2] + 0.9 * before[0])
    user.click("button", "Show the left panels")
    x, y = user.go_to(user.find("separator", "Width of the right panels"))
    page.mouse.drag((x, y), (640.0, y))
    user.until(lambda: share() < 0.35)
    for size in ((1150, 720), (950, 700), (900, 600), (853, 480)):
        page.set_viewport(*size)
        user.until(lambda: share() > 0.47, why=f"{size}: {share():.2f} is view")
    page.set_viewport(1150, 720)
    page.goto(viewer.url)
    user.row("Joints", LEFT)
    user.until(lambda: share() > 0.47)
    page.set_viewport(1280, 720)
    user.until(lambda: share() < 0.35)


def test_task_60_the_server_stops_and_starts_again(own: Desk) -> None:
    user, port = own.user, own.viz.viser.get_port()
    own.viewer.expects_errors = True
    user.unfold("Displays", "RobotModel")
    user.unfold("Displays", "Links")
    user.row("Displays", "Links", "drivewhl_l_link")
    user.enter(user.row("Joints", LEFT).one("textbox"), "1")
    user.until(lambda: own.viz.joint_positions[LEFT] == 1.0)
    rows = user.rows("Displays")
    own.viz.stop()
    user.reads("This page comes back by itself")
    own.viz = Visualizer(own.model, port=port, watch=True, look="rviz")
    user.reads("The connection is back. The server was restarted.", 40.0)
    user.until(lambda: own.viz.joint_positions[LEFT] == 1.0)
    user.until(lambda: field(own.viewer) == "1")
    user.until(lambda: user.rows("Displays") == rows)
    assert "Lost:" not in user.see().text
    # A page that is loaded again in the middle of a drag.
    slider = user.row("Joints", LEFT).one("slider")
    x, y = user.go_to(slider)
    own.page.mouse.move(x, y)
    own.page.mouse.press()
    own.page.mouse.move(x + 10, y)
    user.until(lambda: own.viz.joint_positions[LEFT] != 1.0)
    # Of two steps, this may have been the first one.
    own.settle()
    own.page.goto(own.viewer.url)
    own.page.mouse.release()
    held = own.viz.joint_positions[LEFT]
    user.until(
        lambda: (
            float(user.row("Joints", LEFT).one("textbox").value)
            == pytest.approx(held, abs=1e-4)
        )
    )
    assert own.viz.joint_positions[LEFT] == held != 1.0
    user.until(lambda: user.rows("Displays") == rows)
    user.click("button", re.compile("^Center$"))
    user.until(lambda: own.viz.joint_positions[LEFT] == 0.0)
