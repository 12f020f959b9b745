"""Who gets the keys and the mouse: the view, its tools, or what is being typed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from desk import Desk
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.panels import drive_panel
from sambot_viz.session.clients.client import Client

pytestmark = pytest.mark.browser

FOCUSED = "document.activeElement"


@pytest.fixture
def desk(sit: Callable[..., Desk]) -> Desk:
    return sit("S")


@pytest.fixture
def viewer(desk: Desk) -> ViewerPage:
    desk.viewer.wait_for("window.sambotViz && window.sambotViz.view.kind === 'Orbit'")
    return desk.viewer


@pytest.fixture
def user(viewer: ViewerPage) -> User:
    return viewer.user


@pytest.fixture
def browser(desk: Desk) -> Client:
    return desk.browser


def pressed(user: User, tool: str) -> None:
    """Wait until a tool is shown as the current one."""
    user.until(lambda: user.find("button", tool).state("pressed"))


def middle(viewer: ViewerPage) -> tuple[float, float]:
    """The middle of the view on the page."""
    left, top, width, height = viewer.view_box()
    return left + width / 2, top + height / 2


def test_a_click_into_the_view_takes_the_keys_from_a_field(
    user: User, viewer: ViewerPage
) -> None:
    user.click_on(user.row("Displays", "Fixed Frame").one("combobox"))
    viewer.page.mouse.click(*middle(viewer))
    user.until(lambda: user.find("application", "3D view").state("focused"))
    # It marks no text of the page either.
    user.keys("Control+a")
    assert "Global Options" not in viewer.page.evaluate("String(getSelection())")
    user.keys("n")
    pressed(user, "Measure")


def test_digits_drive_only_where_the_hand_is_in_the_drive_panel(
    user: User, viewer: ViewerPage, desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A page of a busy machine is too slow for the robot; that has tests of its own.
    monkeypatch.setattr(drive_panel, "KEEP", 600.0)
    drive = desk.session.drive
    viewer.page.mouse.click(*middle(viewer))
    user.keys("8", "4")
    user.click("button", "Center")
    user.keys("8")
    user.tab("Drive")
    viewer.page.mouse.click(*middle(viewer))
    user.keys("8")
    user.click("tab", "Drive")
    user.keys("4")
    user.until(lambda: (drive.v, drive.w) == (0.0, 0.25))
    left, top, width, _ = user.box(user.find("group", "Drive"))
    viewer.page.mouse.click(left + width - 3, top + 3)
    user.keys("8")
    user.until(lambda: (drive.v, drive.w) == (0.1, 0.25))
    viewer.page.mouse.click(*middle(viewer))
    user.keys("5")
    user.until(lambda: not drive.moving)
    user.click("button", "Back to start", ("group", "Drive"))
    user.until(lambda: desk.fixed_frame == "base_link")


@pytest.mark.view
def test_the_mouse_is_reported_while_measure_wants_it(
    user: User, viewer: ViewerPage, browser: Client
) -> None:
    user.keys("f")
    user.until(lambda: browser.view.values["Distance"] < 2.0)
    user.keys("n")
    pressed(user, "Measure")
    viewer.page.evaluate(
        "(() => { const send = WebSocket.prototype.send; window.hovers = 0;"
        " WebSocket.prototype.send = function (data) {"
        " if (typeof data === 'string' && data.includes('tools/hover')) hovers += 1;"
        " return send.call(this, data); }; })()"
    )
    x, y = middle(viewer)
    for step in range(10):
        viewer.page.mouse.move(x + step, y)
    assert viewer.page.evaluate("hovers") == 0
    viewer.page.mouse.click(x, y)
    user.until(lambda: browser.tools.current.wants_hover)
    viewer.wait_for("document.querySelector('[role=status]').innerText.includes('sec')")
    for step in range(20):
        viewer.page.mouse.move(x + 20 + step, y)
    user.until(lambda: " m. " in browser.tools.status)
    assert viewer.page.evaluate("hovers") > 0


def test_undo_and_escape_act_in_the_list_of_poses_after_one_is_removed(
    open_viewer: Callable[..., ViewerPage], tmp_path: Path
) -> None:
    path = tmp_path / "p.yaml"
    path.write_text("near: {drivewhl_l_joint: 1.0}\nfar: {drivewhl_l_joint: 2.0}\n")
    with Visualizer(port=0, poses=path, look="rviz") as viz:
        viewer = open_viewer(viz.url)
        # The server is closed before the page is.
        viewer.expects_errors = True
        user = viewer.user
        user.click("button", "Poses")
        for name in ("near", "far"):
            user.click("button", f"Remove pose {name}")
            user.gone("button", f"Remove pose {name}")
        user.keys("Control+z")
        user.find("button", "Remove pose far")
        assert "near" not in path.read_text()
        user.keys("Escape")
        user.gone("button", "Remove pose far")


def test_keys_are_for_tools_when_the_mouse_comes_into_the_view(desk: Desk) -> None:
    user, mouse = desk.user, desk.page.mouse
    field = user.row("Joints", "drivewhl_l_joint").one("textbox")
    mouse.move(1250.0, 500.0)
    user.enter(field, "0.5")
    # A number stays in the hand: the arrow keys step it.
    user.keys("ArrowUp")
    user.until(
        lambda: desk.viz.joint_positions["drivewhl_l_joint"] == pytest.approx(0.51)
    )
    user.keys("Enter")
    mouse.move(640.0, 120.0)
    user.keys("s")
    desk.has_tool("Select")
    # What is half typed is not taken away.
    user.click_into(user.row("Joints", "drivewhl_l_joint").one("textbox"))
    user.keys("2")
    mouse.move(645.0, 120.0)
    user.keys(".", "5", "Enter")
    user.until(lambda: desk.viz.joint_positions["drivewhl_l_joint"] == 2.5)


def test_keys_are_for_tools_when_a_text_was_accepted(desk: Desk) -> None:
    user = desk.user
    options = "Displays", "Global Options"
    field = user.row(*options, "Fixed Frame").one("combobox")
    before = desk.fixed_frame
    user.enter(field, "drivewhl_l_link")
    user.until(lambda: desk.fixed_frame == "drivewhl_l_link")
    user.keys("n")
    desk.has_tool("Measure")
    assert not user.row(*options, "Fixed Frame").one("combobox").state("focused")
    # Who goes on through the rows types into them as before; Enter begins again, too.
    user.keys("ArrowDown")
    user.type("1;2;3")
    user.keys("Enter", "s")
    desk.has_tool("Select")
    color = desk.session.document.config.global_options
    user.until(lambda: color.get("Background Color") == (1, 2, 3))
    user.keys("Enter")
    user.type("4;5;6")
    user.keys("Enter")
    user.until(lambda: color.get("Background Color") == (4, 5, 6))
    user.keys("ArrowUp")
    user.type(before)
    user.keys("Enter")
    user.until(lambda: desk.fixed_frame == before)
    # What was refused is typed once more.
    user.keys("ArrowDown")
    user.type("seven")
    user.keys("Enter")
    user.reads("a colour such as")
    user.type("7;8;9")
    user.keys("Enter")
    user.until(lambda: color.get("Background Color") == (7, 8, 9))


def test_each_key_at_a_slider_is_a_step_also_when_the_one_before_is_down(
    desk: Desk,
) -> None:
    user, keyboard = desk.user, desk.page.keyboard
    user.click_on(user.find("slider", "drivewhl_l_joint"))
    desk.settle()

    def position() -> float:
        return desk.viz.joint_positions["drivewhl_l_joint"]

    reached = [position()]
    # The third key is still down when the fourth is pressed, as by a fast hand.
    for press in (
        partial(keyboard.press, "ArrowRight"),
        partial(keyboard.press, "ArrowRight"),
        partial(keyboard.hold, "ArrowRight"),
        partial(keyboard.press, "ArrowRight", "Shift"),
        partial(keyboard.press, "PageUp"),
        partial(keyboard.press, "Home"),
    ):
        press()
        user.until(lambda: position() != reached[-1])
        reached.append(position())
    for wanted in reached[-2::-1]:
        # The page knows what there is to undo.
        desk.settle()
        user.keys("Control+z")
        user.until(lambda wanted=wanted: position() == pytest.approx(wanted))
