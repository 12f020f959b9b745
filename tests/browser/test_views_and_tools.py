"""Views and tools with mouse and keyboard, in a real page."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from desk import Desk
from inside import node_of, session_of
from patience import patience
from viewer_page import ViewerPage

from sambot_viz import Visualizer, bundled
from sambot_viz.session import Session
from sambot_viz.session.clients.client_tools import ClientTools
from sambot_viz.session.clients.client_view import ClientView

pytestmark = [pytest.mark.browser, pytest.mark.view]

Open = Callable[..., ViewerPage]
SKY = (640.0, 80.0)
"""A place of the page with nothing but background."""
RECTANGLE = """(() => {
  const { canvas2d: { width, height }, canvas2d } = __viserMutable;
  return width > 0 && height > 0
    && canvas2d.getContext("2d").getImageData(0, 0, width, height).data.some(Boolean);
})()"""
"""Whether a rectangle is being drawn."""


def config() -> str:
    """sam_bot without axes, seen from above and near."""
    config = yaml.safe_load(bundled.config_path().read_text("utf-8"))
    manager = config["Visualization Manager"]
    manager["Displays"] = [
        d for d in manager["Displays"] if not d["Class"].endswith("/TF")
    ]
    manager["Global Options"]["Fixed Frame"] = "base_link"
    manager["Views"]["Current"] |= {
        "Distance": 2.0,
        "Yaw": 1.0,
        "Pitch": 0.5,
        "Focal Point": {"X": 0, "Y": 0, "Z": 0},
        "Target Frame": "<Fixed Frame>",
    }
    manager["Tools"] = [
        {"Class": f"rviz_default_plugins/{name}"}
        for name in ("MoveCamera", "Select", "FocusCamera", "Measure")
    ]
    return yaml.safe_dump(config)


@pytest.fixture
def desk(sit: Callable[..., Desk]) -> Desk:
    desk = sit("S tools", config())
    desk.viewer.wait_for_nodes(node_of(desk.viz, "drivewhl_l_link"))
    is_seen(desk.viewer)
    desk.settle()
    return desk


@pytest.fixture
def own(tmp_path: Path, make_viz: Callable[..., Visualizer]) -> Visualizer:
    """The same for what a desk cannot put back."""
    path = tmp_path / "views.rviz"
    path.write_text(config(), "utf-8")
    return make_viz(config=path)


def is_seen(viewer: ViewerPage) -> None:
    """Wait until a page shows the view of the config."""
    viewer.wait_for("window.sambotVizMouse && window.sambotVizMouse.kind === 'Orbit'")
    viewer.wait_for("Math.abs(__viserMutable.cameraControl.distance - 2) < 1e-3")


def until(viewer: ViewerPage, holds: Callable[[], bool]) -> None:
    """Wait until something holds on the server, while the page goes on drawing."""
    end = time.monotonic() + patience(30.0)
    while not holds():
        assert time.monotonic() < end, "the server did not hear of it in time"
        viewer.wait_for_frames()


def tools_of(session: Session) -> ClientTools:
    """Those of the only browser."""
    (browser,) = session.clients.all.values()
    return browser.tools


def view_of(session: Session) -> ClientView:
    """That of the only browser."""
    (browser,) = session.clients.all.values()
    return browser.view


def chosen(viz: Visualizer, viewer: ViewerPage, label: str) -> None:
    """Wait until a tool is current, on the server and in the page: a click that comes
    before the page has heard what to do with clicks is lost."""
    tools = tools_of(session_of(viz))
    until(viewer, lambda: tools.current.label == label)
    viewer.user.until(
        lambda: viewer.user.find("button", label, ("toolbar", "Tools")).is_on
    )
    viewer.settle(viz)


def value(session: Session, path: str) -> Any:
    return view_of(session).values[path]


def test_a_key_looks_from_a_side_and_the_mouse_goes_on_without_perspective(
    desk: Desk,
) -> None:
    session, viewer = desk.session, desk.viewer
    mouse, keyboard = viewer.page.mouse, viewer.page.keyboard
    keyboard.press("3")
    until(viewer, lambda: value(session, "Orthographic"))
    viewer.wait_for("__viserMutable.camera.fov < 1")
    desk.settle()
    # The same height of the picture above two points, one of them nearer by a metre.
    rows = [
        viewer.on_page((0.0, -y, 0.1))[1] - viewer.on_page((0.0, -y, 0.0))[1]
        for y in (0.0, 1.0)
    ]
    assert rows[0] == pytest.approx(rows[1], rel=0.02)
    distance = value(session, "Distance")
    mouse.wheel(*SKY, dy=-100.0)
    until(viewer, lambda: abs(value(session, "Distance") - 0.88 * distance) < 0.01)
    mouse.drag(SKY, (SKY[0] - 20, SKY[1]))
    yaw = 3 * np.pi / 2 + 0.1
    until(viewer, lambda: abs(value(session, "Yaw") - yaw) < 1e-4)
    assert value(session, "Orthographic")
    assert value(session, "Distance") == pytest.approx(0.88 * distance, rel=0.01)
    keyboard.press("z")
    until(viewer, lambda: not value(session, "Orthographic"))
    viewer.wait_for("__viserMutable.camera.fov > 40")


def test_a_tool_that_was_just_chosen_has_the_mouse_at_once(desk: Desk) -> None:
    """The press comes before the server has switched tools, and is for the new one."""
    session, viewer = desk.session, desk.viewer
    keyboard, mouse, tools = viewer.page.keyboard, viewer.page.mouse, tools_of(session)
    yaw = value(session, "Yaw")
    x, y = viewer.on_page((0.0, 0.0, 0.0))
    with session.lock:
        keyboard.press("s")
        mouse.move(x - 200, y - 150)
        mouse.press()
        mouse.move(x - 100, y - 100)
    mouse.move(x + 200, y + 150)
    mouse.release()
    until(viewer, lambda: len(tools.selection) > 1)
    assert value(session, "Yaw") == yaw
    selected = dict(tools.selection)
    # Escape ends a rectangle, and the tool with it.
    mouse.move(x - 50, y - 50)
    mouse.press()
    mouse.move(x + 50, y + 50)
    viewer.wait_for(RECTANGLE)
    keyboard.press("Escape")
    viewer.wait_for(f"!({RECTANGLE})")
    mouse.release()
    chosen(desk.viz, viewer, "Move Camera")
    assert tools.selection == selected
    point = viewer.on_page((0.6, 0.0, 0.0))
    keyboard.press("n")
    mouse.click(*point)
    until(viewer, lambda: "second point" in tools.status)
    # A drag between the two clicks turns the view.
    mouse.drag(SKY, (SKY[0] + 20, SKY[1]))
    until(viewer, lambda: abs(value(session, "Yaw") - yaw + 0.1) < 1e-4)
    yaw = value(session, "Yaw")
    keyboard.press("s")
    keyboard.press("m")
    mouse.drag(SKY, (SKY[0] - 20, SKY[1]))
    until(viewer, lambda: abs(value(session, "Yaw") - yaw - 0.1) < 1e-4)
    assert tools.selection == selected
    chosen(desk.viz, viewer, "Move Camera")


def test_a_rectangle_selects_from_the_first_pixel_of_a_link_on(
    own: Visualizer, open_viewer: Open
) -> None:
    session, viewer = session_of(own), open_viewer(own.url, resolution=1)
    viewer.wait_for_nodes(node_of(own, "drivewhl_l_link"))
    is_seen(viewer)
    viewer.settle(own)
    tools, mouse = tools_of(session), viewer.page.mouse
    session.document.set_option("Background Color", (255, 0, 255))
    for display in session.scene.displays:
        if "Alpha" in display.config.properties:
            is_robot = display.kind.endswith("/RobotModel")
            session.display_edits.set_property(
                display, "Alpha", 1.0 if is_robot else 0.0
            )
    viewer.page.keyboard.press("s")
    chosen(own, viewer, "Select")
    viewer.settle(own)
    until(viewer, lambda: bool((viewer.pixels()[5, 5, :3] == (255, 0, 255)).all()))
    # Edges are smoothed: what is only tinged is not taken for a pixel of the robot.
    robot = viewer.pixels()[..., 1] > 0
    left, right = np.flatnonzero(robot.any(axis=0))[[0, -1]].tolist()
    rows = np.flatnonzero(robot.any(axis=1))
    top, bottom = float(rows[0]), float(rows[-1])
    # Where the picture begins on the page.
    x = viewer.on_page((0.0, 0.0, 0.0))[0] - viewer.project("", (0.0, 0.0, 0.0))[0]
    for outside, edge, inwards in ((left - 40, left, 1), (right + 40, right, -1)):
        mouse.drag((x + outside, top), (x + edge + 2 * inwards, bottom))
        until(viewer, lambda: len(tools.selection) > 0)
        mouse.drag((x + outside, top), (x + edge - 2 * inwards, bottom))
        until(viewer, lambda: not tools.selection)


def test_tools_work_with_a_finger(own: Visualizer, open_viewer: Open) -> None:
    session = session_of(own)
    viewer = open_viewer(own.url, width=1024, height=768, touch=True)
    viewer.wait_for_nodes(node_of(own, "drivewhl_l_link"))
    viewer.settle(own)
    touch, tools = viewer.page.touch, tools_of(session)
    tools_bar = ("toolbar", "Tools")
    viewer.user.click("button", "Select", tools_bar)
    chosen(own, viewer, "Select")
    touch.tap(*viewer.on_page((0.0, 0.0, 0.09)))
    until(viewer, lambda: [item.name for item in tools.selection] == ["base_link"])
    corners = [viewer.on_page((x, y, 0.0)) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
    across, down = zip(*corners, strict=True)
    before = view_of(session).shown.camera
    touch.start((min(across), min(down)))
    touch.move((max(across), max(down)))
    touch.end()
    until(viewer, lambda: len(tools.selection) > 1)
    assert view_of(session).shown.camera is before
    # The page has drawn what the rectangle has selected before the next tap.
    viewer.user.reads(f"{len(tools.selection)} items selected")
    viewer.settle(own)
    viewer.user.click("button", "Measure", tools_bar)
    chosen(own, viewer, "Measure")
    touch.tap(*viewer.on_page((0.0, 0.0, 0.09)))
    until(viewer, lambda: tools.status == "Click the second point.")
    touch.tap(*viewer.on_page((0.1, 0.0, 0.09)))
    until(viewer, lambda: " m. " in tools.status)


TOP_DOWN = """(() => {
  const types = document.querySelector(".views .above select");
  types.value = [...types.options].find(o => o.label.startsWith("TopDownOrtho")).value;
  types.dispatchEvent(new Event("change", {bubbles: true}));
})()"""
"""Another type of view; the hand stays in the field that it is in."""


@pytest.mark.parametrize("typed", ["1.25", ""])
def test_a_field_that_goes_with_its_view_type_is_left_without_an_error(
    make_viz: Callable[..., Visualizer], open_viewer: Open, typed: str
) -> None:
    viz = make_viz()
    viewer = open_viewer(viz.url, view=False)
    user = viewer.user
    user.click_into(user.row("Views", "Yaw").one("textbox"))
    user.type(typed)
    viewer.page.evaluate(TOP_DOWN)
    user.until(lambda: "TopDownOrtho" in user.row("Views", "Current View").text)
    user.until(lambda: "Yaw" not in user.rows("Views"))
    assert viewer.errors() == []
