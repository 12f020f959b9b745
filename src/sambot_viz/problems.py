"""Join problems of one cause, and write problems for people.

A package that is not found makes a problem of each of its meshes, and a mistake in a
macro one of each call. Fixing the cause fixes them all, so that they are shown as one,
with their number and the one remedy: a row in the page, a paragraph on the terminal.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import SEVERITIES, Edit, Problem, Severity
from sambot_viz.files import read_limited
from sambot_viz.outlet import Line, Painted, write_err
from sambot_viz.text import line
from sambot_viz.unsaved import unsaved_text

MOST = 10
"""Maximum number of groups in a terminal; ``sambot-viz check`` prints all of them."""

_LONGEST_LINE = 160
_LINE_BREAK = re.compile("\n")
_LINE_BREAK_OF_YAML = re.compile("[\n\x85\u2028\u2029]")

_SENTENCES = {
    "mesh-not-found": "{count} meshes of {cause}: not found",
    "texture-not-found": "{count} textures of {cause}: not found",
    "file-letter-case": "{count} files of {cause}: their names differ in capital "
    "letters from the files here; on Linux ROS does not find them",
    "file-other-machine": "{count} files of {cause}: their paths are of another "
    "machine; what was found here was used",
    "file-other-layout": "{count} files of {cause}: not at these places in the "
    "package; what was found elsewhere in it was used",
    "file-by-path-only": "{count} files of {cause}: not found by package or folder; "
    "files whose paths end in the same way were used",
    "file-name-form": "{count} files: {cause}; what was found here was used",
    "package-three-slashes": "{count} files: package:/// has three slashes, so the "
    "name of the package is empty and ROS finds nothing",
    "joint-parent-unknown": "{count} joints have the parent {cause}, which does not "
    "exist; ROS refuses the model",
    "joint-child-unknown": "{count} joints have the child {cause}, which does not "
    "exist; ROS refuses the model",
    "mimic-joint-unknown": "{count} joints mimic {cause}, which does not exist; "
    "joint_state_publisher would crash",
    "material-redefined": "{count} definitions of {cause} differ from its first one; "
    "ROS uses the first one everywhere",
    **dict.fromkeys(
        (
            "mesh-compressed",
            "mesh-empty",
            "mesh-format-unknown",
            "mesh-lfs-pointer",
            "mesh-material-missing",
            "mesh-missing",
            "mesh-texture-broken",
            "mesh-texture-missing",
            "mesh-unreadable",
        ),
        "{count} meshes have the same problem: {cause}",
    ),
}
"""Code → what several problems with one `Problem.cause` say together.

