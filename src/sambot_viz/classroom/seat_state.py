"""A student's state, as the board shows it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.progress import Progress


@dataclass(frozen=True, slots=True)
class SeatState:
    """A student's progress and current problems.

    Attributes:
        step: number of the next step, from 1; one more than the number of steps when
            all conditions hold.
        title: heading of the step.
        tries: number of failed attempts.
        points: points so far.
        errors: number of problems of severity error.
        warnings: number of problems of severity warning.
        unmet: number of conditions of the shown step that do not hold.
        first: the first of them, in words.
        pages: number of pages that the student has open.
        changed: time of the student's last change of a text [s since 1970]; 0 for none.
        since: time of the last completed step, or of arrival [s since 1970].
        trouble: reason why the student's work cannot be saved; "" when it can.
    """

    step: int
    title: str
    tries: int
    points: float
    errors: int = 0
    warnings: int = 0
    unmet: int = 0
    first: str = ""
    pages: int = 0
    changed: float = 0.0
    since: float = 0.0
    trouble: str = ""

    @classmethod
    def of(cls, lesson: Lesson, progress: Progress, **more: Any) -> SeatState:
        """Return the state of a student with this progress."""
        step = progress.current(lesson)
        passed = [one for one in lesson.steps if progress.of(one.name).passed]
        return cls(
            len(lesson.steps) + 1 if step is None else lesson.steps.index(step) + 1,
            "all steps hold" if step is None else step.title,
            0 if step is None else progress.of(step.name).tries,
            sum(one.points for one in passed),
            **more,
        )

    @classmethod
    def on_disk(cls, lesson: Lesson, folder: Path) -> SeatState:
        """Return the state of a student who has not opened a page since the start."""
        progress = Progress(folder, lesson.name)
        kept = progress.file if progress.file.is_file() else folder
        return cls.of(lesson, progress, since=kept.stat().st_mtime)

    @classmethod
    def read(cls, row: dict[str, Any]) -> SeatState:
        """Return the state that `as_json` has written."""
        return cls(**{each.name: row[each.name] for each in fields(cls)})

    def as_json(self) -> dict[str, Any]:
        """Return the fields."""
        return asdict(self)

    @property
    def stuck(self) -> bool:
        """Return whether the student's text has a mistake, or an attempt has failed."""
        return self.tries > 0 or (self.errors > 0 and self.changed > 0)
