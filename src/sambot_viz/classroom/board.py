"""The teacher's board: a row for each student, those who are stuck first."""

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
from typing import Any

from sambot_viz.classroom.roll import Roll, Student
from sambot_viz.classroom.seat_state import SeatState
from sambot_viz.lessons.grading import grade
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.progress import Progress
from sambot_viz.lessons.study import Study
from sambot_viz.lessons.writers import WRITERS

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""A spreadsheet takes a cell that begins with one of these for a formula."""
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


class Board:
    """How far all students are, and who follows that.

    Args:
        lesson: what is learnt.
        roll: who is there.
        track: the way through the lesson; None for that of the files.

    Attributes:
        title: of the lesson.
        shown: the number of the student whose page is shown to all; 0 for none.
    """

    def __init__(self, lesson: Lesson, roll: Roll, track: str | None = None) -> None:
        self._lesson, self._roll, self._track = lesson, roll, track
        self._states: dict[int, SeatState] = {}
        self._followers: set[BoardFollower] = set()
        self.title, self.shown = lesson.title, 0
        for student in roll.students.values():
            self.look_up(student)

    def look_up(self, student: Student) -> None:
        """Take how far a student is from the student's folder."""
        folder = self._roll.folder / student.folder
        try:
            state = SeatState.on_disk(self._lesson, folder)
        except OSError:
            # A teacher has taken the folder away.
            state = SeatState.of(self._lesson, Progress(folder, self._lesson.name))
        self.take(student.number, state)

    def take(self, number: int, state: SeatState) -> None:
        """Take how far a student is, and tell it."""
        if number in self._roll.students:
            self._states[number] = state
            self._tell(number)

    def show(self, number: int) -> None:
        """Note which student's page is shown to all; 0 for none."""
        before, self.shown = self.shown, number
        for changed in {before, number} - {0}:
            self._tell(changed)

    def _tell(self, number: int) -> None:
        for follower in self._followers:
            follower.note(number)

    def row(self, number: int) -> dict[str, Any]:
        """Return what a page shows of a student, and its place in the order."""
        student, state = self._roll.students[number], self._states[number]
        return {
            "number": number,
            "name": student.name,
            "shown": number == self.shown,
            "order": self._place(number),
            "stuck": state.stuck,
            **state.as_json(),
        }

    def _place(self, number: int) -> list[float]:
        """Return what rows are sorted by: who is stuck for longest comes first."""
        state = self._states[number]
        done = state.step > len(self._lesson.steps)
        return [done, not state.stuck, state.since, number]

    def begin(self) -> dict[str, Any]:
        """Return all that a board begins with."""
        return {
            "lesson": self._lesson.title,
            "steps": len(self._lesson.steps),
            "points": sum(step.points for step in self._lesson.steps),
            "folder": str(self._roll.folder),
            "now": time.time(),
            "rows": [self.row(number) for number in self._states],
        }

    def follow(self) -> BoardFollower:
        """Return what tells each change from now on; close it at the end."""
        follower = BoardFollower(self._followers.discard)
        self._followers.add(follower)
        return follower

    # What is taken home

    def csv(self) -> bytes:
        """Return the state of all, those who are stuck first."""
        out = io.StringIO()
        writer = csv.writer(out)
        writer.writerow(COLUMNS)
        for number in sorted(self._states, key=self._place):
            writer.writerow(_plain(cell) for cell in self._cells(number))
        # Excel takes a file without the mark for one in another encoding.
        return f"\ufeff{out.getvalue()}".encode()

    def _cells(self, number: int) -> Iterator[object]:
        student, state = self._roll.students[number], self._states[number]
        yield from (student.name, student.folder, state.step, state.title)
        yield from (f"{state.points:g}", state.tries, state.errors, state.warnings)
        yield from (state.first, _time(state.changed), _time(state.since))
        yield state.pages

    def collect(self, into: Path) -> None:
        """Write a zip with the files, the progress and the grade of each student.

        It takes a second or more for each: call it in a thread.
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
    """The rows that have changed since they were last asked for.

    Each is kept once, however often it changes, so a page that reads slowly costs no
    memory.

    Args:
        leave: called with this at the end.
    """

    def __init__(self, leave: Callable[[BoardFollower], object]) -> None:
        self._numbers: dict[int, None] = {}
        self._changed = asyncio.Event()
        self._leave = leave

    def note(self, number: int) -> None:
        """Note that a row has changed; on the loop."""
        self._numbers[number] = None
        self._changed.set()

    async def changed(self, timeout: float) -> list[int]:
        """Return the numbers of the rows; none when nothing has changed so long [s]."""
        try:
            await asyncio.wait_for(self._changed.wait(), timeout)
        except asyncio.TimeoutError:
            return []
        self._changed.clear()
        numbers, self._numbers = self._numbers, {}
        return [*numbers]

    def close(self) -> None:
        """Follow no longer."""
        self._leave(self)


def event(value: Any) -> bytes:
    """Return a value as a server-sent event."""
    return f"data: {json.dumps(value)}\n\n".encode()


def _plain(cell: object) -> object:
    """Return a cell that no spreadsheet computes."""
    is_formula = isinstance(cell, str) and cell.startswith(_FORMULA)
    return f"'{cell}" if is_formula else cell


def _time(seconds: float) -> str:
    if not seconds:
        return ""
    at = datetime.fromtimestamp(seconds, timezone.utc)
    return at.isoformat(timespec="seconds")
