"""Every error and every finding that leaves this package.

The tree of errors; nothing else is raised to a caller on purpose::

    SambotVizError
    ├── RobotError                  a model that cannot be shown (.problems)
    │   └── MeshError               a mesh file that cannot be read
    ├── ConfigError                 a file that is not a .rviz document (.problems)
    ├── LessonError                 a lesson that cannot be read (.problems)
    ├── NamedFileError              a file that a mesh names and that cannot be used
    │   └── LfsPointerError         a git-LFS pointer in place of the file itself
    ├── TextureError                an image that cannot be used
    ├── PictureError                a browser did not send the picture it was asked for
    ├── PageError                   a page of what is seen that cannot be made
    ├── FrameError                  a transform that cannot be looked up or set
    │   ├── LookupRefused           no transform between two frames (.tf2_text)
    │   ├── TransformRefused        a transform that tf2 would not take
    │   └── FrameCycleError         a transform that would form a ring
    ├── SourceError                 a bag or a robot that cannot be read (.problems)
    ├── EditRefused                 edits that cannot be made
    ├── PublishError                a message that is not sent, or that a robot refuses
    │   ├── PublishPaceError        a message that comes too soon
    │   └── PublishFrameError       a message in a frame that nobody takes
    ├── JointError                  an unknown joint, or a value that is not finite
    ├── DecodeError                 a message, or its definition, that cannot be read
    │   └── UnreadFieldError        a field of a kind that is not read
    ├── ServerError                 a port that is taken, a server that cannot go on
    │   └── BrowserError            a browser that is missing, ends or does not answer
    └── UsageError                  a command line or an argument that makes no sense
        ├── StaticTransformError    what static_transform_publisher would refuse
        ├── PropertyError           a value that a property of a config does not take
        └── UnknownPropertyError    a property that a config does not have

A `Problem` is a finding in a file of the user's. It is never raised by itself: an
error carries the problems that caused it.
"""

from __future__ import annotations

import difflib
import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Literal

from sambot_viz.text import line

