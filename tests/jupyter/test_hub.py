"""A real JupyterHub with two users: each has a viewer that the other cannot see."""

from __future__ import annotations

import html
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from typing import Any
from urllib.parse import urlsplit

import pytest
from a_jupyter import Hub, User, a_hub, a_place, ask
from protocol_client import ProtocolClient
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

# The same of our own code, without a JupyterHub: test_frame.py and test_tile.py.
pytestmark = pytest.mark.slow

ROBOT = '<robot name="{0}"><link name="link_of_{0}"/></robot>'
CELL = "from sambot_viz import Visualizer\nviz = Visualizer()\nviz"


@pytest.fixture(scope="module")
def hub() -> Iterator[Hub]:
    with a_place() as place:
        for name in ("ada", "ben"):
            (place.folder / name).mkdir()
            (place.folder / name / "robot.urdf").write_text(ROBOT.format(name))
        with a_hub(place) as running:
            yield running


@pytest.fixture(scope="module")
def ada(hub: Hub) -> User:
    return hub.log_in("ada")


@pytest.fixture(scope="module")
def ben(hub: Hub) -> User:
    return hub.log_in("ben")


def scene(user: User, path: str) -> str:
    """What comes through the hub to the page of a user, up to the first link."""
    headers = {**user.cookies(path), "Origin": user.url.rstrip("/")}
    port = urlsplit(user.url).port or 0
    client = ProtocolClient(port, path=f"/{path}", headers=headers)
    try:
        client.wait_until(lambda: "link_of_" in str(client.messages), 20.0)
        return str(client.messages)
    finally:
        client.close()


def test_each_user_sees_the_robot_in_their_own_folder(ada: User, ben: User) -> None:
    for user in (ada, ben):
        path = f"user/{user.name}/robot-viewer/"
        status, page = user.ask(path)
        assert (status, "sambot" in page) == (200, True)
        found = scene(user, path)
        others = "ada" if user is ben else "ben"
        assert f"link_of_{user.name}" in found
        assert f"link_of_{others}" not in found


def test_the_hub_shows_a_viewer_to_nobody_else(hub: Hub, ada: User, ben: User) -> None:
    path = "user/ben/robot-viewer/"
    assert ben.ask(path)[0] == 200
    assert ada.ask(path)[0] == 403
    with pytest.raises(InvalidStatus) as refused:
        scene(ada, path)
    assert refused.value.response.status_code == 403
    stranger = User(hub.url, "eve")
    assert "Sign in" in stranger.ask(path)[1]
    with pytest.raises(InvalidStatus) as refused:
        scene(stranger, path)
    assert refused.value.response.status_code == 403


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="needs root")
def test_another_user_of_the_machine_cannot_open_the_socket(
    hub: Hub, ada: User
) -> None:
    assert ada.ask("user/ada/robot-viewer/")[0] == 200
    knock = (
        "import os, socket, sys\n"
        "os.setgroups([]), os.setgid(65534), os.setuid(65534)\n"
        "s = socket.socket(socket.AF_UNIX)\n"
        "try: s.connect(sys.argv[1])\n"
        "except PermissionError: print('refused')"
    )
    sockets = list(hub.place.folder.glob("jupyter-server-proxy-*/socket"))
    assert sockets
    for path in sockets:
        assert path.parent.parent.stat().st_mode & 0o001
        done = subprocess.run(
            [sys.executable, "-I", "-c", knock, str(path)],
            check=False,
            capture_output=True,
            text=True,
        )
        assert done.stdout == "refused\n", done.stderr


def frame_of_a_cell(hub: Hub, name: str, code: str) -> str:
    """Run a cell in a new kernel of a user; what it shows as HTML."""
    kernel = hub.ask(f"user/{name}/api/kernels", {}, "POST")["id"]
    url = f"{hub.url.replace('http', 'ws')}user/{name}/api/kernels/{kernel}/channels"
    header = {
        "msg_id": "1",
        "msg_type": "execute_request",
        "session": "s",
        "username": "",
    }
    request: dict[str, Any] = {
        "channel": "shell",
        "header": {**header, "version": "5.3"},
        "parent_header": {},
        "metadata": {"cellId": "first"},
        "content": {"code": code, "silent": False},
    }
    with connect(
        url, additional_headers={"Authorization": f"token {hub.token}"}
    ) as connection:
        connection.send(json.dumps(request))
        while True:
            message = json.loads(connection.recv(timeout=60.0))
            assert message["msg_type"] != "error", message["content"]
            if message["msg_type"] == "execute_result":
                return message["content"]["data"]["text/html"]


def test_a_cell_shows_its_page_through_the_hub_to_its_own_user(
    hub: Hub, ada: User, ben: User
) -> None:
    frame = frame_of_a_cell(hub, "ada", CELL)
    match = re.search(r'src="/(user/ada/proxy/(\d+)/)"', html.unescape(frame))
    assert match and "token" not in frame, frame
    path, port = match.groups()
    # Ben is not even let in by the hub, and the port alone asks for the token.
    assert ben.ask(path)[0] == 403
    alone = f"http://127.0.0.1:{port}/"
    assert ask(alone)[0] == 401
    assert ask(alone, headers=ben.cookies("user/ben/lab"))[0] == 401
    # Ada is known by the cookies of her Jupyter server.
    status, page = ada.ask(path)
    assert (status, "sambot" in page) == (200, True)
    # From now on the viewer has a cookie of its own, for this path only.
    assert ada.ask(path)[0] == 200
    name = re.compile(r"sambot-viz-\w+=")
    assert name.search(ada.cookies(path)["Cookie"])
    assert not name.search(ada.cookies("user/ada/lab")["Cookie"])
