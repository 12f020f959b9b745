"""The life of a server: start, refusals, pages that come and go, stop."""

from __future__ import annotations

import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from urllib.request import urlopen

import pytest
import yaml
from live_peers import free_port
from patience import patience, until
from protocol_client import ProtocolClient

from sambot_viz import Visualizer, bundled, load_robot
from sambot_viz.errors import FrameError, Problem, ServerError
from sambot_viz.robot.model import Robot
from sambot_viz.server.server import Server
from sambot_viz.session import Session

Connect = Callable[..., ProtocolClient]
SLIDER = "drivewhl_l_joint"
ARM = """
<robot name="arm"><link name="base"/><link name="{tip}"/>
<joint name="j" type="continuous"><parent link="base"/><child link="{tip}"/></joint>
</robot>
"""


def is_free(port: int) -> bool:
    """Whether a server can listen on a port."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


def has_row(client: ProtocolClient, name: str) -> bool:
    return any(row.get("name") == name for row in client.rows.values())


def server_of(viz: Visualizer) -> Server:
    return viz._server  # pyright: ignore[reportPrivateUsage]


def test_a_stopped_server_frees_its_port_and_a_second_stop_does_nothing() -> None:
    port = free_port()
    for _ in range(2):
        viz = Visualizer(port=port)
        with urlopen(viz.url) as answer:
            assert answer.status == 200
        assert not is_free(port)
        viz.stop()
        viz.stop()
        assert is_free(port)


def test_a_taken_port_is_refused_and_the_other_server_goes_on() -> None:
    with Visualizer(port=0) as viz:
        with pytest.raises(ServerError, match="is taken by another program"):
            Visualizer(port=viz.viser.get_port())
        with urlopen(viz.url) as answer:
            assert answer.status == 200


@pytest.mark.parametrize("session", ["shared", "private"])
def test_a_refused_constructor_leaves_no_server(session: str) -> None:
    port = free_port()
    ring = ["0 0 0 0 0 0 a b", "0 0 0 0 0 0 b a"]
    if session == "shared":
        with pytest.raises(FrameError):
            Visualizer(port=port, static_transforms=ring)
    else:
        with pytest.raises(Exception, match="no such file"):
            Visualizer("no_such_model.urdf", port=port, session="private")
    assert is_free(port)


def test_an_error_while_the_robot_is_shown_leaves_no_server_and_no_thread(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("it happens")

    port, before = free_port(), set(threading.enumerate())
    monkeypatch.setattr(Session, "show_robot", fail)
    with pytest.raises(ZeroDivisionError):
        Visualizer(port=port)
    assert is_free(port)
    left = {t.name for t in set(threading.enumerate()) - before if t.is_alive()}
    assert not [name for name in left if name.startswith("sambot-viz")]


def test_a_private_page_that_opens_during_a_save_shows_what_was_saved(
    protocol: Connect, monkeypatch: pytest.MonkeyPatch
) -> None:
    old, new = (load_robot(ARM.format(tip=tip)) for tip in ("old", "new"))
    problem = Problem("error", "model-unreadable", "it was saved with a mistake")
    show = Session.show_robot
    with Visualizer(old, port=0, session="private") as viz:
        server, saves = server_of(viz), list[threading.Thread]()

        def show_during_a_save(session: Session, robot: Robot, **kind: bool) -> None:
            if not saves:
                saves.append(threading.Thread(target=save))
                saves[0].start()
                saved.wait(0.2)
            show(session, robot, **kind)

        saved = threading.Event()

        def save() -> None:
            server.sessions.show_robot(new)
            server.sessions.set_reload_problems("model", [problem])
            saved.set()

        monkeypatch.setattr(Session, "show_robot", show_during_a_save)
        client = protocol(viz.viser.get_port())
        client.wait_until(lambda: "it was saved with a mistake" in str(client.messages))
        saves[0].join(10.0)
        until(lambda: len(server.sessions.all()) == 1)
        (session,) = server.sessions.all()
        until(lambda: session.robot.model is new)
        assert session.problems.of_saves["model"] == (problem,)


def test_a_browser_may_leave_while_its_session_opens_and_meshes_load(
    protocol: Connect, caplog: pytest.LogCaptureFixture
) -> None:
    def workers() -> int:
        names = [thread.name for thread in threading.enumerate()]
        return names.count("sambot-viz-session")

    before = workers()
    with Visualizer(port=0, session="private") as viz:
        for _ in range(5):
            protocol(viz.viser.get_port()).close()
        last = protocol(viz.viser.get_port())
        last.wait_until(lambda: has_row(last, SLIDER))
        # The threads of those that left end; a late one is not another session.
        until(
            lambda: workers() == before + 1 and len(server_of(viz).sessions.all()) == 1
        )
        viz.set_joint_positions({SLIDER: 0.5})
        last.wait_until(lambda: last.shown("joints", SLIDER) == 0.5)
    assert [record.getMessage() for record in caplog.records] == []


def test_a_server_stops_while_a_page_opens(protocol: Connect) -> None:
    port = free_port()
    viz = Visualizer(port=port, session="private")
    clients = [protocol(port) for _ in range(3)]
    viz.stop()
    for client in clients:
        with pytest.raises(AssertionError, match="the connection ended"):
            client.wait_until(lambda: False)
    assert is_free(port)


def test_a_server_stops_although_a_browser_does_not_say_goodbye() -> None:
    port = free_port()
    viz = Visualizer(port=port)
    with socket.create_connection(("127.0.0.1", port)) as silent:
        silent.sendall(
            b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\n"
            b"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
            b"Sec-WebSocket-Protocol: viser-v1.1.1\r\n\r\n"
        )
        assert b"101" in silent.recv(100)
        stopping = threading.Thread(target=viz.stop)
        stopping.start()
        stopping.join(patience(8.0))
        assert not stopping.is_alive()
        assert is_free(port)


def test_a_private_session_changes_no_file_of_poses(
    tmp_path: Path, protocol: Connect
) -> None:
    shutil.copytree(bundled.assets_folder(), tmp_path, dirs_exist_ok=True)
    poses = tmp_path / "poses.yaml"
    poses.write_text(yaml.safe_dump({"given": {SLIDER: 0.5}}))
    before = poses.read_text()
    model = tmp_path / "sam_bot.urdf.xacro"
    with Visualizer(model, poses=poses, session="private") as viz:
        first, second = (protocol(viz.viser.get_port()) for _ in range(2))
        for client in (first, second):
            client.settle(viz.viser)
            assert "poses/save" in client.rows
            assert client.row("poses/names")["value"] == ["given"]
        first.act("poses/save", "of a visitor")
        first.wait_until(lambda: "of a visitor" in first.row("poses/names")["value"])
        second.settle(viz.viser)
        assert "of a visitor" not in str(second.messages)
    assert poses.read_text() == before


def test_a_script_that_ends_without_stop_prints_nothing() -> None:
    code = "from sambot_viz import Visualizer; a, b = Visualizer(), Visualizer()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
