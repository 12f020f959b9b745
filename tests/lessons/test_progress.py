"""How far a student is stays in the student's folder."""

from __future__ import annotations

from pathlib import Path

import pytest
from lesson_files import BASE

from sambot_viz.lessons.evaluation import StepResult
from sambot_viz.lessons.progress import PROGRESS_FILE, Progress, StepProgress
from sambot_viz.lessons.read_lesson import read_lesson

LESSON = read_lesson(BASE / "lesson.yaml")


def result(step: str, message: str = "") -> StepResult:
    return StepResult.of(LESSON, LESSON.step(step), message)


def test_tries_are_counted_until_a_step_holds(tmp_path: Path) -> None:
    progress = Progress(tmp_path, "base")
    for message in ("wrong", "wrong", "", "wrong"):
        progress.note(result("body", message))
    progress.save()

    again = Progress(tmp_path, "base")
    assert again.of("body") == StepProgress(tries=2, passed=True)
    assert again.of("wheel") == StepProgress()
    assert again.current(LESSON) is LESSON.step("wheel")


def test_a_student_who_leaves_a_step_out_goes_on_behind_it(tmp_path: Path) -> None:
    progress = Progress(tmp_path, "base")
    progress.show("body")
    progress.show("wheel")
    progress.save()

    again = Progress(tmp_path, "base")
    assert again.current(LESSON) is LESSON.step("wheel")
    again.note(result("wheel"))
    assert again.current(LESSON) is LESSON.step("body")


def test_a_student_who_has_all_steps_has_no_current_one(tmp_path: Path) -> None:
    progress = Progress(tmp_path, "base")
    for step in LESSON.steps:
        progress.note(result(step.name))
    assert progress.current(LESSON) is None


def test_two_lessons_in_one_folder_keep_their_progress(tmp_path: Path) -> None:
    for name in ("one", "two"):
        progress = Progress(tmp_path, name)
        progress.note(result("body"))
        progress.save()
    assert Progress(tmp_path, "one").of("body").passed


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        '{"base": 1}',
        '{"base": {"body": {"tries": "2", "passed": true}}}',
        '{"base": {"body": {"tries": -1, "passed": true}}}',
        '{"base": {"body": {"tries": true, "passed": true}}}',
        "[" * 100_000,
    ],
)
def test_a_damaged_file_counts_as_none(tmp_path: Path, text: str) -> None:
    (tmp_path / PROGRESS_FILE).write_text(text)
    progress = Progress(tmp_path, "base")
    assert progress.of("body") == StepProgress()
    progress.note(result("body"))
    progress.save()
    assert Progress(tmp_path, "base").of("body").passed


def test_hints_and_what_is_hidden_come_with_tries(tmp_path: Path) -> None:
    step = LESSON.step("body")
    shown = [len(step.shown_hints("", tries)) for tries in range(5)]
    assert shown == [0, 1, 1, 2, 2]
    assert [step.is_exhausted("", tries) for tries in (2, 3)] == [False, True]
