"""A student's progress, in a small file in the student's folder."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

from sambot_viz import limits
from sambot_viz.files import read_limited, write_atomically
from sambot_viz.lessons.evaluation import StepResult
from sambot_viz.lessons.lesson import Lesson, LessonStep
from sambot_viz.text import json_text

PROGRESS_FILE = ".sambot-lesson.json"
"""Name of the file in the student's folder; it has a part for each lesson."""


@dataclass(frozen=True, slots=True)
class StepProgress:
    """A student's progress in a step.

    Attributes:
        tries: number of failed tries.
        passed: whether the step has passed once.
        shown: whether the student has read this step last.
    """

    tries: int = 0
    passed: bool = False
    shown: bool = False


class Progress:
    """A student's progress in a lesson.

    Args:
        folder: the student's folder.
        lesson: name of the lesson.

    Attributes:
        file: file with the progress.

    A damaged file counts as missing: the student starts again with no tries.
    """

    def __init__(self, folder: Path, lesson: str) -> None:
        self.file = folder / PROGRESS_FILE
        self._lesson = lesson
        self._steps = dict(_steps(_read(self.file).get(lesson)))

    def of(self, step: str) -> StepProgress:
        """Return the progress in a step."""
        return self._steps.get(step, StepProgress())

    def note(self, result: StepResult) -> None:
        """Count a try; a step that has passed once stays passed."""
        before = self.of(result.name)
        failed = not result.passed and not before.passed
        self._steps[result.name] = replace(
            before,
            tries=before.tries + failed,
            passed=before.passed or result.passed,
        )

    def show(self, step: str) -> None:
        """Record which step the student reads."""
        for name in {step, *self._steps}:
            self._steps[name] = replace(self.of(name), shown=name == step)

    def current(self, lesson: Lesson) -> LessonStep | None:
        """Return the first step that has not passed; None when all have.

        The search starts at the step that the student has read last, so a student who
        skips a step continues after it.
        """
        steps = lesson.steps
        read = (n for n, step in enumerate(steps) if self.of(step.name).shown)
        first = next(read, 0)
        behind = (*steps[first:], *steps[:first])
        return next((s for s in behind if not self.of(s.name).passed), None)

    def save(self) -> None:
        """Write the file, and keep the parts of other lessons.

        Raises:
            OSError: the file cannot be written.
        """
        rows = {
            name: {"tries": step.tries, "passed": step.passed}
            | ({"shown": True} if step.shown else {})
            for name, step in self._steps.items()
        }
        document = {**_read(self.file), self._lesson: rows}
        write_atomically(self.file, f"{json_text(document)}\n".encode())


def _read(file: Path) -> dict[str, Any]:
    try:
        read: Any = json.loads(read_limited(file, limits.LESSON.value))
    except (OSError, ValueError, RecursionError):
        return {}
    return cast("dict[str, Any]", read) if isinstance(read, dict) else {}


def _steps(rows: Any) -> list[tuple[str, StepProgress]]:
    """Return the valid steps in the rows of a file."""
    found: list[tuple[str, StepProgress]] = []
    known = cast("dict[str, Any]", rows) if isinstance(rows, dict) else {}
    for name, row in known.items():
        given = cast("dict[str, Any]", row) if isinstance(row, dict) else {}
        tries, passed = given.get("tries"), given.get("passed")
        if type(tries) is int and type(passed) is bool and tries >= 0:
            is_shown = given.get("shown") is True
            found.append((name, StepProgress(tries, passed, is_shown)))
    return found
