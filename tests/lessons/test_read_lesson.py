"""A lesson.yaml is read strictly: line, cause and fix for what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest
from lesson_files import BASE
from lower_limit import lower

from sambot_viz.errors import LessonError, UsageError
from sambot_viz.lessons.read_lesson import lesson_names, open_lesson, read_lesson

GOOD = """\
name: l
title: L
model: robot.urdf
steps:
  - name: one
    title: One
    text: Do it.
    conditions:
      - joint: {name: j, type: fixed, xyz: [0, 0, 1]}
        hidden: true
    hints:
      - {after: 2, text: Think.}
"""

WRONG = [
    ("name: l", "nmae: l", "lesson-key", 1, "a lesson has no key 'nmae'", "'name'?"),
    ("title: L\n", "", "lesson-key", 1, "a lesson has no 'title'", "add title:"),
    ("joint:", "jiont:", "lesson-key", 9, "has no kind 'jiont'", "'joint'?"),
    ("xyz:", "xzy:", "lesson-key", 9, "the condition joint has no key", "'xyz'?"),
    ("name: j, ", "", "lesson-key", 9, "joint has no 'name'", "add name:"),
    ("fixed", "fxed", "lesson-value", 9, "'fxed' is not a word", "'fixed'?"),
    ("[0, 0, 1]", "[0, 0]", "lesson-value", 9, "'xyz' is [0, 0]", "3 numbers"),
    ("[0, 0, 1]", "1", "lesson-value", 9, "'xyz' is '1'", "3 numbers"),
    ("[0, 0, 1]", "[0, 0, .inf]", "lesson-value", 9, "'xyz' is", "3 numbers"),
    ("after: 2", "after: two", "lesson-value", 12, "'after' is 'two'", "whole number"),
    ("after: 2", "after: -1", "lesson-value", 12, "'after' is '-1'", "from 0 on"),
    ("true", "perhaps", "lesson-value", 10, "'hidden' is not a flag", "write true"),
    ("title: One", "title:", "lesson-value", 6, "'title' is empty", "a text"),
    ("title: One", "title: a\n    title: b", "lesson-value", 7, "twice", "delete one"),
    ("Do it.", "Do <b>it</b>.", "lesson-text", 7, "has <b>", "`<b>`"),
    ("Do it.", "'![a](a.png)'", "lesson-text", 7, "no picture a.png", "beside"),
    ("Do it.", "'![a](../a.png)'", "lesson-text", 7, "cannot be shown", "folder"),
    ("Do it.", "'[a](javascript:x)'", "lesson-text", 7, "leads nowhere", "https://"),
    (
        "    hints:\n      - {after: 2, text: Think.}\n",
        "",
        "lesson-value",
        None,
        "no hint",
        "hints:",
    ),
    ("model: robot.urdf\n", "", "lesson-value", None, "no model file", "add model:"),
    (
        "text: Do it.",
        "text: Do it.\n    points: 0",
        "lesson-value",
        None,
        "no points",
        "points: 1",
    ),
    (
        "hidden: true",
        "hidden: true\n        only: sdf",
        "lesson-value",
        None,
        "'sdf'",
        "",
    ),
    ("title: L", "title L", "lesson-unreadable", 2, "no colon", "write title: L"),
    ("steps:", "steps: [", "lesson-unreadable", None, "", ""),
]
"""What is replaced in the lesson, by what; code, line, words of message and hint."""


def write(folder: Path, text: str) -> Path:
    file = folder / "lesson.yaml"
    file.write_text(text)
    return file


def test_a_right_lesson_is_read(tmp_path: Path) -> None:
    lesson = read_lesson(write(tmp_path, GOOD))
    (step,) = lesson.steps
    assert (lesson.name, step.name, step.points) == ("l", "one", 1.0)
    assert [hint.text for hint in step.shown_hints("", 2)] == ["Think."]
    assert step.shown_hints("", 1) == []


@pytest.mark.parametrize(("right", "wrong", "code", "line", "message", "hint"), WRONG)
def test_a_wrong_lesson_has_a_problem_with_place_cause_and_fix(
    tmp_path: Path,
    right: str,
    wrong: str,
    code: str,
    line: int | None,
    message: str,
    hint: str,
) -> None:
    assert right in GOOD
    with pytest.raises(LessonError) as raised:
        read_lesson(write(tmp_path, GOOD.replace(right, wrong)))
    problem = raised.value.problems[0]
    assert (problem.code, problem.severity) == (code, "error")
    assert line is None or problem.line == line
    assert message in problem.message and hint in problem.hint
    assert problem.file == str(tmp_path / "lesson.yaml")


def test_all_that_is_wrong_is_reported_at_once(tmp_path: Path) -> None:
    text = GOOD.replace("fixed", "fxed").replace("after: 2", "after: two")
    with pytest.raises(LessonError) as raised:
        read_lesson(write(tmp_path, text))
    assert [problem.line for problem in raised.value.problems] == [9, 12]


@pytest.mark.parametrize("text", ["", "- a\n- b\n", "a", "name: &a [*a]\n"])
def test_what_is_no_lesson_at_all_is_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(LessonError):
        read_lesson(write(tmp_path, text))


def test_a_lesson_is_opened_by_name_file_or_folder() -> None:
    assert open_lesson("nav2-first-robot").name == "nav2-first-robot"
    assert open_lesson(BASE).name == open_lesson(BASE / "lesson.yaml").name == "base"
    with pytest.raises(UsageError, match="did you mean 'nav2-first-robot'"):
        open_lesson("nav2-first-robt")


@pytest.mark.parametrize("name", lesson_names())
def test_a_lesson_that_ships_is_called_as_its_folder(name: str) -> None:
    assert open_lesson(name).name == name


def test_a_lesson_that_is_too_large_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = write(tmp_path, GOOD)
    lower(monkeypatch, "LESSON", len(GOOD) - 1)
    with pytest.raises(LessonError) as refused:
        read_lesson(file)
    assert [p.code for p in refused.value.problems] == ["lesson-unreadable"]
