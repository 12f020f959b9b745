"""The lesson of ten mistakes: each step fails at the start, and says no answer."""

from __future__ import annotations

from pathlib import Path

import pytest
from lesson_files import DATA

from sambot_viz import grade
from sambot_viz.lessons.evaluation import faults_of
from sambot_viz.lessons.lesson import LessonStep
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.lessons.student_files import handed_in
from sambot_viz.lessons.work import Work

LESSON = open_lesson("find-the-mistake")
START = LESSON.folder / LESSON.start
SAID = {
    "nothing-appears": "line 10 closes </robot> too early",
    "a-name": "wheel_radus is not defined",
    "two-trees": "the child link 'front_castor', which does not exist; ROS refuses",
    "crooked": "is along 0 -0.894 -0.44807",
    "a-wall": "a cylinder of radius 0.1 and length 40",
    "end-over-end": "the axis of drivewhl_l_joint is 1 0 0",
    "twice": "both make a link drivewhl_l_link",
    "at-the-origin": "the <visual> of front_caster is at -0.14 0 0.09 in the link",
    "not-installed": "the folder urdf is not installed",
    "silent": "nothing reads /demo/odom, but /odom",
}


@pytest.mark.parametrize("step", LESSON.steps, ids=lambda step: step.name)
def test_each_step_fails_at_the_start_and_passes_at_the_end(step: LessonStep) -> None:
    for folder, right in ((START, False), (DATA / "find-the-mistake", True)):
        given = handed_in(LESSON, folder)
        work = Work(given.model_of(step), given.folder_of(step), trusted=False)
        said = [fault.message for fault in faults_of(step, work)]
        assert (said == []) == right
        assert right or SAID[step.name] in said[0]


def test_one_of_the_files_is_graded_in_its_own_step() -> None:
    found = grade(START / "robot_06.urdf.xacro", "find-the-mistake")
    assert [step.name for step in found.steps] == ["end-over-end"]


def test_no_verdict_has_the_text_to_write(tmp_path: Path) -> None:
    messages = "\n".join(one.message for one in grade(START, "find-the-mistake").steps)
    for answer in ("did you mean", "pi/2", "wheel_radius", '<axis xyz="0 1 0"'):
        assert answer not in messages
