"""``sambot-viz topics``: what a recording has, and why nothing of a topic is seen."""

from __future__ import annotations

import json
from pathlib import Path
from shutil import copy

import pytest

from sambot_viz.cli import main
from sambot_viz.commands.topics import topic_json, topics_text
from sambot_viz.messages import Schema
from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import Kind, RosEndpoint, TopicEndpoints
from sambot_viz.topics.account import Account
from sambot_viz.topics.reasons import TopicReason

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def square(repository: Path) -> str:
    return str(repository / "assets" / "square.mcap")


@pytest.fixture
def made(shared: Path) -> Path:
    return shared / "data" / "bags" / "made"


def test_the_table_has_a_line_for_each_topic(square: str, capsys: Capture) -> None:
    assert main(["topics", square]) == 0
    out, err = capsys.readouterr()
    lines = {line.split()[0]: line.split()[1:] for line in out.splitlines()}
    assert lines.pop("TOPIC") == ["TYPE", "COUNT", "RATE", "REASON"]
    assert len(lines) == 6
    assert lines["/tf"] == ["tf2_msgs/msg/TFMessage", "1000", "50.0"]
    assert lines["/scan"] == ["sensor_msgs/msg/LaserScan", "100", "5.0"]
    assert err == ""


def test_json_has_the_same_with_full_names(square: str, capsys: Capture) -> None:
    assert main(["topics", "--format", "json", square]) == 0
    topics = json.loads(capsys.readouterr().out)["topics"]
    rows = {row["name"]: row for row in topics}
    assert rows["/joint_states"] == {
        "name": "/joint_states",
        "type": "sensor_msgs/msg/JointState",
        "count": 400,
        "rate": pytest.approx(20, rel=0.01),
        "readable": True,
        "reason": None,
        "code": None,
        "nodes": None,
    }
    assert rows["/scan"]["code"] is None


def test_what_is_wrong_with_frames_and_file_is_on_standard_error(
    made: Path, capsys: Capture
) -> None:
    for name, codes in (
        ("two_parents.mcap", ["two-parents"]),
        ("clock_back.mcap", ["clock-back"]),
        ("log_back.mcap", ["log-back"]),
        ("cut60.mcap", ["file-cut"]),
        ("no_description.mcap", ["no-description"]),
    ):
        assert main(["topics", str(made / name)]) == 0
        err = capsys.readouterr().err
        assert all(f"[{code}]" in err for code in codes), (name, err)


def test_at_looks_at_that_time(made: Path, capsys: Capture) -> None:
    path = str(made / "description_late.mcap")
    assert main(["topics", path, "--at", "1"]) == 0
    assert "not-here-yet: begins at 3.0 s" in capsys.readouterr().out
    assert main(["topics", path, "--at", "4"]) == 0
    assert "not-here-yet" not in capsys.readouterr().out


def test_a_file_that_is_no_recording_is_one_line(
    repository: Path, made: Path, capsys: Capture
) -> None:
    assert main(["topics"]) == 2
    assert "name a recording" in capsys.readouterr().err
    assert main(["topics", str(repository / "assets" / "sam_bot.urdf.xacro")]) == 2
    assert "is not a recording" in capsys.readouterr().err
    assert main(["topics", "nowhere.mcap"]) == 2
    assert "does not exist" in capsys.readouterr().err
    for name in ("empty.mcap", "no_messages.mcap", "garbage.mcap"):
        assert main(["topics", str(made / name)]) == 1
        assert len(capsys.readouterr().err.splitlines()) == 1


@pytest.mark.parametrize("ending", ["mcap", "bag", "db3"])
def test_a_recording_that_git_lfs_has_not_fetched_says_how_to_fetch_it(
    tmp_path: Path, capsys: Capture, ending: str
) -> None:
    path = tmp_path / f"a.{ending}"
    path.write_text(
        "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"
    )
    assert main(["topics", str(path)]) == 1
    said = capsys.readouterr().err
    assert f"a.{ending} is a git-LFS pointer, not the recording itself" in said
    assert "run 'git lfs pull' in its repository" in said


def test_files_that_are_counted_together_are_named(
    square: str, tmp_path: Path, capsys: Capture
) -> None:
    folder = tmp_path / "lab"
    folder.mkdir()
    for name in ("first.mcap", "second.mcap"):
        copy(square, folder / name)
    for words in ([str(folder)], ["--source", f"bag:{folder}"]):
        assert main(["topics", *words]) == 0
        out, err = capsys.readouterr()
        assert "2000" in out
        assert "2 files are counted as one recording: first.mcap, second.mcap" in err
    # Who has named them knows that they are two.
    named = [f"--source={n}={folder / n}.mcap" for n in ("first", "second")]
    assert main(["topics", *named]) == 0
    assert "counted as one" not in capsys.readouterr().err
    # The parts of one that rosbag2 has split are one.
    (folder / "metadata.yaml").write_text("", "utf-8")
    assert main(["topics", str(folder)]) == 0
    assert capsys.readouterr().err == ""


def test_a_sentence_about_several_recordings_is_about_several(
    made: Path, capsys: Capture
) -> None:
    one = made / "no_description.mcap"
    words = ["--source", f"bag:{one}", "--source", f"bag:{one}"]
    assert main(["topics", *words]) == 0
    assert "no robot model in 2 recordings" in capsys.readouterr().err


def test_thousands_of_topics_are_listed(made: Path, capsys: Capture) -> None:
    assert main(["topics", str(made / "many_topics.mcap"), "--format", "json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["topics"]) == 4006


@pytest.mark.parametrize("command", ["check", "expand"])
def test_a_command_for_models_refuses_a_recording(
    command: str, square: str, capsys: Capture
) -> None:
    """It must not take the bundled robot in its place."""
    assert main([command, square]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert square in err
    assert "sambot-viz topics" in err


def test_two_parents_have_one_remedy(made: Path, capsys: Capture) -> None:
    assert main(["topics", str(made / "two_parents.mcap")]) == 0
    out, err = capsys.readouterr()
    assert "publish odom -> base_link" in err
    (row,) = (line for line in out.splitlines() if line.startswith("/odom "))
    assert "Publish odom -> base_link" in row
    assert "static_transform_publisher" not in row


def test_a_remedy_is_never_cut_off() -> None:
    words = "0 0 0 0 0 0 map " + "warehouse_robot_number_seven/" * 20
    reason = TopicReason("no-transform", f'add it: --static-transform "{words}"')
    assert words in topics_text([Account("/a", "", 1, None, True, reason)])


def test_json_has_the_nodes_of_a_topic_of_a_robot() -> None:
    offered = RosEndpoint(
        Kind.PUBLISHER, "/lidar", "/scan", "a/msg/B", "", Qos("best_effort")
    )
    ends = TopicEndpoints((offered,), ())
    topic = SourceTopic("/scan", Schema("a/msg/B"), "cdr", endpoints=ends)
    row = Account("/scan", "a/msg/B", 3, 10.0, True, None)
    lidar = {"node": "/lidar", "publishes": True, "qos": "Best Effort", "trouble": ""}
    assert topic_json(row, {"/scan": topic})["nodes"] == [lidar]
    assert topics_text([row], {"/scan": topic}).splitlines()[1:] == [
        "/scan  a/msg/B      3  10.0",
        "    publishes   /lidar (Best Effort)",
    ]
