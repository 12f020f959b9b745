"""The helpers of the browser tests, tried on a bare viser server."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
import viser
from ax_tree import rows_of
from desk import Desk
from patience import until
from viewer_page import ViewerPage

pytestmark = pytest.mark.browser

Open = Callable[..., ViewerPage]


@pytest.fixture(scope="module")
def server() -> Iterator[viser.ViserServer]:
    """A server with a red box."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    black = np.zeros((1, 1, 3), np.uint8)
    server.scene.set_background_image(black, format="png")
    # viser's environment light takes software OpenGL seconds to prepare.
    server.scene.configure_environment_map(None)
    server.scene.configure_default_lights(False)
    server.scene.add_light_ambient("/light", intensity=np.pi)
    server.scene.add_box("/group/box", color=(255, 0, 0))
    yield server
    server.stop()


@pytest.fixture(scope="module")
def viewer(server: viser.ViserServer, open_for_all: Open) -> ViewerPage:
    viewer = open_for_all(server.get_port(), width=800, height=600, view=True)
    viewer.wait_for_nodes("/group/box")
    return viewer


def test_the_page_shows_the_box_without_errors_or_foreign_requests(
    viewer: ViewerPage,
) -> None:
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


def test_the_mouse_turns_the_camera_and_the_wheel_comes_nearer(
    viewer: ViewerPage,
) -> None:
    position = "__viserMutable.camera.position.toArray()"
    distance = "__viserMutable.camera.position.length()"
    x, y, z = viewer.page.evaluate(position)
    viewer.page.mouse.drag((200.0, 400.0), (260.0, 400.0))
    viewer.wait_for(f"Math.abs({position}[0] - {x}) > 0.1")
    before = viewer.page.evaluate(distance)
    viewer.page.mouse.wheel(200.0, 400.0, dy=-200.0)
    viewer.wait_for(f"{distance} < {before} - 0.1")
    assert (x, y, z) != tuple(viewer.page.evaluate(position))


def test_an_error_in_the_page_is_noticed(viewer: ViewerPage) -> None:
    assert viewer.errors() == []
    viewer.expects_errors = True
    viewer.page.evaluate("console.error('something', 1)")
    viewer.page.evaluate("void setTimeout(() => { throw new Error('late') })")
    for begin in ("something 1", "Error: late"):
        until(lambda begin=begin: any(e.startswith(begin) for e in viewer.errors()))


def test_a_phone_has_fingers_and_a_narrow_page(viewer: ViewerPage) -> None:
    viewer.page.set_touch(390, 844)
    viewer.wait_for("innerWidth === 390 && innerHeight === 844")
    assert viewer.page.evaluate("navigator.maxTouchPoints") > 0
    until(lambda: viewer.screenshot().shape == (844, 390, 4))


def test_a_role_is_looked_for_as_in_the_whole_page(sit: Callable[..., Desk]) -> None:
    user = sit("S").user
    whole = user.see().look_inside()
    for role in {thing.role for thing in whole.walk()}:
        found = [(t.node, t.name, t.value, t.states) for t in user.see().all(role)]
        wanted = [(t.node, t.name, t.value, t.states) for t in whole.all(role)]
        assert found == wanted, role
    for path, row in rows_of(user.see().one("treegrid", "Displays")):
        assert path[-1] == row.all("gridcell")[0].name
