"""Every topic of a recording says what it has, and why nothing of it is seen."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import yaml

from sambot_viz import limits
from sambot_viz.errors import Problem
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.topics import reasons
from sambot_viz.topics.account import Account
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.survey import Survey
from sambot_viz.topics.transforms import problems_of_transforms


@contextmanager
def surveyed(path: Path) -> Iterator[Survey]:
    with Inputs(Options(path)) as inputs:
        assert inputs.moved_by is not None
        survey = Survey(inputs.moved_by)
        survey.finish()
        yield survey


def statuses(path: Path, at: float | None = None) -> dict[str, Account]:
    with surveyed(path) as survey:
        start = survey.recorded.recording.start_ns or 0
        at_ns = None if at is None else start + round(at * 1e9)
        report = TopicReport(survey)
        report.at_ns = at_ns
        return {row.name: row for row in report.accounts()}


def problems(path: Path) -> tuple[Problem, ...]:
    with surveyed(path) as survey:
        name = survey.recorded.name
        own = survey.recorded.problems
        told = problems_of_transforms(survey.transforms, name)
        return tuple(dict.fromkeys((*own, *told)))


def expected(shared: Path) -> list[tuple[Path, dict[str, Any]]]:
    """What the recordings that were made for it are to say."""
    folder = shared / "data" / "bags" / "made"
    text = (folder / "index.yaml").read_text("utf-8")
    listed = yaml.load(text, yaml.CSafeLoader)
    said: list[tuple[Path, dict[str, Any]]] = []
    for name, about in listed.items():
        says = about.get("say", [])
        for say in says if isinstance(says, list) else [says]:
            said.append((folder / name, say))
    return said


def test_what_is_said_of_topics_is_the_expected_reason(shared: Path) -> None:
    asked = 0
    for path, say in expected(shared):
        kind, _, name = say["about"].partition(" ")
        if kind != "topic" or "protobuf" in say["words"]:
            # Protobuf is read since the list was made.
            continue
        asked += 1
        reason = statuses(path)[name].reason
        assert reason is not None, (path.name, say)
        assert reason.code == say["reason"], (path.name, reason)
        sentence = f"{name}: {reason.text}"
        assert all(word in sentence for word in say["words"]), sentence
        assert not sentence.endswith(".")
    assert asked >= 10


def test_what_is_said_of_frames_and_times_is_the_expected_problem(shared: Path) -> None:
    asked = 0
    for path, say in expected(shared):
        if say["about"] not in ("TF", "time", "RobotModel"):
            continue
        asked += 1
        found = [p for p in problems(path) if p.code == say["reason"]]
        assert len(found) == 1, (path.name, say)
        assert all(word in str(found[0]) for word in say["words"]), found[0]
        assert found[0].hint
    assert asked == 3


def test_whoever_moves_a_frame_of_the_model_is_told_what_to_publish(
    shared: Path,
) -> None:
    found = problems(shared / "data" / "bags" / "made" / "two_parents.mcap")
    assert "publish odom -> base_link" in found[0].hint


def test_topics_that_are_drawn_have_no_reason(repository: Path) -> None:
    rows = statuses(repository / "assets" / "square.mcap")
    drawn = {name for name, row in rows.items() if row.reason is None}
    robot = {"/robot_description", "/tf", "/tf_static", "/joint_states"}
    assert drawn == {*robot, "/scan", "/odom"}
    assert rows["/tf"].count == 1000
    assert rows["/tf"].rate == pytest.approx(50, rel=0.01)
    assert rows["/robot_description"].rate is None
    assert rows["/tf_static"].rate is None


def test_of_a_topic_only_the_first_messages_are_decoded(repository: Path) -> None:
    with surveyed(repository / "assets" / "square.mcap") as survey:
        assert survey.of("/scan").seen == 100
        assert survey.of("/scan").decoded == limits.SURVEYED_DECODED.value


def test_a_topic_that_fell_silent_is_stale_on_the_recordings_clock(
    write_recording: Callable[..., Path],
) -> None:
    path = write_recording(
        [(second / 10, {"odom": "base_link"}) for second in range(10)]
        + [(30.0, {"odom": "base_link"})]
    )
    reason = statuses(path, at=20.0)["/tf"].reason
    assert reason is not None
    assert reason.code == "stale"
    assert statuses(path, at=1.0)["/tf"].reason is None


def test_before_its_first_message_a_topic_says_when_it_begins(
    shared: Path, repository: Path
) -> None:
    path = shared / "data" / "bags" / "made" / "description_late.mcap"
    assert statuses(path, at=4.0)["/robot_description"].reason is None
    before = statuses(path, at=1.0)["/robot_description"].reason
    assert before is not None
    assert before.code == "not-here-yet"


def test_each_reason_is_one_of_those_that_are_documented() -> None:
    made = [
        reasons.no_such_topic("/scna", ["/scan", "/tf"]),
        reasons.wrong_type("sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry"),
        reasons.off("TF"),
        reasons.empty("0 points"),
        reasons.not_drawn("It has no fields"),
        reasons.lagging(12, "the network"),
    ]
    assert {reason.code for reason in made} <= set(reasons.SEVERITIES)
    assert "did you mean '/scan'?" in made[0].text
    assert all(reason.text for reason in made)


def test_frames_of_robots_with_name_spaces_are_judged_by_their_names(
    shared: Path,
) -> None:
    recordings = shared / "data" / "reported" / "recordings"
    with surveyed(recordings / "two_robots_ns.mcap") as survey:
        assert survey.fixed_frame == "map"
        assert survey.lookup_fault("a/base_link") is None
        assert survey.lookup_fault("b/base_link") is None
