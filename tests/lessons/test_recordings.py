"""A recording in the student's folder shows what a robot has done."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest
from lesson_files import STATUS, goal_statuses, unmet
from made_recording import START, write_messages

from sambot_viz import bundled
from sambot_viz.lessons.work import Work

SQUARE = bundled.assets_folder() / "square.mcap"


@pytest.fixture
def square(tmp_path: Path) -> Work:
    shutil.copy(SQUARE, tmp_path)
    return Work(tmp_path / "robot.urdf", tmp_path, trusted=False)


@pytest.mark.parametrize(
    "condition",
    [
        "recorded: {topic: [/demo/odom, /odom], rate: 9.5}",
        "recorded: {topic: /odom, type: nav_msgs/msg/Odometry}",
        "moved: {from: odom, to: base_link}",
        "moved: {from: odom, to: drivewhl_l_link, distance: 1}",
        "moved: {from: base_link, to: base_link}",
    ],
)
def test_what_the_robot_has_done_holds(
    tmp_path: Path, square: Work, condition: str
) -> None:
    assert unmet(tmp_path, condition, square) == []


@pytest.mark.parametrize(
    ("condition", "found"),
    [
        ("recorded: {topic: /odm}", "the recording has no /odm, but /odom"),
        ("recorded: {topic: /odom, rate: 11}", "/odom comes 10 times a second"),
        ("recorded: {topic: /odom, type: a/msg/B}", "is nav_msgs/msg/Odometry"),
        ("moved: {from: map, to: base_link}", "no transform from map to base_link"),
        ("moved: {from: odom, to: base_link, distance: 9}", "m from where it begins"),
        ("moved: {from: base_link, to: odom}", "no transform from base_link to odom"),
        ("goal-reached: {action: navigate_to_pose}", "a goal was reached: none"),
    ],
)
def test_what_it_has_not_done_is_said(
    tmp_path: Path, square: Work, condition: str, found: str
) -> None:
    (said,) = unmet(tmp_path, condition, square)
    assert found in said.found


@pytest.mark.parametrize(("codes", "holds"), [([2, 4], True), ([6, 5], False)])
def test_a_goal_is_reached_when_its_status_says_so(
    tmp_path: Path, codes: Sequence[int], holds: bool
) -> None:
    topic = "/navigate_to_pose/_action/status"
    message = (topic, STATUS, START * 10**9, goal_statuses(codes))
    write_messages(tmp_path / "go.mcap", [message])
    work = Work(tmp_path / "robot.urdf", tmp_path, trusted=False)
    said = unmet(tmp_path, "goal-reached: {action: navigate_to_pose}", work)
    assert (said == []) == holds


@pytest.mark.parametrize("data", [None, b"", b"\x89MCAP0\r\n", b"x" * 100])
def test_a_recording_that_cannot_be_read_does_not_hold(
    tmp_path: Path, data: bytes | None
) -> None:
    if data is not None:
        (tmp_path / "run.mcap").write_bytes(data)
    work = Work(tmp_path / "robot.urdf", tmp_path, trusted=False)
    for condition in ("recorded: {topic: /odom}", "moved: {from: odom, to: base_link}"):
        (said,) = unmet(tmp_path, condition, work)
        assert said.found and said.expected


def test_a_recording_behind_a_link_out_of_the_folder_is_not_read(
    tmp_path: Path,
) -> None:
    (tmp_path / "run.mcap").symlink_to(SQUARE)
    work = Work(tmp_path / "robot.urdf", tmp_path, trusted=False)
    (said,) = unmet(tmp_path, "recorded: {topic: /odom}", work)
    assert "the folder has no recording" in said.found
