"""A recording on a web server: what is asked for, and what is said when it fails."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import large_recording
import pytest
from lower_limit import lower
from web_server import WebServer, web_server

from sambot_viz.cli import main
from sambot_viz.errors import Problem, SourceError
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.bag.web_bytes import PIECE
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.topics.source_robot import SourceRobot


@pytest.fixture
def server(repository: Path) -> Iterator[WebServer]:
    with web_server((repository / "assets" / "square.mcap").read_bytes()) as server:
        yield server


def refusal(address: str) -> Problem:
    with pytest.raises(SourceError) as refused:
        open_recording(address)
    (problem,) = refused.value.problems
    return problem


@pytest.mark.parametrize("hangs_up", [False, True])
def test_it_has_the_messages_of_the_file(
    repository: Path, server: WebServer, hangs_up: bool
) -> None:
    server.hangs_up = hangs_up
    here = open_recording(repository / "assets" / "square.mcap")
    there = open_recording(server.address())
    names = list(here.topics)
    assert list(there.topics) == names
    for one, other in zip(
        here.messages(None, None, names), there.messages(None, None, names), strict=True
    ):
        assert (one.topic, one.log_ns) == (other.topic, other.log_ns)
        assert bytes(one.payload) == bytes(other.payload)
    here.close()
    there.close()


def test_what_is_not_looked_at_is_not_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "large.mcap"
    large_recording.write(path, 40_000_000)
    with web_server(path.read_bytes()) as server:
        recording = open_recording(server.address())
        while not recording.index_more():
            pass
        assert len(server.asked) <= 4, "its index, and what is before that"
        assert server.sent < 2_000_000

        before = len(server.asked)
        begin = large_recording.START + 30 * large_recording.STEP
        found = recording.messages(
            begin, begin + large_recording.STEP, ["/odom", "/tf"]
        )
        assert list(found)
        assert len(server.asked) - before <= 2, "one chunk"
        recording.close()


def test_what_has_come_is_not_asked_for_again(tmp_path: Path) -> None:
    path = tmp_path / "large.mcap"
    large_recording.write(path, 40_000_000)
    with web_server(path.read_bytes()) as server:
        with open_recording(server.address()) as recording:
            payloads = [bytes(one.payload) for one in recording.messages()]
            assert server.sent <= path.stat().st_size
            # More than the blocks that are kept in memory.
            asked = len(server.asked)
            assert [bytes(one.payload) for one in recording.messages()] == payloads
            assert len(server.asked) == asked
        with open_recording(path) as here:
            assert [bytes(one.payload) for one in here.messages()] == payloads


def test_more_than_may_be_kept_is_asked_for_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "WEB_PIECES", 5 * PIECE)
    path = tmp_path / "large.mcap"
    large_recording.write(path, 20_000_000)
    with web_server(path.read_bytes()) as server, open_recording(path) as here:
        with open_recording(server.address()) as there:
            for one, other in zip(here.messages(), there.messages(), strict=True):
                assert one.payload == other.payload
            assert server.sent > path.stat().st_size


def test_a_server_without_ranges_is_named_with_the_way_out(server: WebServer) -> None:
    server.has_ranges = False
    problem = refusal(server.address())
    assert problem.code == "web-without-ranges"
    assert "run.mcap only as a whole" in problem.message
    assert f"curl -LO '{server.address()}'" in problem.hint


def test_a_file_that_changes_meanwhile_is_not_mixed(tmp_path: Path) -> None:
    path = tmp_path / "large.mcap"
    large_recording.write(path, 20_000_000)
    with web_server(path.read_bytes()) as server:
        recording = open_recording(server.address())
        server.version = '"2"'
        with pytest.raises(
            SourceError, match="changed on the server since it was opened"
        ):
            list(recording.messages(None, None, ["/points"]))
        recording.close()


@pytest.mark.parametrize(
    ("name", "message"),
    [("no-run.mcap", "answered 404 Not Found"), ("no-%C3%A9.mcap", "no-é.mcap cannot")],
)
def test_a_file_that_is_not_there(server: WebServer, name: str, message: str) -> None:
    problem = refusal(server.address(name))
    assert message in problem.message
    assert problem.hint == f"see what curl -I '{server.address(name)}' says"


def test_nothing_is_read_ahead_of_what_is_shown(tmp_path: Path) -> None:
    path = tmp_path / "large.mcap"
    large_recording.write(path, 40_000_000)
    with web_server(path.read_bytes()) as server:
        recording = open_recording(server.address())
        assert recording.is_remote
        robot = SourceRobot(RecordingPlayback(recording, "web"), MessageTypes())
        sent = server.sent
        assert not robot.look_on()
        assert server.sent == sent
        robot.close()


def test_a_server_that_is_not_there(server: WebServer) -> None:
    address = server.address()
    server.shutdown()
    server.server_close()
    assert "there is no connection" in refusal(address).message


def test_what_opens_a_bucket_is_shown_to_nobody(server: WebServer) -> None:
    address = server.address("no-run.mcap").replace("//", "//bob:password@")
    problem = refusal(f"{address}?X-Signature=secret")
    assert "secret" not in repr(problem) and "password" not in repr(problem)


def test_an_empty_file(server: WebServer) -> None:
    server.content = b""
    assert refusal(server.address()).code == "file-empty"


def test_a_database_is_to_be_downloaded(server: WebServer) -> None:
    server.content = b"SQLite format 3\0" + bytes(5000)
    problem = refusal(server.address("run.db3"))
    assert problem.code == "web-file-kind"
    assert "curl -LO" in problem.hint


@pytest.mark.parametrize("flag", [(), ("--source",)])
def test_a_command_takes_the_address(
    server: WebServer, capsys: pytest.CaptureFixture[str], flag: tuple[str, ...]
) -> None:
    assert main(["topics", *flag, server.address()]) == 0
    assert "/joint_states" in capsys.readouterr().out
