"""A server that goes away and comes back, as the page tells it."""

from __future__ import annotations

import re
import socketserver
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from live_peers import free_port
from viewer_page import ViewerPage

from sambot_viz import Visualizer, bundled, viser_private

pytestmark = pytest.mark.browser

LEFT_LINK = "drivewhl_l_link"
LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
STOPPED = "The server restarts, or has stopped. This page comes back by itself."
CAMERA = "__viserMutable.camera.position.toArray()"


def has_camera(viewer: ViewerPage, camera: list[float]) -> None:
    """Wait until a page shows this camera."""
    viewer.user.until(lambda: viewer.page.evaluate(CAMERA) == pytest.approx(camera))


def test_the_page_comes_back_to_a_program_that_was_started_again(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    with Visualizer(port=free_port(), look="rviz") as first:
        port = first.viser.get_port()
        viewer, other = open_viewer(first.url), open_viewer(first.url)
        # The browser reports every attempt to connect that fails.
        viewer.expects_errors = other.expects_errors = True
        user = viewer.user
        for names in (("RobotModel",), ("Links",), ("Links", "base_link")):
            user.unfold("Displays", *names)
        user.row("Displays", "Links", "base_link", "Parent joint")
        first.set_joint_positions({LEFT: 1.0})
        for page in (viewer, other):
            page.user.until(lambda page=page: number(page) == "1")
        rows = user.rows("Displays")
        first.set_static_transform("base_link", "added", [0.0, 0.0, 1.0])
        user.tab("Frames")
        user.reads("added")
        user.tab("Joints")
    user.reads(STOPPED)
    assert user.rows("Displays") == rows
    # What is set meanwhile is shown as such, and sent.
    user.enter(user.row("Joints", RIGHT).one("textbox"), "0.5")
    user.reads("A change waits and is sent then.")
    user.unfold("Displays", "TF", "Frames")
    with Visualizer(port=port, look="rviz") as second:
        user.reads("The connection is back. The server was restarted.", 40.0)
        user.reads("Lost: the static transform of added.")
        user.until(lambda: dict(second.joint_positions) == {LEFT: 1.0, RIGHT: 0.5})
        other.user.reads("The connection is back.", 40.0)
        for page in (viewer, other):
            page.user.until(lambda page=page: number(page) == "1")
        user.row("Displays", "TF", "Frames", LEFT_LINK)
        user.unfold("Displays", "TF", "Frames", fold=True)
        user.until(lambda: user.rows("Displays") == rows)
        user.click("button", "OK")
        user.until(lambda: "connection is back" not in user.see().text)
        assert dict(second.joint_positions) == {LEFT: 1.0, RIGHT: 0.5}


def test_the_selected_rows_are_those_of_before_after_a_restart(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    link = ("Displays", "Links", "base_link")
    with Visualizer(port=free_port(), look="rviz") as first:
        port = first.viser.get_port()
        viewer = open_viewer(first.url)
        viewer.expects_errors = True
        user, edits = viewer.user, session_of(first).display_edits
        edits.add_display("rviz_default_plugins/Axes", place=(0, None))
        user.row("Displays", "Axes")
        edits.remove_display(session_of(first).document.config.displays[0])
        user.gone("row", "Axes")
        for names in (("RobotModel",), ("Links",)):
            user.unfold("Displays", *names)
        user.click_on(user.row(*link))
        user.tab("Frames")
        user.click_on(user.row("Frames", "To"))
    user.reads(STOPPED)
    with Visualizer(port=port, look="rviz"):
        user.reads("The connection is back. The server was restarted.", 40.0)
        user.until(lambda: user.row(*link).state("selected"))
        user.until(lambda: user.row("Frames", "To").state("selected"))


def test_a_page_whose_link_has_changed_says_so(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    with Visualizer(
        port=free_port(), look="rviz", token="the-first-lesson", presenter="the-teacher"
    ) as first:
        port = first.viser.get_port()
        viewer = open_viewer(first.url)
        viewer.expects_errors = True
        viewer.user.row("Joints", LEFT)
        viewer.user.find("button", "View only · Request control")
    viewer.user.reads(STOPPED)
    # Nobody can be asked: nothing lies over that sentence, and the sliders look idle.
    viewer.user.gone("button", "View only · Request control")
    viewer.wait_for("getComputedStyle(document.querySelector('.track')).opacity < 1")
    with Visualizer(port=port, look="rviz", token="the-second-lesson"):
        viewer.user.reads("Ask for the new one", 40.0)
    with Visualizer(port=port, look="rviz", token="the-first-lesson"):
        come_back(viewer)
        viewer.wait_for(
            "getComputedStyle(document.querySelector('.track')).opacity > 0.9"
        )


def come_back(viewer: ViewerPage) -> None:
    """Have the page try again, unless it does so by itself."""
    lost = ("Connection lost", STOPPED, "Ask for the new one")

    def back() -> bool:
        seen = viewer.user.see()
        for button in seen.all("button", "Try again"):
            viewer.user.click_on(button)
        return not any(words in seen.text for words in lost)

    viewer.user.until(back, 40.0)


def test_a_server_that_has_gone_gets_one_request_for_each_try_without_websockets(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    with Visualizer(port=free_port(), look="rviz") as viz:
        port = viz.viser.get_port()
        viewer = open_viewer(viz.url)
        viewer.expects_errors = True
        viewer.user.row("Joints", LEFT)
    requests: list[bytes] = []

    class Gone(socketserver.StreamRequestHandler):
        def handle(self) -> None:
            lines = iter(self.rfile.readline, b"\r\n")
            requests.append(b"".join(lines))
            self.wfile.write(b"HTTP/1.1 502 Gone\r\nContent-Length: 0\r\n\r\n")

    socketserver.TCPServer.allow_reuse_address = True
    with socketserver.TCPServer(("127.0.0.1", port), Gone) as gone:
        threading.Thread(target=gone.serve_forever, daemon=True).start()
        viewer.user.until(lambda: len(requests) >= 3, 40.0)
        gone.shutdown()
    # viser would have asked once a second, beside the page.
    assert not [one for one in requests if b"pgrade: websocket" in one]
    with Visualizer(port=port, look="rviz"):
        come_back(viewer)


WITHOUT_FOCUS = """(() => {
  Document.prototype.hasFocus = () => false;
  window.dispatchEvent(new Event("blur"));
})()"""


@pytest.mark.view
def test_pages_without_the_focus_come_back_with_the_cameras_of_their_users(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    cameras: list[list[float]] = []
    with Visualizer(port=free_port(), look="rviz") as first:
        port = first.viser.get_port()
        pages = [open_viewer(first.url), open_viewer(first.url)]
        for page, end in zip(pages, ((640.0, 330.0), (500.0, 250.0)), strict=True):
            page.expects_errors = True
            page.settle(first)
            page.page.mouse.drag((600.0, 300.0), end)
            page.settle(first)
            cameras.append(page.page.evaluate(CAMERA))
            page.page.evaluate(WITHOUT_FOCUS)
    assert cameras[0] != pytest.approx(cameras[1])
    with Visualizer(port=port, look="rviz") as second:
        for page in pages:
            page.user.reads("The connection is back.", 40.0)
        second.set_joint_positions({LEFT: 1.0})
        for page, camera in zip(pages, cameras, strict=True):
            page.user.until(lambda page=page: number(page) == "1")
            has_camera(page, camera)


@pytest.mark.view
def test_a_view_comes_back_to_the_frame_that_it_follows_wherever_that_is_then(
    open_viewer: Callable[..., ViewerPage], tmp_path: Path
) -> None:
    config = tmp_path / "following.rviz"
    text, view = bundled.config_path().read_text("utf-8"), "Value: Orbit (rviz)"
    assert view in text
    more = "Target Frame: rover\n      Distance: 2"
    config.write_text(text.replace(view, more), "utf-8")
    with Visualizer(config=config, port=free_port(), look="rviz") as first:
        port = first.viser.get_port()
        first.set_static_transform("base_link", "rover", [0.0, 2.0, 0.0])
        viewer = open_viewer(first.url)
        viewer.expects_errors = True
        viewer.settle(first)
        viewer.page.mouse.drag((600.0, 300.0), (640.0, 330.0))
        viewer.settle(first)
        values = values_of(first)
        assert values["Target Frame"] == "rover"
        yaw = f"{values['Yaw']:.3f}"
        viewer.user.until(
            lambda: viewer.user.row("Views", "Yaw").one("textbox").value[:5] == yaw[:5]
        )
    with Visualizer(config=config, port=port, look="rviz") as second:
        viewer.user.reads("The connection is back.", 40.0)
        viewer.settle(second)
        viewer.user.until(lambda: values_of(second) == values)
        second.set_static_transform("base_link", "rover", [0.0, -3.0, 0.0])
        viewer.settle(second)
        assert values_of(second) == values
        (client,) = session_of(second).clients.all.values()
        focal = values["Focal Point"]
        wanted = [focal[0], focal[1] - 3.0, focal[2]]
        assert client.view.camera.look_at.tolist() == pytest.approx(wanted, abs=1e-5)


def values_of(viz: Visualizer) -> dict[str, Any]:
    """The numbers of the view of the one page."""
    (client,) = session_of(viz).clients.all.values()
    return dict(client.view.values)


@pytest.mark.view
def test_a_page_that_slept_shows_how_things_are_now(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    with Visualizer(port=0, look="rviz") as viz:
        viewer = open_viewer(viz.url)
        viewer.expects_errors = True
        viewer.settle(viz)
        viewer.page.mouse.drag((600.0, 300.0), (640.0, 330.0))
        viewer.settle(viz)
        camera = viewer.page.evaluate(CAMERA)
        viewer.page.call("Page.setWebLifecycleState", {"state": "frozen"})
        # The server notices that nobody reads any more.
        (client,) = viz.viser.get_clients()
        connection = viser_private.connection_of(viz.viser, client)
        viz.viser.get_event_loop().call_soon_threadsafe(connection.transport.abort)
        viewer.user.until(lambda: not viz.viser.get_clients())
        viz.set_joint_positions({LEFT: 1.0})
        viewer.page.call("Page.setWebLifecycleState", {"state": "active"})
        viewer.user.until(lambda: number(viewer) == "1", 20.0)
        has_camera(viewer, camera)


def number(viewer: ViewerPage) -> str:
    return str(viewer.user.row("Joints", LEFT).one("textbox").value)


def test_the_config_that_was_open_is_opened_again_when_a_user_asks_for_it(
    open_viewer: Callable[..., ViewerPage], tmp_path: Path
) -> None:
    text = bundled.config_path().read_text("utf-8")
    first, second = tmp_path / "first.rviz", tmp_path / "second.rviz"
    first.write_text(text, "utf-8")
    second.write_text(text.replace("Name: Grid", "Name: Floor"), "utf-8")
    with Visualizer(config=first, port=free_port()) as viz:
        port = viz.viser.get_port()
        viewer = open_viewer(viz.url)
        viewer.expects_errors = True
        user = viewer.user
        user.menu("File", re.compile("^Open"))
        user.choose(user.find("listbox", "Configs"), "second")
        user.click("button", "Open", ("dialog", "Open Config"))
        user.unfold("Displays", "Floor")
        user.enter(user.row("Views", "Yaw").one("textbox"), "2")
        user.until(lambda: user.row("Views", "Yaw").one("textbox").value == "2")
        user.row("Displays", "Floor", "Cell Size")
    with Visualizer(config=first, port=port) as viz:
        user.reads(
            "The config first.rviz is open now; before, it was second.rviz.", 40.0
        )
        user.row("Displays", "Grid")
        user.click("button", "Open second.rviz")
        # It is unfolded as it was.
        user.row("Displays", "Floor", "Cell Size")
        user.until(lambda: user.row("Views", "Yaw").one("textbox").value == "2")
        user.until(lambda: "connection is back" not in user.see().text)


def test_a_page_that_was_left_is_not_counted_and_works_after_coming_back(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    with Visualizer(port=0, look="rviz") as viz:
        viewer, other = open_viewer(viz.url), open_viewer(viz.url)
        # The server is closed before the pages are.
        viewer.expects_errors = other.expects_errors = True
        viewer.user.unfold("Displays", "Grid")
        rows = viewer.user.rows("Displays")
        other.user.reads("2 browsers")
        viewer.page.goto("about:blank")
        other.user.until(lambda: "2 browsers" not in other.user.see().text)
        # It goes back after the answer, which would be lost with the page.
        viewer.page.evaluate("void setTimeout(() => history.back())")
        other.user.reads("2 browsers")
        viewer.user.until(lambda: viewer.user.rows("Displays") == rows)
        viewer.user.enter(viewer.user.row("Joints", LEFT).one("textbox"), "0.5")
        viewer.user.until(lambda: viz.joint_positions[LEFT] == 0.5)


def test_a_page_that_is_loaded_again_keeps_its_view_and_what_is_unfolded(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    with Visualizer(port=0, look="rviz") as viz:
        viewer = open_viewer(viz.url)
        # The server is closed before the page is.
        viewer.expects_errors = True
        user = viewer.user
        user.unfold("Displays", "Grid")
        user.unfold("Displays", "TF", "Frames")
        user.row("Displays", "TF", "Frames", LEFT_LINK)
        user.choose(user.find("combobox", "Type", ("region", "Views")), "XYOrbit")
        user.until(lambda: "XYOrbit" in user.row("Views", "Current View").text)
        user.enter(user.row("Views", "Yaw").one("textbox"), "2")
        user.until(lambda: user.row("Views", "Yaw").one("textbox").value == "2")
        rows, views = user.rows("Displays"), user.rows("Views")
        viewer.reload()
        user.until(lambda: user.rows("Displays") == rows)
        user.until(lambda: user.rows("Views") == views)
        user.until(lambda: user.row("Views", "Yaw").one("textbox").value == "2")
        assert "connection" not in user.see().text
        # What it has done with its view can be undone as before.
        user.until(lambda: not user.find("button", "Undo").state("disabled"))
        user.click("button", "Undo")
        user.until(lambda: user.row("Views", "Yaw").one("textbox").value != "2")
        assert "XYOrbit" in user.row("Views", "Current View").text
        user.click("button", "Undo")
        user.until(lambda: "XYOrbit" not in user.row("Views", "Current View").text)
        user.until(lambda: user.find("button", "Undo").state("disabled"))
