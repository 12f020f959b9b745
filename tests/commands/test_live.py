"""Commands that look once, and a robot on the network."""

from __future__ import annotations

import base64
import gzip
import json
import re
import threading
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path

import pytest
from dds_peer import DdsPeer
from live_peers import WAIT, FoxglovePeer, free_port
from patience import patience, until
from program import address, serving
from protocol_client import ProtocolClient
from robot_peer import BusyPeer, square_peer

from sambot_viz import listened
from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]
FOR = ["--for", str(patience(3.0))]


@pytest.fixture
def busy(repository: Path) -> Iterator[BusyPeer]:
    with square_peer(repository, BusyPeer) as peer:
        yield peer


@pytest.fixture
def peer() -> Iterator[FoxglovePeer]:
    peer = FoxglovePeer()
    yield peer
    peer.stop()


def test_topics_lists_what_came_and_what_did_not(
    busy: BusyPeer, capsys: Capture
) -> None:
    busy.advertise("/chatter")
    assert main(["topics", "--source", busy.uri, *FOR, "--format", "json"]) == 0
    rows = {row["name"]: row for row in json.loads(capsys.readouterr().out)["topics"]}
    assert sorted(rows) == list(rows)
    assert rows["/joint_states"]["type"] == "sensor_msgs/msg/JointState"
    assert rows["/joint_states"]["count"] > 100
    assert rows["/robot_description"]["count"] == 1
    assert rows["/scan"]["code"] is None
    silent = rows["/chatter"]
    assert (silent["count"], silent["rate"], silent["code"]) == (0, None, "no-message")
    assert "--for" in silent["reason"]


def test_topics_names_the_nodes_and_who_of_them_gets_nothing(capsys: Capture) -> None:
    robot = DdsPeer()
    robot.advertise("/words", is_loose=True, node="/lab/talker")
    robot.listen_as("/words", "/lab/logger")
    robot.listen_as("/goal", "/lab/planner")
    try:
        assert main(["topics", "--source", robot.uri, *FOR]) == 0
        lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
        assert "publishes   /lab/talker (Best Effort, Volatile)" in lines
        [deaf] = [line for line in lines if line.startswith("subscribes  /lab/logger")]
        assert "gets nothing from /lab/talker, which offers Best Effort" in deaf
        [wanted] = [line for line in lines if line.startswith("/goal")]
        assert "awaited: nobody publishes it, /lab/planner waits for it" in wanted
    finally:
        robot.stop()


def test_echo_and_frames_look_at_the_last_that_came(
    busy: BusyPeer, tmp_path: Path, capsys: Capture
) -> None:
    source = ["--source", busy.uri, *FOR]
    assert main(["echo", *source, "--format", "json", "odom", "base_link"]) == 0
    pose = json.loads(capsys.readouterr().out)
    assert pose["translation"] == pytest.approx([1.0, 1.0, 0.15], abs=0.01)
    drawn = tmp_path / "frames.json"
    assert main(["frames", *source, "-o", str(drawn)]) == 0
    transforms = json.loads(drawn.read_text("utf-8"))["transforms"]
    rates = {edge["child"]: edge["rate"] for edge in transforms}
    assert rates["base_link"] == pytest.approx(30.0, rel=0.01)
    assert rates["drivewhl_l_link"] == pytest.approx(20.0, rel=0.01)
    assert rates["lidar_link"] is None
    assert capsys.readouterr().err == ""
    assert busy.subscribed() == []


def test_a_page_has_the_motion_that_came(busy: BusyPeer, tmp_path: Path) -> None:
    page, done = tmp_path / "robot.html", threading.Event()

    def drive() -> None:
        for seconds in count(10.0, 0.05):
            if done.wait(0.01):
                return
            busy.play(seconds + 0.05, seconds)

    driving = threading.Thread(target=drive)
    driving.start()
    try:
        assert main(["export", "--source", busy.uri, *FOR, "-o", str(page)]) == 0
    finally:
        done.set()
        driving.join()
    text = page.read_text("utf-8")
    found = re.search(r'id="sambot-about"[^>]*>(.*?)</script>', text)
    tracks = re.search(r'id="sambot-motion"[^>]*>(.*?)</script>', text)
    assert found is not None and tracks is not None
    assert json.loads(found[1])["duration"] > 0.0
    moved = json.loads(gzip.decompress(base64.b64decode(tracks[1])))
    driven = [one for one in moved if one["type"] == "SetPositionMessage"]
    # Only a recording's robot drives.
    assert max(len(one["values"]) for one in driven) > 1


