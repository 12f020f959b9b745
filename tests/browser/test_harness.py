"""The helpers of the browser tests, tried on a bare viser server."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
import viser
from viewer_page import ViewerPage

pytestmark = pytest.mark.browser

Open = Callable[..., ViewerPage]


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    """A server with a red box that a slider moves along x."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    black = np.zeros((1, 1, 3), np.uint8)
    server.scene.set_background_image(black, format="png")
    # viser's environment light takes software OpenGL seconds to prepare.
    server.scene.configure_environment_map(None)
    server.scene.configure_default_lights(False)
    server.scene.add_light_ambient("/light", intensity=np.pi)
    box = server.scene.add_box("/group/box", color=(255, 0, 0))
    slider = server.gui.add_slider("along x", -1.0, 1.0, 0.1, 0.0)

    @slider.on_update
    async def _(event: viser.GuiEvent[viser.GuiSliderHandle[float]]) -> None:
        box.position = (event.target.value, 0.0, 0.0)

    yield server
    server.stop()


def translation(x: float) -> np.ndarray:
    T = np.eye(4)
    T[0, 3] = x
    return T


def test_the_page_shows_the_box_without_errors_or_foreign_requests(
    server: viser.ViserServer, open_viewer: Open
) -> None:
    viewer = open_viewer(server.get_port(), width=800, height=600)
    viewer.wait_for_nodes("/group/box")
    assert {"/group", "/group/box"} <= set(viewer.nodes)
    pixels = viewer.pixels()
    assert pixels.shape == (600, 800, 4)
    column, row = viewer.project("/group/box")
    red, green, blue, alpha = pixels[row, column].tolist()
    assert red > 200 and red > green + 50 and red > blue + 50 and alpha == 255
    assert pixels[5, 400].tolist() == [0, 0, 0, 255]
    assert viewer.errors() == []
    assert viewer.foreign_requests() == []
    assert {url.split(":")[0] for url in viewer.page.requests} == {"http", "ws"}


def test_a_slider_is_moved_by_its_label_and_the_pose_reaches_the_picture(
    server: viser.ViserServer, open_viewer: Open
) -> None:
    viewer = open_viewer(server.get_port())
    viewer.wait_for_nodes("/group/box")
    before = viewer.project("/group/box")
    viewer.press_slider("along x", "ArrowRight", times=3)
    viewer.wait_for_pose("/group/box", translation(0.3))
    assert viewer.slider_value("along x") == pytest.approx(0.3)
    assert viewer.pose("/group/box", "/group") == pytest.approx(translation(0.3))
    assert viewer.project("/group/box") != before
    viewer.press_slider("along x", "End")
    viewer.wait_for_pose("/group/box", translation(1.0))


def test_two_pages_stay_in_step(server: viser.ViserServer, open_viewer: Open) -> None:
    first, second = open_viewer(server.get_port()), open_viewer(server.get_port())
    for viewer in (first, second):
        viewer.wait_for_nodes("/group/box")
    first.press_slider("along x", "Home")
    for viewer in (first, second):
        viewer.wait_for_pose("/group/box", translation(-1.0))
        viewer.wait_for_slider("along x", -1.0)


def test_fields_checkboxes_and_buttons_are_found_by_their_labels(
    server: viser.ViserServer, open_viewer: Open
) -> None:
    number = server.gui.add_number("how many", 1.0, step=0.1)
    checkbox = server.gui.add_checkbox("shown", False)
    button = server.gui.add_button("Go on")
    answer = server.gui.add_markdown("nothing yet")

    async def tell(_event: object) -> None:
        answer.content = f"{number.value} {checkbox.value} {button.value}"

    number.on_update(tell)
    checkbox.on_update(tell)
    button.on_click(tell)
    viewer = open_viewer(server.get_port())
    viewer.enter("how many", "2.5")
    viewer.wait_for("document.body.innerText.includes('2.5 False')")
    viewer.click_checkbox("shown")
    viewer.wait_for("document.body.innerText.includes('2.5 True')")
    viewer.click_button("Go on")
    viewer.wait_for("document.body.innerText.includes('2.5 True True')")
    assert "how many" in viewer.text


def test_the_mouse_turns_the_camera_and_the_wheel_comes_nearer(
    server: viser.ViserServer, open_viewer: Open
) -> None:
    viewer = open_viewer(server.get_port(), width=640, height=480)
    viewer.wait_for_nodes("/group/box")
    position = "__viserMutable.camera.position.toArray()"
    distance = "__viserMutable.camera.position.length()"
    x, y, z = viewer.page.evaluate(position)
    viewer.page.mouse.drag((200.0, 400.0), (260.0, 400.0))
    viewer.wait_for(f"Math.abs({position}[0] - {x}) > 0.1")
    before = viewer.page.evaluate(distance)
    viewer.page.mouse.wheel(200.0, 400.0, dy=-200.0)
    viewer.wait_for(f"{distance} < {before} - 0.1")
    assert (x, y, z) != tuple(viewer.page.evaluate(position))


def test_an_error_in_the_page_is_noticed(
    server: viser.ViserServer, open_viewer: Open
) -> None:
    viewer = open_viewer(server.get_port())
    viewer.expects_errors = True
    viewer.page.evaluate("console.error('something', 1)")
    viewer.page.evaluate("void setTimeout(() => { throw new Error('late') })")
    viewer.wait_for("true")
    assert any(error.startswith("something 1") for error in viewer.errors())
    assert any("late" in error for error in viewer.errors())


def test_a_phone_has_fingers_and_a_narrow_page(
    server: viser.ViserServer, open_viewer: Open
) -> None:
    viewer = open_viewer(server.get_port(), width=390, height=844, touch=True)
    size = viewer.page.evaluate("[innerWidth, innerHeight, navigator.maxTouchPoints]")
    assert size[:2] == [390, 844] and size[2] > 0
    assert viewer.screenshot().shape == (844, 390, 4)