Problems of other codes belong together only when they are at one place of a file.
"""


@dataclass(frozen=True, slots=True)
class ProblemGroup:
    """Problems that have one cause and go away with one remedy.

    Attributes:
        problems: all of them, at least one, in the order of `in_order`.
        severity: of each of them.
        message: the problem's own, or one for all of them with their number.
        hint: the remedy; each of them has the same one.
    """

    problems: tuple[Problem, ...]
    severity: Severity
    message: str
    hint: str

    @property
    def edits(self) -> tuple[Edit, ...]:
        """The edits of all of them, each once."""
        edits = (edit for problem in self.problems for edit in problem.edits)
        return tuple(dict.fromkeys(edits))

    @property
    def first(self) -> Problem:
        """The problem whose place is shown for all."""
        return self.problems[0]

    def as_json(self) -> dict[str, object]:
        """Return the row of ``check --format json``: a problem, and its other places.

        These are the fields of the first problem with the message of the group, the
        number of problems, the places of those after the first, and all edits.
        """
        return {
            **self.first.as_json(),
            "message": self.message,
            "count": len(self.problems),
            "more_places": [
                {"file": other.file, "line": other.line, "column": other.column}
                for other in self.problems[1:]
            ],
            "edits": [edit.as_json() for edit in self.edits],
        }


def group_problems(problems: Iterable[Problem]) -> list[ProblemGroup]:
    """Join problems that have one cause.

    Args:
        problems: in any order.

    Returns:
        The groups in the order of their first problems; see `in_order`.
    """
    groups: dict[object, list[Problem]] = {}
    for problem in in_order(problems):
        groups.setdefault(_key(problem), []).append(problem)
    return [_group(members) for members in groups.values()]


def in_order(problems: Iterable[Problem]) -> list[Problem]:
    """Return each problem once: errors, warnings, infos; else in the order given."""
    return sorted(dict.fromkeys(problems), key=lambda p: SEVERITIES.index(p.severity))


def _key(problem: Problem) -> object:
    """Return what problems with one cause have in common."""
    kind = (problem.severity, problem.code, problem.hint)
    if problem.cause is not None and problem.code in _SENTENCES:
        return (*kind, problem.cause)
    if problem.file is not None and problem.line is not None:
        return (*kind, problem.file, problem.line, problem.column)
    return problem


def _group(members: list[Problem]) -> ProblemGroup:
    first = members[0]
    message, sentence = first.message, _SENTENCES.get(first.code)
    if len(members) > 1 and first.cause is not None and sentence is not None:
        message = sentence.format(count=len(members), cause=first.cause)
    elif len(members) > 1:
        message = f"{first.message} (and {len(members) - 1} more like it)"
    return ProblemGroup(tuple(members), first.severity, message, first.hint)


def problem_lines(problem: Problem, context: int = 2) -> list[tuple[int, str]]:
    """Return the lines of the file around the place of a problem.

    Args:
        problem: its `line` is the marked one, its `column` is right in that line: a
            tab is one blank here.
        context: how many lines before and after it.

    Returns:
        (number of the line, its text), at most 160 characters of each; empty when the
        problem has no line or the file cannot be read.
    """
    if problem.file is None or problem.line is None:
        return []
    try:
        lines = _lines_of(problem.file)
    except (OSError, ValueError):
        return []
    if not 1 <= problem.line <= len(lines):
        return []
    first = max(1, problem.line - context)
    around = lines[first - 1 : problem.line + context]
    return [(number, _shown(line)) for number, line in enumerate(around, first)]


def _shown(written: str) -> str:
    return line(written[:_LONGEST_LINE]).rstrip()


def _lines_of(file: str) -> list[str]:
    text = unsaved_text(file)
    if text is not None:
        return _split(file, text)
    stat = os.stat(file)
    return _lines(file, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=4)
def _lines(file: str, saved: int, size: int) -> list[str]:
    """Return the lines of a file, read once for many problems until it is saved."""
    data = read_limited(Path(file), limits.MODEL.value)
    return _split(file, data.decode("utf-8", "replace"))


def _split(file: str, text: str) -> list[str]:
    """Return the lines of a text, counted as whoever reads its file counts them."""
    is_yaml = file.endswith((".rviz", ".yaml", ".yml"))
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    lines = (_LINE_BREAK_OF_YAML if is_yaml else _LINE_BREAK).split(text)
    return lines if lines[-1] else lines[:-1]


def problem_in_words(problem: Problem, message: str | None = None) -> list[Line]:
    """Write a problem as lines: the sentence with the fix, the excerpt with a mark.

    Args:
        problem: the problem.
        message: a sentence in place of its message.
    """
    lines: list[Line] = [_sentence(problem, message or problem.message)]
    for margin, excerpt in _excerpt(problem):
        lines.append([Painted(margin, "dim"), excerpt])
        if problem.column is not None and problem.column <= len(excerpt) + 1:
            blank = " " * (len(margin) + problem.column - 1)
            lines.append([blank, Painted("^", problem.severity)])
    return lines


def _excerpt(problem: Problem) -> list[tuple[str, str]]:
    """Return the margin and the text of the line of a problem, if it has one."""
    lines = problem_lines(problem, context=0)
    return [(f"{number:>5} | ", text) for number, text in lines if text.strip()]


def _sentence(problem: Problem, message: str) -> Line:
    """Write place, severity and code of a problem with a message, and the hint."""
    place = (Painted(f"{problem.place}:", "bold"), " ") if problem.place else ()
    kind = Painted(f"{problem.severity}[{problem.code}]:", problem.severity)
    hint = f"; {problem.hint}" if problem.hint else ""
    return [*place, kind, f" {message}{hint}"]


def write_problems(
    problems: Iterable[Problem],
    write: Callable[..., None] = write_err,
    *,
    most: int | None = MOST,
    model: object = None,
) -> None:
    """Write problems, errors first.

    Args:
        problems: the problems.
        write: `outlet.write_err` or `outlet.write_out`.
        most: after so many causes only the number of the other problems is written,
            and the command that prints them. None writes all, and the lines of all.
        model: the model as the user wrote it, for that command.
    """
    groups = group_problems(problems)
    if most is None:
        for each in groups:
            write(*_with_places(each))
    else:
        for each in groups[:most]:
            write(*group_in_words(each))
        rest = sum(len(group.problems) for group in groups[most:])
        if rest:
            commands = _commands(groups[most:], model)
            write(f"{rest} more; to see all of them: {commands}")
        elif joined := [group for group in groups if len(group.problems) > 1]:
            write(f"to see each of them: {_commands(joined, model)}")


def _commands(groups: Iterable[ProblemGroup], model: object) -> str:
    """Return the commands that print every problem of some groups."""
    files = [group.first.file or "" for group in groups]
    configs = [file for file in files if file.endswith(".rviz")]
    commands = [f"sambot-viz config {shlex.quote(file)}" for file in configs]
    if len(configs) < len(files):
        name = "MODEL" if model is None else shlex.quote(str(model))
        commands.append(f"sambot-viz check {name}")
    return ", ".join(dict.fromkeys(commands))


def group_in_words(group: ProblemGroup) -> list[Line]:
    """Write several problems in one line, at the place of the first; one in full."""
    if len(group.problems) == 1:
        return problem_in_words(group.first)
    return [_sentence(group.first, group.message)]


def _with_places(group: ProblemGroup) -> list[Line]:
    """Write several problems as one, and the lines of all of them."""
    lines = problem_in_words(group.first, group.message)
    before, seen = group.first, {(group.first.file, group.first.line)}
    for problem in group.problems[1:]:
        if not problem.place:
            lines.append([problem.message])
        if (problem.file, problem.line) in seen:
            continue
        seen.add((problem.file, problem.line))
        excerpt = _excerpt(problem)
        if problem.place and (problem.file != before.file or not excerpt):
            lines.append([Painted(f"{problem.place}:", "bold")])
        lines += ([Painted(margin, "dim"), text] for margin, text in excerpt)
        before = problem
    return lines
