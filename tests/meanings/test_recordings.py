"""Recordings of foxglove-sdk and others are shown as ROS's of the same meaning."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from inside import session_of

from sambot_viz import Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.survey import Survey

RECORDINGS = Path(__file__).parent / "recordings"


def reasons_of(name: str) -> dict[str, str]:
    """What is said of each topic: the code of the reason, "" for nothing."""
    with Inputs(Options(RECORDINGS / name)) as inputs:
        assert inputs.recorded is not None
        survey = Survey(inputs.recorded)
        survey.finish()
        rows = TopicReport(survey).statuses()
        return {row.name: row.reason.code if row.reason else "" for row in rows}


def test_nothing_is_said_of_topics_of_the_sdk_that_are_drawn() -> None:
    said = reasons_of("foxglove_protobuf.mcap")
    drawn = ("/tf", "/lidar", "/scan", "/cam", "/path", "/goal")
    assert {name: said[name] for name in drawn} == dict.fromkeys(drawn, "")
    # They are read, and have no display yet.
    assert {said[name] for name in ("/log", "/gps")} == {"no-display"}


def test_nothing_is_said_of_the_same_in_json() -> None:
    said = reasons_of("foxglove_json.mcap")
    assert (said["/tf"], said["/scan"]) == ("", "")


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


def test_displays_draw_what_the_sdk_has_recorded(tmp_path: Path) -> None:
    config = config_of(
        scan="LaserScan", lidar="PointCloud2", path="PoseArray", goal="Pose"
    )
    with shown(tmp_path, "foxglove_protobuf.mcap", config) as viz:
        T = viz.frames.lookup("map", "base_link")
        assert T.translation == pytest.approx([1.9, 0, 0])
        for name, rows in statuses(viz).items():
            assert rows["Topic"][1].endswith("hz."), (name, rows)
            assert rows["Transform"] == ("Ok", "Transform OK"), name
