"""The teacher's board: a row for each student, stuck students first."""

from __future__ import annotations

import asyncio
import csv
import io
import json
import time
import zipfile
from collections.abc import Callable, Iterator
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Protocol

from sambot_viz.classroom.roll import Student
from sambot_viz.classroom.seat_state import SeatState
from sambot_viz.lessons.grading import grade
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.progress import Progress
from sambot_viz.lessons.study import Study
from sambot_viz.lessons.writers import WRITERS

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""First characters that make a spreadsheet read a cell as a formula."""
_HEAD = 0
"""Number of a change that belongs to no student."""
COLUMNS = (
    "name",
    "folder",
    "step",
    "title",
    "points",
    "tries",
    "errors",
    "warnings",
    "does not hold",
    "last change",
    "last progress",
    "open pages",
)


class ClassList(Protocol):
    """The students of a class, and the folder that has their folders."""

    folder: Path
    students: dict[int, Student]


class Board:
    """The progress of all students, and the pages that follow it.

    Args:
        lesson: the lesson.
        roll: the students of the class.
        track: track of the lesson; None for the one that the files follow.

    Attributes:
        title: title of the lesson.
        shown: number of the student whose page is shown to the class; 0 for none.
        trouble: reason why rows may be old; "" when they are new.
    """

    def __init__(
        self, lesson: Lesson, roll: ClassList, track: str | None = None
    ) -> None:
        self._lesson, self._roll, self._track = lesson, roll, track
        self._states: dict[int, SeatState] = {}
        self._followers: set[BoardFollower] = set()
        self.title, self.shown, self.trouble = lesson.title, 0, ""
        for student in roll.students.values():
            self.look_up(student)

    def look_up(self, student: Student) -> None:
        """Read a student's progress from the student's folder."""
        folder = self._roll.folder / student.folder
        try:
            state = SeatState.on_disk(self._lesson, folder)
        except OSError:
            # A teacher has removed the folder.
            state = SeatState.of(self._lesson, Progress(folder, self._lesson.name))
        self.take(student.number, state)

    def take(self, number: int, state: SeatState) -> None:
        """Take a student's state, and notify the followers if it is new."""
        if number in self._roll.students and self._states.get(number) != state:
            self._states[number] = state
            self._tell(number)

    def show(self, number: int) -> None:
        """Record whose page is shown to the class; 0 for none."""
        before, self.shown = self.shown, number
        for changed in {before, number} - {0}:
            self._tell(changed)

    def say_trouble(self, trouble: str) -> None:
        """Show why rows may be old; "" when they are new."""
        if trouble != self.trouble:
            self.trouble = trouble
            self._tell(_HEAD)

    def has(self, number: int) -> bool:
        """Return whether a student is in the class."""
        return number in self._roll.students

    @property
    def is_followed(self) -> bool:
        """Whether a page shows the board."""
        return bool(self._followers)

    def _tell(self, number: int) -> None:
        for follower in self._followers:
            follower.note(number)

    def row(self, number: int) -> dict[str, Any]:
        """Return a student's row for the page, with its place in the order."""
        student, state = self._roll.students[number], self._states[number]
        return {
            "number": number,
            "name": student.name,
            "shown": number == self.shown,
            "order": self._place(number),
            "stuck": state.stuck,
            **state.as_json(),
        }

    def change(self, number: int) -> dict[str, Any]:
        """Return a change for the page: a student's row, or the trouble with 0."""
        if number == _HEAD:
            return {"trouble": self.trouble}
        return {"row": self.row(number)}

    def _place(self, number: int) -> list[float]:
        """Return the sort key of a row: the student stuck for longest comes first."""
        state = self._states[number]
        done = state.step > len(self._lesson.steps)
        return [done, not state.stuck, state.since, number]

    def begin(self) -> dict[str, Any]:
        """Return the first state that a board receives."""
        return {
            "lesson": self._lesson.title,
            "steps": len(self._lesson.steps),
            "points": sum(step.points for step in self._lesson.steps),
            "folder": str(self._roll.folder),
            "trouble": self.trouble,
            "now": time.time(),
            "rows": [self.row(number) for number in self._states],
        }

    def follow(self) -> BoardFollower:
        """Return a follower of all changes from now on; close it at the end."""
        follower = BoardFollower(self._followers.discard)
        self._followers.add(follower)
        return follower

    # Files to take home

    def csv(self) -> bytes:
        """Return the state of all students as CSV, stuck students first."""
        out = io.StringIO()
        writer = csv.writer(out)
        writer.writerow(COLUMNS)
        for number in sorted(self._states, key=self._place):
            writer.writerow(_plain(cell) for cell in self._cells(number))
        # Without the byte order mark, Excel assumes another encoding.
        return f"\ufeff{out.getvalue()}".encode()

    def _cells(self, number: int) -> Iterator[object]:
        student, state = self._roll.students[number], self._states[number]
        yield from (student.name, student.folder, state.step, state.title)
        yield from (f"{state.points:g}", state.tries, state.errors, state.warnings)
        yield from (state.first, _time(state.changed), _time(state.since))
        yield state.server or state.pages

    def collect(self, into: Path) -> None:
        """Write a zip with the files, the progress and the grade of each student.

        It takes a second or more for each student: call it in a thread.
        """
        with zipfile.ZipFile(into, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("class.csv", self.csv())
            for student in [*self._roll.students.values()]:
                folder = self._roll.folder / student.folder
                if not folder.is_dir():
                    continue
                study = Study(self._lesson, folder, self._track, trusted=False)
                for file in (*study.files(), study.progress.file):
                    if file.is_file() and not file.is_symlink():
                        inner = file.relative_to(folder.absolute()).as_posix()
                        archive.write(file, f"{student.folder}/{inner}")
                found = WRITERS["json"](grade(folder, self._lesson.file))
                archive.writestr(f"{student.folder}/grade.json", found)


class BoardFollower:
    """The rows that have changed since the last question.

    Each row is stored once, however often it changes, so a slow page costs no memory.

    Args:
        leave: called with this follower at the end.
    """

    def __init__(self, leave: Callable[[BoardFollower], object]) -> None:
        self._numbers: dict[int, None] = {}
        self._changed = asyncio.Event()
        self._leave = leave

    def note(self, number: int) -> None:
        """Record that a row has changed; call it on the event loop."""
        self._numbers[number] = None
        self._changed.set()

    async def changed(self, timeout: float) -> list[int]:
        """Return the numbers of changed rows; empty after the timeout [s]."""
        try:
            await asyncio.wait_for(self._changed.wait(), timeout)
        except asyncio.TimeoutError:
            return []
        self._changed.clear()
        numbers, self._numbers = self._numbers, {}
        return [*numbers]

    def close(self) -> None:
        """Stop following."""
        self._leave(self)


def event(value: Any) -> bytes:
    """Encode a value as a server-sent event."""
    return f"data: {json.dumps(value)}\n\n".encode()


def _plain(cell: object) -> object:
    """Return a cell that no spreadsheet evaluates as a formula."""
    is_formula = isinstance(cell, str) and cell.startswith(_FORMULA)
    return f"'{cell}" if is_formula else cell


def _time(seconds: float) -> str:
    if not seconds:
        return ""
    at = datetime.fromtimestamp(seconds, timezone.utc)
    return at.isoformat(timespec="seconds")