Severity = Literal["error", "warning", "info"]
SEVERITIES: tuple[Severity, ...] = ("error", "warning", "info")
"""The order in which problems are shown."""


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a file that the user wrote.

    Attributes:
        file: path of the file as the user wrote it.
        line: line, counted from 1.
        column: column in that line, counted from 1, or None.
    """

    file: str
    line: int
    column: int | None = None


@dataclass(frozen=True, slots=True)
class Edit:
    """A replacement of text in a file.

    Attributes:
        file: path of the file as the user wrote it.
        start: offset of the first character that is replaced, in the text of the file
            without a byte order mark and with its own line ends.
        end: offset behind the last one; `start` where text is only added.
        text: what is written there.
        seen: hash of the text of the whole file for which the offsets are; 0 where it
            is not known. No part of the JSON output.
    """

    file: str
    start: int
    end: int
    text: str
    seen: int = field(default=0, compare=False, repr=False)

    def as_json(self) -> dict[str, str | int]:
        """Return the fields that an edit has in JSON."""
        return {
            "file": self.file,
            "start": self.start,
            "end": self.end,
            "text": self.text,
        }


@dataclass(frozen=True, slots=True)
class Fix:
    """A hint, and the edits that do what it says; `edits` makes them.

    Attributes:
        hint: what to write.
        edits: none where it cannot be done by replacing text.
    """

    hint: str
    edits: tuple[Edit, ...] = ()


@dataclass(frozen=True, slots=True)
class Problem:
    """One finding: what is wrong, where, and how to fix it.

    Attributes:
        severity: "error" (ROS or sambot-viz cannot use it), "warning" (usable, but
            ROS or a simulator may fail on it), "info" (worth knowing).
        code: stable identifier such as "xml-root-closed-early".
        message: what is wrong and why, one sentence without a full stop at the end.
        hint: what to write instead; may be empty.
        file: path of the file as the user wrote it, or None.
        line: line in that file, counted from 1, or None.
        column: column in that line, counted from 1, or None.
        cause: what several problems of one code may have in common, such as "package
            arm"; `problems` joins them. No part of the JSON output.
        edits: what the hint says as replacements of text; empty where it is something
            else, or where the text is not certain.
    """

    severity: Severity
    code: str
    message: str
    hint: str = ""
    file: str | None = None
    line: int | None = None
    column: int | None = None
    cause: str | None = field(default=None, compare=False, repr=False)
    edits: tuple[Edit, ...] = field(default=(), compare=False, repr=False)

    @classmethod
    def at(
        cls,
        where: Place | str | None,
        severity: Severity,
        code: str,
        message: str,
        hint: str | Fix = "",
        *,
        cause: str | None = None,
    ) -> Problem:
        """Return a problem at a place, in a file as a whole, or without a file."""
        if isinstance(where, Place):
            file, line, column = where.file, where.line, where.column
        else:
            file, line, column = where, None, None
        fix = hint if isinstance(hint, Fix) else Fix(hint)
        return cls(
            severity, code, message, fix.hint, file, line, column, cause, fix.edits
        )

    @property
    def place(self) -> str:
        """The clickable place: "file:line:column", as far as it is known."""
        known = (part for part in (self.file, self.line, self.column))
        return ":".join(str(part) for part in known if part is not None)

    def __str__(self) -> str:
        head = f"{self.severity}[{self.code}]: {self.message}"
        text = f"{self.place}: {head}" if self.place else head
        return line(f"{text}; {self.hint}" if self.hint else text)

    def as_json(self) -> dict[str, object]:
        """Return the eight fields that a problem has in JSON."""
        return {
            "severity": self.severity,
            "code": self.code,
            "message": self.message,
            "hint": self.hint,
            "file": self.file,
            "line": self.line,
            "column": self.column,
            "edits": [edit.as_json() for edit in self.edits],
        }


_LONGEST_SENTENCE = 2000
_PACKAGE = str(Path(__file__).parent)


class Findings:
    """Collects problems while a file is read to the end.

    Attributes:
        problems: in the order found, each once.
    """

    def __init__(self) -> None:
        self.problems: list[Problem] = []
        self._known: set[Problem] = set()

    def add(
        self,
        severity: Severity,
        code: str,
        message: str,
        hint: str | Fix = "",
        at: Place | str | None = None,
        *,
        cause: str | None = None,
    ) -> None:
        """Add a problem, unless the same one is there already.

        Sentences are cut at 2000 characters: a file may make up names of any length.
        """
        self.note(Problem.at(at, severity, code, message, hint, cause=cause))

    def note(self, problem: Problem) -> None:
        """Add a problem that is made already, by the rules of `add`."""
        message, hint = _cut(problem.message), _cut(problem.hint)
        problem = replace(problem, message=message, hint=hint)
        if problem not in self._known:
            self._known.add(problem)
            self.problems.append(problem)


def _cut(text: str) -> str:
    cut = len(text) > _LONGEST_SENTENCE
    return text[:_LONGEST_SENTENCE] + "…" if cut else text


class SambotVizError(Exception):
    """Base of every error this package raises on purpose.

    Each of its arguments is a line of its text, in which names of files and of robots
    are clean: Python itself writes it where a script does not catch it.
    """

    def __str__(self) -> str:
        return "\n".join(line(each) for each in self.args)

    def _render_traceback_(self) -> list[str]:
        """The lines of the user and the message: IPython and Jupyter show these.

        The calls within this package say nothing to who has made a mistake in a model.
        A script's traceback is Python's own.
        """
        lines: list[str] = []
        for call in traceback.extract_tb(self.__traceback__):
            if call.filename.startswith(_PACKAGE):
                break
            # IPython's own calls come first.
            if "site-packages" not in Path(call.filename).parts:
                lines.append(f"line {call.lineno}: {line(call.line)}")
        return [*lines, f"{type(self).__name__}: {self}"]


class _ErrorWithProblems(SambotVizError):
    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = tuple(problems)
        errors = [p for p in self.problems if p.severity == "error"]
        super().__init__(*map(str, errors or self.problems))


class RobotError(_ErrorWithProblems):
    """The model cannot be shown; `problems` says why.

    Attributes:
        files: the files that were read or looked for, as far as is known: the model may
            be right when one of them is saved.
    """

    def __init__(self, problems: Iterable[Problem], files: Iterable[Path] = ()) -> None:
        super().__init__(problems)
        self.files: tuple[Path, ...] = tuple(files)


class ConfigError(_ErrorWithProblems):
    """The file is not a .rviz document; `problems` says why."""


class LessonError(_ErrorWithProblems):
    """The file is not a lesson; `problems` says why."""


class SourceError(_ErrorWithProblems):
    """A recording or a robot on the network does not give what was asked for.

    Attributes:
        problems: why, for files; else empty.
    """

    def __init__(self, why: str | Iterable[Problem]) -> None:
        super().__init__(() if isinstance(why, str) else why)
        if isinstance(why, str):
            self.args = (why,)


class FrameError(SambotVizError):
    """A transform cannot be looked up or set."""


class PublishError(SambotVizError):
    """A message is not sent to a robot, or the robot refuses it."""


class PublishPaceError(PublishError):
    """It comes too soon after the last message."""


class PublishFrameError(PublishError):
    """A message is in a frame that its receiver does not take."""


class JointError(SambotVizError):
    """A joint that does not exist, or a value that is not a finite number."""


class DecodeError(SambotVizError):
    """A message, or the definition of its type, cannot be read."""


class ServerError(SambotVizError):
    """The server cannot start or cannot do what it was asked for."""


class UsageError(SambotVizError):
    """The caller asked for something that makes no sense."""


def nearest(name: str, names: Iterable[str], likeness: float = 0.6) -> str | None:
    """Return the name that is most like another, if it is as like as that (0 to 1)."""
    return _nearest(name, tuple(names), likeness)


@lru_cache(maxsize=128)
def _nearest(name: str, names: tuple[str, ...], likeness: float) -> str | None:
    # A display without its topic asks the same again at each picture.
    near = difflib.get_close_matches(name, names, n=1, cutoff=likeness)
    return near[0] if near else None


def hint_sentence(hint: str) -> str:
    """Return the hint of a problem as a sentence of its own; empty without one."""
    if hint.startswith("did you mean "):
        return hint[0].upper() + hint[1:]
    return f"To fix it: {hint}" if hint else ""


def did_you_mean(
    name: str, names: Iterable[str], part: Callable[[str], str] = str
) -> str:
    """Return a sentence that offers the nearest valid names.

    Args:
        name: what was asked for.
        names: what exists.
        part: the part of a name that is compared, such as that before its ending.

    Returns:
        "did you mean 'base_link'?", or the list of what exists, or "there are none".
    """
    known: Sequence[str] = list(names)
    if not known:
        return "there are none"
    like = nearest(part(name), map(part, known))
    same = (one for one in known if part(one) == like)
    if near := nearest(name, same, likeness=0.0):
        return f"did you mean '{near}'?"
    shown = ", ".join(f"'{n}'" for n in known[:8])
    return f"known: {shown}" + (", …" if len(known) > 8 else "")