def test_a_model_beside_it_is_the_robot(busy: BusyPeer, capsys: Capture) -> None:
    words = ["echo", "--model", "assets/sam_bot.urdf.xacro", "--source", busy.uri, *FOR]
    assert main([*words, "base_link", "drivewhl_l_link"]) == 0
    assert "At time" in capsys.readouterr().out


def test_the_files_of_the_robot_come_from_it(tmp_path: Path, capsys: Capture) -> None:
    asked: list[str] = []

    def refuse(uri: str) -> None:
        asked.append(uri)

    peer = FoxglovePeer(asset_handler=refuse)
    try:
        mesh = '<mesh filename="package://lab/meshes/a.stl"/>'
        peer.advertise("/robot_description", latched=True)
        peer.publish(
            "/robot_description",
            f'<robot name="lab"><link name="base"><visual><geometry>{mesh}'
            "</geometry></visual></link></robot>",
        )
        page = str(tmp_path / "robot.html")
        assert main(["export", "--source", peer.uri, *FOR, "-o", page]) == 0
    finally:
        peer.stop()
    assert asked == ["package://lab/meshes/a.stl"]
    assert "asset_uri_allowlist" in capsys.readouterr().err


def test_a_robot_that_says_nothing_is_said(peer: FoxglovePeer, capsys: Capture) -> None:
    peer.advertise("/chatter")
    source = ["--source", peer.uri, "--for", "0.2"]
    assert main(["topics", *source]) == 0
    assert "nothing came within 0.2 s" in capsys.readouterr().out
    assert main(["frames", *source]) == 1
    out, err = capsys.readouterr()
    assert out == "" and len(err.splitlines()) == 1
    assert "nothing came within 0.2 s" in err and peer.uri in err


def test_a_latched_topic_that_is_silent_is_not_called_missing(
    peer: FoxglovePeer, capsys: Capture
) -> None:
    peer.advertise("/robot_description")
    peer.advertise("/chatter")
    source, done = ["--source", peer.uri, "--for", "1"], threading.Event()

    def talk() -> None:
        while not done.wait(0.02):
            peer.publish("/chatter", "hello")

    talking = threading.Thread(target=talk)
    talking.start()
    try:
        assert main(["topics", *source]) == 0
    finally:
        done.set()
        talking.join()
    err = capsys.readouterr().err
    assert "/robot_description is published, but no message of it came" in err
    assert "latched (Transient Local)" in err and "--for" in err


def test_a_robot_that_does_not_answer_is_waited_for_with_a_note(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(listened, "CONNECTED_WITHIN", 0.5)
    monkeypatch.setattr(listened, "QUIET", 0.1)
    assert main(["topics", "--source", f"foxglove://127.0.0.1:{free_port()}"]) == 1
    first, last = capsys.readouterr().err.splitlines()
    assert first.endswith("s more …") and "foxglove_bridge" in last


def test_a_robot_that_is_not_there_is_said(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(listened, "CONNECTED_WITHIN", 0.3)
    source = f"foxglove://127.0.0.1:{free_port()}"
    assert main(["topics", "--source", source]) == 1
    out, err = capsys.readouterr()
    assert out == "" and len(err.splitlines()) == 1
    assert "foxglove_bridge" in err


@pytest.mark.parametrize("time", ["0", "-1", "nan", "inf", "two"])
def test_a_time_to_listen_that_makes_no_sense(time: str, capsys: Capture) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["topics", "--source", "foxglove://127.0.0.1:1", f"--for={time}"])
    assert ended.value.code == 2
    assert f"{time} is not a time" in capsys.readouterr().err


@pytest.mark.parametrize("words", [[], ["topics"], ["frames"], ["check"]])
def test_an_address_as_the_model_says_where_it_belongs(
    words: list[str], capsys: Capture
) -> None:
    assert main([*words, "foxglove+wss://127.0.0.1:1"]) == 2
    assert "write --source foxglove+wss://127.0.0.1:1" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["topics"], []])
