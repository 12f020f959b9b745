"""What the tile tells jupyter-server-proxy to start, and what that lets in."""

from __future__ import annotations

import http.client
import os
import socket
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace

import pytest
from patience import until

from sambot_viz import limits
from sambot_viz.jupyter.tile import robot_viewer

MODEL = '<robot name="arm"><link name="a"/></robot>'


def ask(path: Path, headers: Mapping[str, str]) -> tuple[int, str]:
    """The status and the text of the page behind a socket."""
    connection = http.client.HTTPConnection("localhost", timeout=20.0)
    connection.sock = socket.socket(socket.AF_UNIX)
    try:
        connection.sock.connect(str(path))
        connection.request("GET", "/", headers=dict(headers))
        answer = connection.getresponse()
        return answer.status, answer.read().decode()
    finally:
        connection.close()


@pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="needs such sockets")
def test_what_the_tile_starts_is_open_to_the_proxy_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tile = robot_viewer()
    # The path of a socket must be short.
    with TemporaryDirectory() as name:
        folder, path = Path(name), Path(name) / "socket"
        (folder / "arm.urdf").write_text(MODEL)
        monkeypatch.chdir(folder)
        command = tile["command"](0, str(path))
        environment = {**os.environ, **tile["environment"]}
        with subprocess.Popen(command, env=environment, stderr=-1, stdout=-1) as viewer:
            try:
                # The file is there before anybody listens.
                until(lambda: ask(path, {})[0] == 401, 30.0, not_yet=OSError)
                assert ask(path, {"Authorization": "Bearer of-another"})[0] == 401
                status, page = ask(path, tile["request_headers_override"])
                assert status == 200 and "sambot" in page
            finally:
                viewer.terminate()
            # jupyter-server-proxy starts one again that has not ended with 0.
            assert viewer.wait(30.0) == 1


def test_other_users_of_the_machine_read_no_token_in_the_command(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    tile = robot_viewer()
    (token,) = tile["environment"].values()
    assert token and tile["request_headers_override"] == {
        "Authorization": f"Bearer {token}"
    }
    monkeypatch.chdir(tmp_path)
    for place in ((8123, ""), (0, "/tmp/socket")):
        assert token not in " ".join(tile["command"](*place))
    assert tile["command"](8123, "")[-2:] == ["--port", "8123"]
    assert robot_viewer()["environment"] != tile["environment"]


def test_a_folder_with_braces_comes_through_the_proxy_s_own_placeholders(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    folder = tmp_path / "{port}"
    folder.mkdir()
    monkeypatch.chdir(folder)
    words = robot_viewer()["command"](0, "/tmp/socket")
    assert str(folder) in [word.format(port=0) for word in words]


def test_the_folder_is_the_one_that_jupyterlab_shows(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    server = SimpleNamespace(
        initialized=lambda: True, instance=lambda: SimpleNamespace(root_dir=tmp_path)
    )
    module = SimpleNamespace(ServerApp=server)
    monkeypatch.setitem(sys.modules, "jupyter_server.serverapp", module)
    assert str(tmp_path) in robot_viewer()["command"](0, "/tmp/socket")


def test_the_proxy_takes_as_large_messages_as_viser(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    websocket = SimpleNamespace(_default_max_message_size=10 * 2**20)
    monkeypatch.setitem(sys.modules, "tornado.websocket", websocket)
    robot_viewer()
    assert websocket._default_max_message_size == limits.NOTEBOOK_MESSAGE.value
