"""How far a student is, in a small file in the student's folder."""

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
"""In the student's folder; it has a part for each lesson."""


@dataclass(frozen=True, slots=True)
class StepProgress:
    """What became of a step.

    Attributes:
        tries: how often it has failed.
        passed: whether it has held once.
        shown: whether it is the one that the student has read last.
    """

    tries: int = 0
    passed: bool = False
    shown: bool = False


class Progress:
    """How far a student is in a lesson.

    Args:
        folder: the student's folder.
        lesson: the name of the lesson.

    Attributes:
        file: keeps it.

    A file that is damaged counts as none: the student begins again with no tries.
    """

    def __init__(self, folder: Path, lesson: str) -> None:
        self.file = folder / PROGRESS_FILE
        self._lesson = lesson
        self._steps = dict(_steps(_read(self.file).get(lesson)))

    def of(self, step: str) -> StepProgress:
        """Return what became of a step."""
        return self._steps.get(step, StepProgress())

    def note(self, result: StepResult) -> None:
        """Count a try; a step that has held once stays passed."""
        before = self.of(result.name)
        failed = not result.passed and not before.passed
        self._steps[result.name] = replace(
            before,
            tries=before.tries + failed,
            passed=before.passed or result.passed,
        )

    def show(self, step: str) -> None:
        """Note which step the student reads."""
        for name in {step, *self._steps}:
            self._steps[name] = replace(self.of(name), shown=name == step)

    def current(self, lesson: Lesson) -> LessonStep | None:
        """Return the first step that has not held; None when all have.

        It is looked for from the step on that was read last: who leaves out a step
        goes on behind it.
        """
        steps = lesson.steps
        read = (n for n, step in enumerate(steps) if self.of(step.name).shown)
        first = next(read, 0)
        behind = (*steps[first:], *steps[:first])
        return next((s for s in behind if not self.of(s.name).passed), None)

    def save(self) -> None:
        """Write the file; parts of other lessons stay.

        Raises:
            OSError: it cannot be written.
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
    """Return what a file says of steps, as far as it is of the right kind."""
    found: list[tuple[str, StepProgress]] = []
    known = cast("dict[str, Any]", rows) if isinstance(rows, dict) else {}
    for name, row in known.items():
        given = cast("dict[str, Any]", row) if isinstance(row, dict) else {}
        tries, passed = given.get("tries"), given.get("passed")
        if type(tries) is int and type(passed) is bool and tries >= 0:
            is_shown = given.get("shown") is True
            found.append((name, StepProgress(tries, passed, is_shown)))
    return found