def test_a_live_robot_has_no_time_to_look_at(words: list[str], capsys: Capture) -> None:
    source = "foxglove://127.0.0.1:1"
    assert main([*words, "--source", source, "--at", "3"]) == 2
    assert "--at is a time of a recording" in capsys.readouterr().err


def test_a_time_that_was_not_listened_to_says_how_to_listen_longer(
    busy: BusyPeer, capsys: Capture
) -> None:
    source = ["--source", busy.uri, *FOR, "--at", "900"]
    assert main(["echo", *source, "odom", "base_link"]) == 0
    assert "or listen longer with --for" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["topics"], ["frames"]])
def test_a_robot_that_leaves_while_it_is_listened_to_is_said(
    words: list[str], busy: BusyPeer, capsys: Capture
) -> None:
    def leave() -> None:
        until(lambda: {"/tf", "/scan"} <= set(busy.subscribed()), WAIT)
        busy.stop()

    leaving = threading.Thread(target=leave)
    leaving.start()
    # It is said at once, and not after these seconds.
    status = main([*words, "--source", busy.uri, "--for", "600"])
    leaving.join()
    out, err = capsys.readouterr()
    assert "the connection was lost after" in err
    # It may have left before anything of it was written.
    assert status == 1 or "_link" in out or "/scan" in out


def test_joints_do_not_end_a_program_that_waits_for_its_robot(
    peer: FoxglovePeer, tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    words = ("--source", peer.uri, "--joint", "lead=1", "--port", "0")
    with serving(*words, cwd=tmp_path) as program:
        page = protocol(int(address(program).rsplit(":", 1)[1]))
        page.wait_until(lambda: "joints/none" in page.rows)
        assert program.end() == (0, "", "")


@pytest.mark.parametrize(
    ("flags", "said"),
    [
        (("--record", "there"), "is there already"),
        (("--record", "dangling"), "is there already"),
        (("--record", "folder"), "is there already"),
        (("--record", "no/a.mcap"), "there is no folder no"),
        (("--record", "there/a.mcap"), "is not a folder"),
        (("--record", f"{300 * 'a'}.mcap"), "cannot be written"),
        (("--record", "/proc/a.mcap"), "the folder /proc takes no file"),
        (("--record-dir", "/proc"), "the folder /proc takes no file"),
        (("--record-dir", "there"), "is not a folder"),
        (("--record-dir", "no"), "there is no folder no"),
    ],
)
@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs Linux's /proc")
def test_where_nothing_can_be_recorded_is_said_before_there_is_a_page(
    flags: tuple[str, str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("there").write_text("kept")
    Path("folder").mkdir()
    Path("dangling").symlink_to("nowhere")
    before = sorted(tmp_path.iterdir())
    source = f"foxglove://127.0.0.1:{free_port()}"
    assert main(["--source", source, "--port", "0", *flags]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert said in err
    assert sorted(tmp_path.iterdir()) == before


def test_a_recording_of_the_command_line_says_what_it_has(
    peer: FoxglovePeer, tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    peer.advertise("/chatter", latched=True)
    peer.publish("/chatter", "one")
    path = tmp_path / "one.mcap"
    words = ("--source", peer.uri, "--record", str(path), "--port", "0")
    with serving(*words, cwd=tmp_path) as program:
        page = protocol(int(address(program).rsplit(":", 1)[1]))
        # What is loaded by then can be ended, too.
        page.wait_until(lambda: "joints/none" in page.rows)
        until(lambda: path.exists() and path.stat().st_size > 200, WAIT)
        _, _, err = program.end()
    (said,) = err.splitlines()
    assert f"recorded {path}: 1 messages in " in said
