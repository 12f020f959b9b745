"""The students of a class: names, folders, and cookies that recognise them again.

The class folder holds the list. It stores only a hash of each cookie, so that a reader
of the list cannot take a student's place.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import secrets
import unicodedata
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, cast

from sambot_viz import limits
from sambot_viz.errors import UsageError
from sambot_viz.files import read_limited, reason_of, write_atomically
from sambot_viz.session.people.looks_alike import same_form
from sambot_viz.text import json_text, text

ROLL_FILE = ".sambot-class.json"
"""Name of the list in the folder of a class."""
TEACHER = "Teacher"
"""Name under which students see a teacher who views their page."""
_OF_WINDOWS = {"aux", "con", "nul", "prn"} | {
    f"{port}{n}" for port in ("com", "lpt") for n in range(10)
}
"""Names that Windows does not allow for a folder."""


@dataclass(frozen=True, slots=True)
class Student:
    """One student of a class.

    Attributes:
        number: from 1, in the order of arrival.
        name: name as typed; a number follows a name that another student has.
        folder: name of the folder.
        key: hash of the cookie.
    """

    number: int
    name: str
    folder: str
    key: str


class Roll:
    """The students of a class, as stored in the class folder.

    Args:
        folder: folder of the class, created if missing.

    Attributes:
        folder: the same folder.
        students: the students by number.

    Raises:
        UsageError: the folder is not writable, or the list is damaged.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder.absolute()
        self._file = folder / ROLL_FILE
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._id, found = self._read()
            self.students = {student.number: student for student in found}
            self._save()
        except OSError as error:
            why = reason_of(error)
            raise UsageError(f"cannot write into '{folder}': {why}") from error

    @property
    def cookie(self) -> str:
        """The name of the cookie, different for each class."""
        return f"sambot-class-{self._id}"

    def of_key(self, key: str) -> Student | None:
        """Return the student with this cookie; None for an unknown cookie."""
        wanted = _hash(key)
        return next((s for s in self.students.values() if s.key == wanted), None)

    def add(self, name: str) -> tuple[Student, str]:
        """Add a student.

        Args:
            name: name as typed.

        Returns:
            The student and the cookie.

        Raises:
            UsageError: the name is not allowed, the class is full, or the folder is not
                writable.
        """
        if len(self.students) >= limits.CLASS_STUDENTS.value:
            raise UsageError(f"the class is full: {len(self.students)} students")
        name = self._free_name(_checked(name))
        key = secrets.token_urlsafe(32)
        student = Student(
            max(self.students, default=0) + 1, name, self._free_folder(name), _hash(key)
        )
        self.students[student.number] = student
        try:
            (self.folder / student.folder).mkdir()
            self._save()
        except OSError as error:
            del self.students[student.number]
            raise UsageError(
                f"the teacher's computer cannot keep your files: {reason_of(error)}"
            ) from error
        return student, key

    def _free_name(self, name: str) -> str:
        taken = {same_form(student.name) for student in self.students.values()}
        return next(one for one in _numbered(name, " ") if same_form(one) not in taken)

    def _free_folder(self, name: str) -> str:
        taken = {path.name.casefold() for path in self.folder.iterdir()}
        folders = _numbered(_as_folder(name), "-")
        return next(one for one in folders if one.casefold() not in taken)

    def _read(self) -> tuple[str, list[Student]]:
        """Return the name of the class, and its students.

        Raises:
            OSError: the list cannot be read.
            UsageError: the file is not a valid list.
        """
        if not self._file.exists():
            return secrets.token_hex(6), []
        try:
            read: Any = json.loads(read_limited(self._file, limits.LESSON.value))
            document = cast("dict[str, Any]", read)
            rows = cast("list[dict[str, Any]]", document["students"])
            return str(document["id"]), [_student(row) for row in rows]
        except (ValueError, KeyError, TypeError, RecursionError) as error:
            raise UsageError(
                f"'{self._file}' is damaged: move it away, and the class begins with "
                "nobody; the students' folders stay"
            ) from error

    def _save(self) -> None:
        rows = [asdict(student) for student in self.students.values()]
        document = {"id": self._id, "students": rows}
        write_atomically(self._file, f"{json_text(document)}\n".encode())


def _student(row: dict[str, Any]) -> Student:
    student = Student(
        int(row["number"]), str(row["name"]), str(row["folder"]), str(row["key"])
    )
    if Path(student.folder).name != student.folder or student.folder[:1] in ("", "."):
        raise ValueError(student.folder)
    return student


def _hash(key: str) -> str:
    return hashlib.sha256(key.encode(errors="replace")).hexdigest()


def _checked(name: str) -> str:
    """Return a name as others read it.

    Raises:
        UsageError: the name is empty, too long, or the teacher's.
    """
    name = " ".join(unicodedata.normalize("NFC", name).split())
    if not same_form(name):
        raise UsageError("type your name")
    if len(name) > limits.PERSON_NAME.value:
        raise UsageError(f"a name has at most {limits.PERSON_NAME.value} characters")
    if same_form(name) == same_form(TEACHER):
        raise UsageError("this is what the teacher is called: type your own name")
    return text(name)


def _as_folder(name: str) -> str:
    """Return the folder name for a student's name, in letters of any script."""
    plain = unicodedata.normalize("NFKC", name)
    kept = "".join(c if c.isalnum() else " " for c in plain)
    while len("-".join(kept.split()).encode()) > limits.CLASS_FOLDER.value:
        kept = kept[:-1]
    made = "-".join(kept.split())
    return (
        f"student-{made}".strip("-") if made.casefold() in {"", *_OF_WINDOWS} else made
    )


def _numbered(name: str, joint: str) -> Iterator[str]:
    """Yield the name, then the name with numbers."""
    yield name
    yield from (f"{name}{joint}{number}" for number in itertools.count(2))
