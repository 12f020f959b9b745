"""Several sources at once: two recordings, and a robot beside a recording."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from inside import session_of
from live_peers import eventually
from made_recording import START, described, write_recording
from robot_peer import RobotPeer, square_peer

from sambot_viz import UsageError, Visualizer
from sambot_viz.cli import main
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.panels.sources.source_panel import SourcePanel
from sambot_viz.topics import live_evidence

NS = 10**9


def run(folder: Path, name: str, begin: float = 0.0) -> Path:
    """A recording of a robot at as many metres as its times say, from a time on."""
    path = folder / f"{name}.mcap"
    told = [
        ("/tf", begin + second, {"base_link": "odom"}) for second in (0.0, 1.0, 2.0)
    ]
    texts = {} if begin else {"/robot_description": described("base_link")}
    return write_recording(path, texts, told)


@pytest.fixture
def peer(repository: Path) -> Iterator[RobotPeer]:
    with square_peer(repository, RobotPeer) as peer:
        yield peer


def x(viz: Visualizer, frame: str) -> float:
    prefix = frame.rpartition("/")[0]
    odom = f"{prefix}/odom".strip("/")
    return round(float(viz.frames.lookup(odom, frame).translation[0]), 2)


def is_at(
    at: float, peer: RobotPeer, seconds: float, viz: Visualizer, name: str
) -> bool:
    """Whether a robot that goes on publishing its place of a time is seen there [m]."""
    peer.play(seconds, from_s=seconds - 0.2)
    return x(viz, name) == pytest.approx(at, abs=0.03)


def test_two_recordings_of_one_time_are_beside_each_other(tmp_path: Path) -> None:
    one, other = run(tmp_path, "one"), run(tmp_path, "other")
    source = [f"a={one}", f"b={other}"]
    with Visualizer(source=source, source_prefix={"b": "robot2"}, port=0) as viz:
        session = session_of(viz)
        assert session.data is not None
        names = set(session.data.topics.names)
        assert names == {
            *("/tf", "/robot_description"),
            *("/robot2/tf", "/robot2/robot_description"),
        }
        viz.player.jump(1.0)
        assert (x(viz, "base_link"), x(viz, "robot2/base_link")) == (1.0, 1.0)


def test_the_robot_of_a_source_with_a_prefix_is_drawn_at_its_own_frames(
    tmp_path: Path,
) -> None:
    one, other = run(tmp_path, "one"), run(tmp_path, "other")
    prefixes, joined = {"b": "robot2"}, "0 3 0 0 0 0 odom robot2/odom"
    with Visualizer(
        source=[f"a={one}", f"b={other}"],
        source_prefix=prefixes,
        static_transforms=[joined],
        port=0,
    ) as viz:
        viz.player.jump(1.0)
        said = {name: account.reason for name, account in viz.topics.items()}
        assert {name: one.code for name, one in said.items() if one} == {}


def test_runs_of_two_days_begin_together(tmp_path: Path) -> None:
    one, other = run(tmp_path, "one"), run(tmp_path, "other", begin=86_400.0)
    source = [f"a={one}", f"b={other}"]
    with Visualizer(source=source, source_prefix={"b": "robot2"}, port=0) as viz:
        assert viz.player.duration == pytest.approx(2.0)
        viz.player.jump(1.0)
        assert (x(viz, "base_link"), x(viz, "robot2/base_link")) == (1.0, 86_401.0)


def test_the_same_topics_without_a_prefix_hide_each_other(tmp_path: Path) -> None:
    one, other = run(tmp_path, "one"), run(tmp_path, "other")
    with Inputs(Options(source=[f"a={one}", f"b={other}"])) as inputs:
        (problem,) = (p for p in inputs.problems() if p.code == "topic-hidden")
        assert inputs.moved_by is not None
        assert inputs.moved_by.name == "a and b"
    assert "/robot_description, /tf of a hide the same of b" in problem.message
    assert "--source b=URI --source-prefix b=robot2" in problem.hint
    with Inputs(Options(source=[f"a={one}", f"a={other}"])) as inputs:
        assert not [p for p in inputs.problems() if p.code == "topic-hidden"]


def test_a_recording_that_has_ended_is_no_robot_that_fell_silent(
    tmp_path: Path,
) -> None:
    one = run(tmp_path, "one")
    told = [("/tf", second / 2, {"base": "odom"}) for second in range(80)]
    times = [*(1.0 + count / 20 for count in range(20)), 30.0]
    scans = [(time, time) for time in times]
    texts = {"/robot_description": described("base")}
    other = write_recording(tmp_path / "other.mcap", texts, told, None, scans)
    source = [f"a={one}", f"b={other}"]
    with Visualizer(source=source, source_prefix={"a": "robot1"}, port=0) as viz:
        said = {}
        for seconds in (2.0, 9.0, 39.0):
            viz.player.jump(seconds)
            accounts = viz.topics
            said[seconds] = {
                n: "" if a.reason is None else a.reason.text
                for n, a in accounts.items()
            }
        assert said[2.0]["/robot1/tf"] == said[9.0]["/tf"] == said[39.0]["/tf"] == ""
        ended = "its recording ended at 2.0 s: go back there with the time bar or --at"
        assert said[9.0]["/robot1/tf"].startswith(ended)
        assert said[39.0]["/robot1/tf"].startswith(ended)
        assert viz.topics["/robot1/tf"].reason.severity == "info"
        silent = "silent from 2.0 s to 30.0 s: look at what publishes it"
        assert said[9.0]["/scan"] == silent
        last = "its last message came at 30.0 s: go back there with the time bar or --"
        assert last in said[39.0]["/scan"]


def test_a_recording_is_beside_a_robot(peer: RobotPeer, tmp_path: Path) -> None:
    before = run(tmp_path, "before")
    source = [f"before={before}", f"now={peer.uri}"]
    prefixes = {"before": "old"}
    with Visualizer(source=source, source_prefix=prefixes, port=0) as viz:
        session = session_of(viz)
        eventually(lambda: {"/tf", "/tf_static"} <= set(peer.subscribed()))
        eventually(lambda: is_at(1.0, peer, 9.0, viz, "base_link"))
        viz.player.jump(2.0)
        assert x(viz, "old/base_link") == 2.0
        # A jump of the recording is none of the robot, which has said nothing since.
        assert x(viz, "base_link") == pytest.approx(1.0, abs=0.03)
        # What can seek is played, and of the robot is told how it is.
        panel = SourcePanel(session.sources)
        assert [row.id for row in panel.rows()][:2] == ["player/time", "player/playing"]
        told = {one.id: one.value for one in panel.data()}
        assert told["player/name"] == "before"
        assert told["source/status"]["connected"]
        assert told["source/status"]["name"] == "now"
        assert panel.values()["player/time"] == 2.0
        # The robot goes on by itself.
        eventually(lambda: is_at(0.0, peer, 14.0, viz, "base_link"))
        assert x(viz, "old/base_link") == 2.0
        topics = session.data.topics
        assert {"/tf", "/old/tf"} <= set(topics.names)
        # The recording stands still while the robot's clock goes on.
        assert [session.data.is_paced(n) for n in ("old/base_link", "base_link")] == [
            True,
            False,
        ]
        messages = session.data.messages
        assert messages.now_ns("/old/tf") == (START + 2) * NS
        assert messages.now_ns("/tf") > messages.now_ns("/old/tf")


def test_two_robots_are_told_apart_by_a_prefix(
    peer: RobotPeer, repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live_evidence, "SILENT_AFTER", 0.0)
    with square_peer(repository, RobotPeer) as other:
        other.advertise("/quiet")
        source = [f"a={peer.uri}", f"b={other.uri}"]
        with Visualizer(source=source, source_prefix={"b": "b"}, port=0) as viz:
            for one in (peer, other):
                eventually(lambda one=one: "/tf" in one.subscribed())
            eventually(lambda: is_at(0.5, peer, 2.0, viz, "base_link"))
            eventually(lambda: is_at(1.0, other, 4.0, viz, "b/base_link"))
            data = session_of(viz).data
            assert data is not None
            assert data.moved_by.source.status.is_whole

            def said() -> str:
                with session_of(viz).lock:
                    data.topics.follow("test", data.topics.names)
                    reason = data.topics.account("/b/quiet").reason
                return "" if reason is None else reason.text

            eventually(lambda: "has come yet" in said())
            other.stop()
            eventually(lambda: not data.moved_by.source.status.is_whole)
            # Its topics are not to blame.
            assert "has come yet" not in said()
            # Which one is missing is said first, and by its name.
            told = {
                one.id: one.value for one in SourcePanel(session_of(viz).sources).data()
            }
            status = told["source/status"]
            assert (status["name"], status["connected"]) == ("a and b", False)
            assert status["sentence"].startswith("b: ")
            assert "; a: Connected to 127.0.0.1" in status["sentence"]


@pytest.mark.parametrize(
    ("source", "prefixes", "words"),
    [
        (["one.mcap"], {"a": "b"}, "no such source; none has a name"),
        (["a=one.mcap"], {"b": "x"}, "--source-prefix b: no such source; known: a"),
        (["a=one.mcap"], {"a": "x y"}, "a prefix has letters"),
        (["a=foxglove://h", "a=foxglove://i"], {}, "two sources are called a"),
    ],
)
def test_names_and_prefixes_that_cannot_be_are_refused(
    source: list[str], prefixes: dict[str, str], words: str
) -> None:
    with pytest.raises(UsageError, match=words):
        Options(source=source, source_prefix=prefixes)


@pytest.mark.parametrize("command", ["topics", "frames", "snapshot", "export", "echo"])
@pytest.mark.parametrize(
    "sources",
    [
        ["assets/square.mcap", "foxglove://127.0.0.1:1"],
        ["foxglove://127.0.0.1:1", "foxglove://127.0.0.1:2"],
        ["a=foxglove://127.0.0.1:1"],
    ],
)
def test_a_command_that_looks_once_listens_to_one_robot(
    command: str, sources: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [word for source in sources for word in ("--source", source)]
    if len(sources) == 1:
        words += ["--source-prefix", "a=robot1"]
    words += {
        "snapshot": ["-o", str(tmp_path / "a.png")],
        "export": ["-o", str(tmp_path / "a.html")],
        "echo": ["odom", "base_link"],
    }.get(command, [])
    assert main([command, *words]) == 2
    error = capsys.readouterr().err
    assert "listens to one robot, without a prefix or --remap: name one source" in error
    assert not list(tmp_path.iterdir())
