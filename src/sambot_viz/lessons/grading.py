"""Grades a student's files, in a child process with limits."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sambot_viz import limits
from sambot_viz.lessons.evaluation import StepResult
from sambot_viz.lessons.lesson import Lesson, LessonStep
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.lessons.student_files import HandedIn, handed_in
from sambot_viz.robot.child_process import Child, ChildTimeoutError

_CHILD = Path(__file__).parent / "child" / "main.py"
_PACKAGE = Path(__file__).parents[2]


@dataclass(frozen=True, slots=True)
class Grade:
    """The grade of a student.

    Attributes:
        lesson: name of the lesson.
        steps: results of the steps.
        refusal: reason why no model could be read; empty if one could.
    """

    lesson: str
    steps: tuple[StepResult, ...]
    refusal: str = ""

    @property
    def passed(self) -> bool:
        """Return whether all steps pass."""
        return all(step.passed for step in self.steps)

    @property
    def score(self) -> float:
        """The sum of the earned points."""
        return sum(step.points for step in self.steps)

    @property
    def max_score(self) -> float:
        """The sum of the points that the steps can earn."""
        return sum(step.max_points for step in self.steps)

    def as_json(self) -> dict[str, object]:
        """Return the fields of the JSON output."""
        return {
            "lesson": self.lesson,
            "passed": self.passed,
            "score": self.score,
            "max_score": self.max_score,
            "steps": [step.as_json() for step in self.steps],
        }


def grade(
    path: str | os.PathLike[str],
    lesson: str | os.PathLike[str] = "nav2-first-robot",
    *,
    step: str | int | None = None,
) -> Grade:
    """Grade a model, or a folder with one.

    The files count as those of an unknown person: a child process with limits of time
    and memory reads them, and no files outside their folder.

    Args:
        path: model file, or folder with the student's files.
        lesson: name of a bundled lesson, a lesson.yaml, or the folder of one.
        step: the only step to grade, by its number from 1 or its name; None for all.

    Raises:
        UsageError: the file, the lesson or the step does not exist.
        LessonError: the lesson cannot be read.
    """
    opened = open_lesson(Path(lesson))
    steps = opened.steps if step is None else (opened.step(step),)
    given = handed_in(opened, Path(path))
    if given.is_file and step is None:
        # The student has handed in only one of several models.
        own = [one for one in steps if one.model == given.model.name]
        steps = tuple(own) or steps
    return Grade(opened.name, *_in_child(opened, steps, given))


def _in_child(
    lesson: Lesson, steps: Sequence[LessonStep], given: HandedIn
) -> tuple[tuple[StepResult, ...], str]:
    """Return a child process's results, and the reason why no model could be read."""
    seconds = limits.GRADE_TIME.value
    order = {
        "import_path": [str(_PACKAGE), *filter(None, sys.path)],
        "megabytes": limits.GRADE_MEMORY.value,
        "seconds": seconds,
        "lesson": str(lesson.file),
        "steps": [step.name for step in steps],
        "path": str(given.model if given.is_file else given.folder),
    }
    try:
        child = Child(_CHILD, OPENBLAS_NUM_THREADS="1")
        output, status = child.ask(json.dumps(order).encode(), seconds)
    except ChildTimeoutError:
        return _all_failed(lesson, steps, f"grading took longer than {seconds} s")
    try:
        answer: dict[str, Any] = json.loads(output)
    except ValueError:
        text = f"grading ended without a result (status {status})"
        return _all_failed(lesson, steps, text)
    if "failure" in answer:
        return _all_failed(lesson, steps, answer["failure"])
    found = zip(steps, answer["messages"], strict=True)
    done = tuple(StepResult.of(lesson, step, message) for step, message in found)
    return done, answer["refusal"]


def _all_failed(
    lesson: Lesson, steps: Sequence[LessonStep], message: str
) -> tuple[tuple[StepResult, ...], str]:
    return tuple(StepResult.of(lesson, step, message) for step in steps), message
