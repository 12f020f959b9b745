"""What the board shows of a student."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.progress import Progress


@dataclass(frozen=True, slots=True)
class SeatState:
    """How far a student is, and what is wrong there now.

    Attributes:
        step: the number of the step that comes next, from 1; all have held when it is
            one more than there are.
        title: its heading.
        tries: how often it has failed.
        points: what is earned so far.
        errors: how many problems of severity error there are.
        warnings: how many of severity warning.
        unmet: how much of the step that is shown does not hold.
        first: the first of them, in words.
        pages: how many pages the student has open.
        changed: when the student last changed a text [s since 1970]; 0 for never.
        since: when a step has held last, or the student has come [s since 1970].
        trouble: why something of the student cannot be kept; "" when all is.
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
        """Return the state of a student who has no page yet since the program began."""
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
        """Whether something that the student has written is wrong, or has failed."""
        return self.tries > 0 or (self.errors > 0 and self.changed > 0)
