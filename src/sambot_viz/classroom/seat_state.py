"""A student's state, as the board shows it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, cast

from sambot_viz import limits
from sambot_viz.files import read_limited, write_atomically
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.progress import Progress
from sambot_viz.text import json_text, text

STATE_FILE = ".sambot-state.json"
"""A page on another machine reports the state of its student in this file, in the
student's folder."""
_FIRST = 200
"""Length of a sentence of a report [characters]."""
_ENDLESS = 1e11
"""Above any count and any time; NaN is not below it either."""
_REPORTED: Mapping[str, type] = {
    "errors": int,
    "warnings": int,
    "unmet": int,
    "first": str,
    "pages": int,
    "changed": float,
    "since": float,
    "trouble": str,
}
"""Fields that the progress does not have, and their types."""


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
        server: reason why no page answers, such as "no server"; "" when one can.
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
    server: str = ""

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
        """Return the state that the files in a student's folder tell.

        Raises:
            OSError: the folder does not exist.
        """
        progress = Progress(folder, lesson.name)
        kept = progress.file if progress.file.is_file() else folder
        since = {"since": kept.stat().st_mtime}
        return cls.of(lesson, progress, **{**since, **_reported(folder / STATE_FILE)})

    def report(self, folder: Path) -> None:
        """Write the state into the student's folder.

        Raises:
            OSError: the file cannot be written.
        """
        content = f"{json_text(self.as_json())}\n"
        write_atomically(folder / STATE_FILE, content.encode())

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


def _reported(file: Path) -> dict[str, Any]:
    """Return the valid fields of a report; a student may write anything into it."""
    try:
        read: Any = json.loads(read_limited(file, limits.LESSON.value))
    except (OSError, ValueError, RecursionError):
        return {}
    rows = cast("dict[str, Any]", read) if isinstance(read, dict) else {}
    found: dict[str, Any] = {}
    for name, kind in _REPORTED.items():
        value = rows.get(name)
        if kind is str:
            if isinstance(value, str):
                found[name] = text(value, _FIRST)
        elif value is not None and type(value) in (int, kind):
            if 0 <= value < _ENDLESS:
                found[name] = kind(value)
    return found
