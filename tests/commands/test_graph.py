"""``sambot-viz graph``: what launch files would start, what runs, and both."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from dds_peer import DdsPeer
from launch_package import launch_package
from live_peers import STRING, FoxglovePeer, LivePeer
from patience import patience
from rosbridge_peer import RosbridgePeer
from zenoh_peer import ZenohPeer

from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]
FOR = ["--for", str(patience(5.0))]
_CONDITIONAL = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("extra", default_value="false"),
        DeclareLaunchArgument("name", default_value="a"),
        Node(package="demo_nodes_cpp", executable="talker",
             name=LaunchConfiguration("name"),
             condition=IfCondition(LaunchConfiguration("extra"))),
    ])
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return launch_package(tmp_path)


@pytest.fixture(params=[FoxglovePeer, RosbridgePeer, ZenohPeer, DdsPeer])
def peer(request: pytest.FixtureRequest) -> Iterator[LivePeer]:
    made = request.param()
    made.advertise("/chatter")
    if isinstance(made, FoxglovePeer):
        made.published_by("/chatter", "/talker")
    made.listen_as("/chatter", "/listener", "/logger")
    yield made
    made.stop()


def drawn(capsys: Capture, *words: str) -> dict[str, Any]:
    assert main(["graph", "--format", "json", *words]) == 0
    said: dict[str, Any] = json.loads(capsys.readouterr().out)
    return said


def states(said: dict[str, Any]) -> dict[str, str]:
    return {node["name"]: node["state"] for node in said["nodes"]}


def test_the_ending_of_the_file_decides_the_format(
    package: Path, tmp_path: Path
) -> None:
    for ending in ("svg", "dot", "json"):
        path = tmp_path / f"graph.{ending}"
        assert main(["graph", str(package), "-o", str(path)]) == 0
        assert "/talker" in path.read_text("utf-8")
    picture = (tmp_path / "graph.svg").read_text("utf-8")
    assert ElementTree.fromstring(picture).tag.endswith("svg")
    assert 'href="robot/launch/whole.launch.py#L' in picture


def test_without_a_file_the_dot_text_is_printed(package: Path, capsys: Capture) -> None:
    for words in ([], ["-o", "-"]):
        assert main(["graph", str(package), *words]) == 0
        assert capsys.readouterr().out.startswith("digraph ")


def test_of_several_launch_files_the_one_that_starts_most_is_drawn(
    package: Path, capsys: Capture
) -> None:
    assert main(["graph", str(package), "--format", "json"]) == 0
    out, err = capsys.readouterr()
    assert states(json.loads(out)) == {"/listener": "expected", "/talker": "expected"}
    assert "whole.launch.py, which starts most" in err
    assert "small.launch.py" in err


@pytest.mark.parametrize("name", ["small", "small.launch.py"])
def test_another_launch_file_can_be_chosen(
    package: Path, capsys: Capture, name: str
) -> None:
    said = drawn(capsys, str(package), "--launch", name)
    assert [*states(said)] == ["/listener"]
    file = package / "launch" / "small.launch.py"
    assert [*states(drawn(capsys, str(file)))] == ["/listener"]


def test_arguments_reach_the_launch_file_as_with_ros2_launch(
    package: Path, capsys: Capture
) -> None:
    file = package / "launch" / "small.launch.py"
    file.write_text(_CONDITIONAL, "utf-8")
    command = ["graph", str(file), "--format", "json"]
    for words, names in (([], []), (["extra:=true", "name:=b"], ["/b"])):
        assert main([*command, *words]) == 0
        out, err = capsys.readouterr()
        assert ([*states(json.loads(out))], err) == (names, "")
    assert main([*command, "extro:=true"]) == 0
    said = "no launch argument 'extro' is declared; did you mean 'extra'?"
    assert said in capsys.readouterr().err


def test_what_runs_is_drawn_as_the_robot_tells_it(
    peer: LivePeer, capsys: Capture
) -> None:
    said = drawn(capsys, "--source", peer.uri, *FOR)
    ends = {(e["node"], e["topic"], e["direction"]) for e in said["edges"]}
    assert ends == {
        ("/talker", "/chatter", "publishes"),
        ("/listener", "/chatter", "subscribes"),
        ("/logger", "/chatter", "subscribes"),
    }
    (topic,) = said["topics"]
    assert (topic["types"], topic["unwritten"]) == ([STRING], False)
    assert said["whole"] and said["notes"] == []


def test_what_was_expected_and_does_not_run_is_told(
    peer: LivePeer, package: Path, capsys: Capture
) -> None:
    peer.listen_as("/chatter", "/logger")
    said = drawn(capsys, str(package), "--source", peer.uri, *FOR)
    assert states(said) == {
        "/listener": "expected",
        "/logger": "running",
        "/talker": "both",
    }


def test_a_rosbridge_without_rosapi_says_what_is_not_known(capsys: Capture) -> None:
    peer = RosbridgePeer()
    try:
        peer.advertise("/chatter")
        del peer.services["/rosapi/nodes"]
        said = drawn(capsys, "--source", peer.uri, *FOR)
    finally:
        peer.stop()
    assert [topic["name"] for topic in said["topics"]] == ["/chatter"]
    assert "who publishes and reads is not known" in said["notes"][0]


def test_a_recording_has_topics_and_says_that_it_has_no_nodes(
    repository: Path, capsys: Capture
) -> None:
    said = drawn(capsys, "--source", str(repository / "assets" / "square.mcap"))
    assert said["nodes"] == []
    assert "/scan" in [topic["name"] for topic in said["topics"]]
    assert "a recording does not say who publishes" in said["notes"][0]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "name a package with launch files, or --source URI"),
        (["PACKAGE", "-o", "graph.pdf"], "dot -Tpdf"),
        (["PACKAGE", "-o", "none/graph.svg"], "cannot write"),
        (["PACKAGE", "--launch", "wole"], "did you mean 'whole.launch.py'?"),
        (["NONE"], "no model 'NONE'"),
        (["EMPTY"], "has no launch file"),
        (["--source", "rosbridge://127.0.0.1:1", "--launch", "x"], "name that too"),
    ],
)
def test_what_cannot_be_drawn_is_a_usage_error(
    package: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
    words: list[str],
    said: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "EMPTY").mkdir()
    words = [str(package) if word == "PACKAGE" else word for word in words]
    assert main(["graph", *words]) == 2
    assert said in capsys.readouterr().err
