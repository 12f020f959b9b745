"""The tile in the launcher of a real JupyterLab, with the real jupyter-server-proxy."""

from __future__ import annotations

import os
import signal
import socket
import stat
from collections.abc import Callable, Iterator, Mapping
from typing import Any
from urllib.request import urlopen

import numpy as np
import pytest
import viser
from a_jupyter import Lab, Place, a_lab, a_place, wait_until
from recorded_page import RecordedPage
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

# The same of our own code, without a JupyterLab: test_tile.py and test_model.py.
pytestmark = pytest.mark.slow

PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")
ARM = """<robot name="arm">
<link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
<link name="tool">
  <visual><geometry><mesh filename="tool.stl"/></geometry></visual>
</link>
<joint name="swing" type="continuous"><parent link="base"/><child link="tool"/></joint>
</robot>
"""
TILE = "document.querySelector('.jp-LauncherCard[title=\\'Robot viewer\\']')"
VIEWER = "document.querySelector('.jp-ServerProxy iframe').contentWindow"
TRIANGLES = (
    f"{VIEWER}.__viserMutable.nodeRefFromName['/0/1/~2_v0']"
    "?.getObjectByProperty('isMesh', true).geometry.index.count / 3"
)


def many_triangles(count: int) -> bytes:
    """A binary STL file of triangles, no two with a common corner."""
    facet = [("numbers", "<f4", (4, 3)), ("attribute", "<u2")]
    facets = np.zeros(count, facet)
    facets["numbers"] = np.random.default_rng(1).random((count, 4, 3))
    return bytes(80) + count.to_bytes(4, "little") + facets.tobytes()


def click(page: RecordedPage, element: str) -> None:
    page.wait_for(f"{element}?.checkVisibility()", 30.0)
    x, y, width, height = page.evaluate(
        f"(({{x, y, width, height}}) => [x, y, width, height])"
        f"({element}.getBoundingClientRect())"
    )
    page.mouse.click(x + width / 2, y + height / 2)


@pytest.fixture(scope="module")
def lab() -> Iterator[Lab]:
    with a_place() as place:
        package = place.work / "arm_description"
        package.mkdir()
        (package / "arm.urdf").write_text(ARM)
        (package / "tool.stl").write_bytes(many_triangles(20))
        with a_lab(place) as running:
            yield running


def test_the_tile_shows_the_model_of_the_folder(
    lab: Lab, open_in_browser: Callable[[str], RecordedPage]
) -> None:
    page = open_in_browser(f"{lab.url}lab?token={lab.token}")
    click(page, TILE)
    page.wait_for(f"{VIEWER}.__viserMutable?.scene", 60.0)
    page.wait_for(f"{TRIANGLES} === 20", 30.0)
    page.wait_for(f"{VIEWER}.document.body.innerText.includes('swing')", 30.0)
    address = page.evaluate(f"{VIEWER}.location.href")
    assert address == f"{lab.url}robot-viewer/"
    assert page.exceptions == []


def viewers(place: Place) -> list[int]:
    """The processes of viewers."""
    return [n for n, c in place.processes().items() if "-m sambot_viz.jupyter" in c]


def refused(url: str, **settings: Any) -> int:
    """The status with which a websocket is refused."""
    with pytest.raises(InvalidStatus) as error:
        connect(url, subprotocols=[PROTOCOL], **settings)
    return error.value.response.status_code


def viewer_of(
    url: str, headers: Mapping[str, str], origin: Origin | None = None
) -> ClientConnection:
    """A connection like that of the page."""
    return connect(
        url,
        subprotocols=[PROTOCOL],
        origin=origin,
        additional_headers=headers,
        max_size=None,
    )


def test_jupyter_lets_in_only_its_own_user_and_its_own_pages(lab: Lab) -> None:
    assert lab.ask("robot-viewer/")[0] == 200
    assert lab.ask("robot-viewer/", known=False)[0] == 302
    url = f"{lab.url.replace('http', 'ws')}robot-viewer/"
    assert refused(url) == 403
    with urlopen(f"{lab.url}lab?token={lab.token}") as page:
        cookie = page.headers["Set-Cookie"].partition(";")[0]
    known = {"Cookie": cookie}
    with viewer_of(url, known, Origin(lab.url.rstrip("/"))) as connection:
        assert connection.recv(timeout=10.0)
    evil = Origin("https://evil.example")
    assert refused(url, origin=evil, additional_headers=known) == 403


def test_a_robot_with_large_meshes_comes_through_the_proxy(lab: Lab) -> None:
    url = f"{lab.url.replace('http', 'ws')}robot-viewer/"
    with viewer_of(url, {"Authorization": f"token {lab.token}"}) as connection:
        mesh = lab.place.work / "arm_description" / "tool.stl"
        mesh.write_bytes(many_triangles(300_000))
        # Tornado takes 10 MiB in one message by itself.
        while len(connection.recv(timeout=30.0)) < 11 * 2**20:
            pass


def test_nobody_else_on_the_machine_reaches_the_viewer(lab: Lab) -> None:
    assert lab.ask("robot-viewer/")[0] == 200
    (path,) = lab.sockets()
    assert stat.S_IMODE(os.stat(path).st_mode) == 0o600
    assert stat.S_IMODE(os.stat(path.parent).st_mode) == 0o700
    (command,) = (c for c in lab.place.processes().values() if str(path) in c)
    assert "token" not in command.lower()
    # Also one who could open it would not be let in.
    with socket.socket(socket.AF_UNIX) as connection:
        connection.connect(str(path))
        connection.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        assert b" 401 " in connection.recv(100)


def test_a_viewer_that_was_ended_is_started_again(lab: Lab) -> None:
    assert lab.ask("robot-viewer/")[0] == 200
    (before,) = viewers(lab.place)
    os.kill(before, signal.SIGTERM)
    wait_until(lambda: before not in lab.place.processes())
    wait_until(lambda: lab.ask("robot-viewer/")[0] == 200)
    assert len(viewers(lab.place)) == 1


def test_the_viewer_ends_with_jupyter_also_when_that_is_killed() -> None:
    with a_place() as place, a_lab(place) as lab:
        assert lab.ask("robot-viewer/")[0] == 200
        (viewer,) = viewers(place)
        lab.process.kill()
        wait_until(lambda: viewer not in place.processes())
        assert "the bundled sam_bot is shown; no model in the folder" in place.log
