"""Recordings of foxglove-sdk and others are shown as ROS's of the same meaning."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from inside import session_of

from sambot_viz import Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.meanings.foxglove import FOXGLOVE
from sambot_viz.options import Options
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.survey import Survey

RECORDINGS = Path(__file__).parent / "recordings"


def reasons_of(name: str) -> dict[str, TopicReason | None]:
    """What is said of each topic."""
    with Inputs(Options(RECORDINGS / name)) as inputs:
        assert inputs.moved_by is not None
        survey = Survey(inputs.moved_by)
        survey.finish()
        rows = TopicReport(survey).accounts()
        return {row.name: row.reason for row in rows}


@pytest.mark.parametrize(
    ("name", "unseen"),
    [
        # They are read, and have no display yet.
        ("foxglove_protobuf.mcap", {"/log", "/gps"}),
        ("foxglove_json.mcap", {"/log", "/gps"}),
        ("flatbuffer.mcap", set[str]()),
    ],
)
def test_nothing_is_said_of_topics_that_are_drawn(name: str, unseen: set[str]) -> None:
    said = {topic: one for topic, one in reasons_of(name).items() if one is not None}
    assert said.keys() == unseen
    assert {one.code for one in said.values()} <= {"no-display"}


def config_of(**topics: str) -> str:
    """A config with a display for each topic, by the class of the display."""
    displays = [
        f"    - {{Class: rviz_default_plugins/{kind}, Name: {name}, Enabled: true, "
        f"Topic: {{Value: /{name}}}}}"
        for name, kind in topics.items()
    ]
    lines = ["Visualization Manager:", "  Displays:", *displays]
    return "\n".join([*lines, "  Global Options: {Fixed Frame: map}", ""])


@contextmanager
def shown(tmp_path: Path, name: str, config: str) -> Iterator[Visualizer]:
    path = tmp_path / "config.rviz"
    path.write_text(config)
    source = f"bag:{RECORDINGS / name}"
    with Visualizer(config=path, source=source, port=0) as viz:
        viz.player.jump(viz.player.duration)
        yield viz


def statuses(viz: Visualizer) -> dict[str, dict[str, tuple[str, str]]]:
    displays: Any = session_of(viz).scene.displays
    return {
        one.config.name: {k: (r.level, r.text) for k, r in one.status.rows.items()}
        for one in displays
    }


@pytest.mark.parametrize(
    ("name", "x"), [("foxglove_protobuf.mcap", 1.9), ("flatbuffer.mcap", 1.0)]
)
def test_displays_draw_what_others_have_recorded(
    tmp_path: Path, name: str, x: float
) -> None:
    config = config_of(
        scan="LaserScan", lidar="PointCloud2", goal="Pose", scene="MarkerArray"
    )
    with shown(tmp_path, name, config) as viz:
        assert viz.frames.lookup("map", "base_link").translation == pytest.approx(
            [x, 0, 0]
        )
        for display, rows in statuses(viz).items():
            assert rows["Topic"][1].endswith("hz."), (display, rows)
            wrong = {key for key, (level, _) in rows.items() if level != "Ok"}
            assert not wrong, (display, rows)


def test_a_pose_is_drawn_in_every_encoding(tmp_path: Path) -> None:
    config = (RECORDINGS / "enc.rviz").read_text()
    with shown(tmp_path, "encodings.mcap", config) as viz:
        displays: Any = session_of(viz).scene.displays
        poses = {one.config.name: one.kept for one in displays}
    names = ("msg_cdr", "msg_cdr_be", "omgidl", "ros2idl", "json_ros", "json_nosch")
    assert {name for name, kept in poses.items() if not kept} == set()
    assert set(names) <= poses.keys()


def test_what_cannot_be_read_is_named_with_its_encoding() -> None:
    said = {
        name: f"{reason.code}: {reason.text}"
        for name, reason in reasons_of("encodings.mcap").items()
        if reason is not None
    }
    assert said.keys() == {"/flat", "/msgpack", "/cdr2"}
    assert said["/flat"].startswith("encoding: its flatbuffer schema does not describe")
    assert "it has no field of geometry_msgs/msg/PoseStamped" in said["/msgpack"]
    assert "XCDR2; have its writer use XCDR1" in said["/cdr2"]


def test_the_guide_lists_the_schemas(repository: Path) -> None:
    guide = (repository / "docs" / "guide.md").read_text("utf-8")
    listed = re.findall(r"^\| `(foxglove\.\w+)` \| `([\w/]+)` \| (\w+)", guide, re.M)
    rows = {(name, row.meaning.value) for name, row in FOXGLOVE.items()}
    assert {(name, look) for name, look, _ in listed} == rows
    for name, _, display in listed:
        usual = FOXGLOVE[name].meaning.display
        assert display == ("nothing" if usual is None else usual.rpartition("/")[2])
