"""What a real browser does with the link, the cookie and the policy of the page."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from patience import until
from recorded_page import RecordedPage, open_page
from user import User
from viewer_page import ViewerPage, viewer_url

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium

pytestmark = pytest.mark.browser


def test_the_link_opens_the_page_and_a_reload_does_without(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    with Visualizer(port=0, look="rviz", token="") as viz:
        address, token = viz.url.split("?token=")
        viewer = open_viewer(viz.url)
        viewer.user.row("Joints", "drivewhl_l_joint")
        assert viewer.page.evaluate("location.href").partition("?")[0] == address
        assert token not in viewer.page.evaluate("document.cookie + location.href")
        viewer.page.goto(viewer_url(address, view=False))
        viewer.user.row("Joints", "drivewhl_l_joint")
        assert viewer.errors() == []
        # The server is closed before the page is.
        viewer.expects_errors = True


def test_below_a_path_the_websocket_is_in_the_folder_of_the_page(
    chromium: Chromium,
) -> None:
    """A proxy such as that of Jupyter knows no websocket at /robot, only at /robot/."""
    slow = "setTimeout(() => resolve(quick(...given)), 800)"
    late = (
        "const quick = WebAssembly.instantiate; WebAssembly.instantiate = "
        f"(...given) => new Promise((resolve) => {slow});"
    )
    with Visualizer(port=0, look="rviz", base_path="/robot") as viz:
        page = open_page(chromium, 640, 480)
        # viser unpacks itself before it reads the address; here that takes longer.
        page.call("Page.addScriptToEvaluateOnNewDocument", {"source": late})
        page.goto(f"{viz.url}/?fixedDpr=1")
        page.wait_for("__viserMutable.scene && !location.search.includes('ws')", 30.0)
        assert page.evaluate("location.href") == f"{viz.url}/?fixedDpr=1"
        # Both have the same ticket, and so the same address.
        (socket,) = until(lambda: sockets_of(page))
        assert socket.startswith(f"{viz.url.replace('http', 'ws')}/?ticket=")
        page.close()


REFUSED = "violates the following Content Security Policy"


def test_an_address_brings_no_recording_from_another_server(
    chromium: Chromium,
) -> None:
    with (
        Visualizer(port=0, look="rviz") as viz,
        Visualizer(port=0, look="rviz") as other,
    ):
        page = open_page(chromium, 640, 480)
        page.goto(f"{viz.url}/?playbackPath={other.url}/robot.viser")
        User(page).until(lambda: any(REFUSED in m.text for m in page.console), 20.0)
        page.close()


def test_a_page_connects_to_its_own_server_alone(chromium: Chromium) -> None:
    with (
        Visualizer(port=0, look="rviz") as viz,
        Visualizer(port=0, look="rviz") as other,
    ):
        page = open_page(chromium, 640, 480)
        own, foreign = (v.url.replace("http", "ws") for v in (viz, other))
        page.goto(f"{viz.url}/?websocket={foreign}")
        user = User(page)
        user.row("Joints", "drivewhl_l_joint")
        assert all(socket.startswith(own) for socket in sockets_of(page))
        page.evaluate(f"new WebSocket('{foreign}')")
        user.until(lambda: any(REFUSED in m.text for m in page.console))
        assert other.viser.get_clients() == {}
        page.close()


def sockets_of(page: RecordedPage) -> set[str]:
    """The addresses of the websockets that a page has asked for."""
    return {url for url in page.requests if url.startswith("ws:")}
