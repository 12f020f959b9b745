"""The students of a hub: a folder each on a shared volume, and a server each.

A hub lists its users; the page of each writes its files and its report into a folder of
the volume. So a row needs no question to a pod, which would keep an idle one alive.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from sambot_viz import limits
from sambot_viz.classroom.hub import Hub
from sambot_viz.classroom.roll import Student
from sambot_viz.classroom.seat_state import STATE_FILE, SeatState
from sambot_viz.errors import ServerError
from sambot_viz.files import Stamp, stamp
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.progress import PROGRESS_FILE, Progress

ASKED = 10.0
"""Shortest time between two questions to the hub [s]."""
SILENT = 100.0
"""A page reports every 30 s; after this time it does not answer [s]."""
_SILENCE = "does not answer"
_NO_FOLDER = "no folder yet"
Stamps = tuple[Stamp | None, Stamp | None]


class HubRoll:
    """The students of a hub, found by `look`.

    Args:
        folder: folder of the shared volume that has the students' folders.
        hub: the hub.
        clock: gives a time that only grows [s].

    Attributes:
        folder: the same folder.
        students: the students by number.
        trouble: reason why the states of servers may be old; "" when they are new.
    """

    def __init__(
        self, folder: Path, hub: Hub, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.folder = folder.absolute()
        self.students: dict[int, Student] = {}
        self.trouble = ""
        self._hub, self._clock = hub, clock
        self._users: Mapping[str, str] | None = None
        self._asked = float("-inf")
        self._numbers: dict[str, int] = {}
        self._seen: dict[int, tuple[Stamps, float]] = {}

    def look(self, lesson: Lesson) -> dict[int, SeatState]:
        """Return the state of each student, by number; blocks for some seconds."""
        if self._clock() - self._asked >= ASKED:
            try:
                self._users, self.trouble = self._hub.users(), ""
            except ServerError as error:
                self.trouble = str(error)
            self._asked = self._clock()
        if self._users is None:
            return {}
        try:
            folders = sorted(
                path.name
                for path in self.folder.iterdir()
                if path.name[0] != "." and path.is_dir() and not path.is_symlink()
            )
        except OSError as error:
            self.trouble = f"the shared folder cannot be read: {error.strerror}"
            return {}
        return self._rows(lesson, self._users, folders)

    def _rows(
        self, lesson: Lesson, users: Mapping[str, str], folders: list[str]
    ) -> dict[int, SeatState]:
        owners = owners_of(folders, users)
        owned = {name: folder for folder, name in owners.items()}
        here = [name for name, server in users.items() if not server or name in owned]
        others = [folder for folder in folders if folder not in owners]
        states: dict[int, SeatState] = {}
        for name in (*here, *others):
            student = self._student(name, owned.get(name, name))
            if student is not None:
                known = name in owned or name not in users
                states[student.number] = self._state(
                    lesson, student, users.get(name, ""), known
                )
        return states

    def _student(self, name: str, folder: str) -> Student | None:
        """Return the student of a name; None when there are too many."""
        number = self._numbers.get(name, len(self._numbers) + 1)
        if number > limits.HUB_STUDENTS.value:
            most = limits.HUB_STUDENTS.value
            self.trouble = f"only the first {most:,} students are shown"
            return None
        self._numbers[name] = number
        before = self.students.get(number) or Student(number, name, folder, "")
        self.students[number] = replace(before, folder=folder)
        return self.students[number]

    def _state(
        self, lesson: Lesson, student: Student, server: str, has_folder: bool
    ) -> SeatState:
        folder = self.folder / student.folder
        try:
            state = SeatState.on_disk(lesson, folder) if has_folder else None
        except OSError:
            state = None
        if state is None:
            none = Progress(folder, "")
            return SeatState.of(lesson, none, server=server or _NO_FOLDER)
        if server:
            return replace(state, server=server, pages=0)
        if state.pages and self._is_silent(student.number, folder):
            return replace(state, server=_SILENCE)
        return state

    def _is_silent(self, number: int, folder: Path) -> bool:
        """Return whether nothing has changed for long, by the clock of this machine."""
        stamps = stamp(folder / PROGRESS_FILE), stamp(folder / STATE_FILE)
        before = self._seen.get(number)
        if before is None or before[0] != stamps:
            before = self._seen[number] = stamps, self._clock()
        return self._clock() - before[1] > SILENT


def owners_of(folders: list[str], users: Mapping[str, str]) -> dict[str, str]:
    """Return the user of each folder that has one.

    A spawner names a folder as its user; that of Kubernetes replaces the characters
    that no label may have, and adds the start of the name's SHA-256.
    """
    by_mark = {hashlib.sha256(name.encode()).hexdigest()[:8]: name for name in users}
    found: dict[str, str] = {}
    for folder in folders:
        name = folder if folder in users else by_mark.get(folder.rpartition("---")[2])
        if name is not None:
            found[folder] = name
    return found
