"""One student's way through a lesson."""

from __future__ import annotations

from pathlib import Path

import pytest
from lesson_files import BASE, DATA

from sambot_viz.errors import UsageError
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.lessons.study import Study

LESSON = open_lesson(BASE)
RIGHT = (
    '<robot name="sam_bot"><link name="base_link"><visual><geometry>'
    '<box size="0.42 0.31 0.18"/></geometry></visual></link></robot>'
)


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return Study(LESSON, tmp_path)


def test_tries_bring_hints_and_a_step_that_holds_the_next_one(
    study: Study, tmp_path: Path
) -> None:
    step = study.step
    assert (step.name, study.hints_of(step)) == ("body", [])
    for _ in range(3):
        assert not study.attempt(step, study.work_of(step)).passed
    assert [blocks[0].kind for blocks in study.hints_of(step)] == ["paragraph"] * 2

    (tmp_path / "robot.urdf").write_text(RIGHT)
    assert study.look(step, study.work_of(step)) == []
    assert study.step is step, "looking counts nothing"
    assert study.attempt(step, study.work_of(step)).passed
    assert study.step.name == "wheel"
    assert Study(LESSON, tmp_path).step.name == "wheel", "it is kept in the folder"


def test_what_is_hidden_is_said_with_the_last_hint(
    study: Study, tmp_path: Path
) -> None:
    model = next((DATA / "nav2-first-robot").rglob("*.urdf"))
    text = model.read_text("utf-8").replace("-0.12 ", "-0.13 ")
    (tmp_path / "robot.urdf").write_text(text)
    step = LESSON.step("wheel")
    work = study.work_of(step)
    messages = [study.attempt(step, work).message for _ in range(3)]
    assert "at -0.12 0.18 -0.05" not in messages[1]
    assert "expected: at -0.12 0.18 -0.05" in messages[2]


def test_files_to_begin_with_are_copied_once(tmp_path: Path) -> None:
    study = Study(open_lesson("find-the-mistake"), tmp_path)
    assert len(study.begin()) > 10
    (tmp_path / "robot_01.urdf.xacro").write_text("mine")
    assert study.begin() == []
    assert (tmp_path / "robot_01.urdf.xacro").read_text() == "mine"


def test_the_text_of_a_track_follows_that_of_the_step(tmp_path: Path) -> None:
    lesson = open_lesson("nav2-first-robot")
    step = lesson.step("imu")
    texts = {
        track: Study(lesson, tmp_path, track).text_of(step)[-1].lines[0][0].text
        for track in ("urdf", "sdf")
    }
    assert texts["urdf"].startswith("In URDF") and texts["sdf"].startswith("In SDF")
    with pytest.raises(UsageError, match="did you mean 'sdf'"):
        Study(lesson, tmp_path, "sdff")
