"""Join problems of one cause, and write problems for people.

A package that is not found makes a problem of each of its meshes, and a mistake in a
macro one of each call. Fixing the cause fixes them all, so that they are shown as one,
with their number and the one remedy: a row in the page, a paragraph on the terminal.
"""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TextIO

from sambot_viz.errors import Problem, Severity

SEVERITIES: tuple[Severity, ...] = ("error", "warning", "info")
"""The order in which problems are shown."""

MOST = 10
"""A terminal gets at most so many groups; ``sambot-viz check`` prints each problem."""

_COLORS = {"error": "\033[1;31m", "warning": "\033[1;33m", "info": "\033[1;36m"}
_BOLD, _DIM, _END = "\033[1m", "\033[2m", "\033[0m"
_PLAIN = ("", "", "")
_LONGEST_LINE = 160

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
    def first(self) -> Problem:
        """The problem whose place stands for all."""
        return self.problems[0]

    def as_json(self) -> dict[str, object]:
        """Return the row of ``check --format json``: a problem, and its other places.

        These are the fields of the first problem with the message of the group, the
        number of problems, and the places of those after the first.
        """
        return {
            **self.first.as_json(),
            "message": self.message,
            "count": len(self.problems),
            "more_places": [
                {"file": other.file, "line": other.line, "column": other.column}
                for other in self.problems[1:]
            ],
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
        stat = os.stat(problem.file)
        lines = _lines(problem.file, stat.st_mtime_ns, stat.st_size)
    except (OSError, ValueError):
        return []
    if not 1 <= problem.line <= len(lines):
        return []
    first = max(1, problem.line - context)
    around = lines[first - 1 : problem.line + context]
    return [(number, _shown(line)) for number, line in enumerate(around, first)]


def _shown(line: str) -> str:
    return line[:_LONGEST_LINE].expandtabs(1).rstrip()


@lru_cache(maxsize=4)
def _lines(file: str, saved: int, size: int) -> list[str]:
    """Return the lines of a file, read once for many problems until it is saved."""
    return Path(file).read_text("utf-8", "replace").splitlines()


def problem_in_words(problem: Problem, color: bool = False) -> str:
    """Write a problem as lines: the sentence, the excerpt with a mark, the fix.

    Args:
        problem: what to print.
        color: with the escape codes of a terminal.
    """
    paint, dim, end = (_COLORS[problem.severity], _DIM, _END) if color else _PLAIN
    lines = [_sentence(problem, problem.message, color)]
    for number, line in problem_lines(problem, context=0):
        if not line.strip():
            continue
        margin = f"{number:>5} | "
        lines.append(f"{dim}{margin}{end}{line}")
        if problem.column is not None and problem.column <= len(line) + 1:
            lines.append(f"{' ' * (len(margin) + problem.column - 1)}{paint}^{end}")
    return "\n".join(lines)


def _sentence(problem: Problem, message: str, color: bool) -> str:
    """Write place, severity and code of a problem with a message, and the hint."""
    paint, bold, end = (_COLORS[problem.severity], _BOLD, _END) if color else _PLAIN
    place = f"{bold}{problem.place}:{end} " if problem.place else ""
    hint = f"; {problem.hint}" if problem.hint else ""
    return f"{place}{paint}{problem.severity}[{problem.code}]:{end} {message}{hint}"


def write_problems(
    problems: Iterable[Problem],
    stream: TextIO | None = None,
    *,
    most: int | None = MOST,
    model: object = None,
) -> None:
    """Write problems to a stream, errors first.

    Args:
        problems: what to write.
        stream: where to; default standard error.
        most: problems of one cause are written as one; after so many only the number of
            the others is written, and the command that prints each. None writes each.
        model: the model as the user wrote it, for that command.
    """
    out: TextIO = stream or sys.stderr
    color = out.isatty() and "NO_COLOR" not in os.environ
    if most is None:
        texts = [problem_in_words(problem, color) for problem in in_order(problems)]
    else:
        groups = group_problems(problems)
        texts = [_group_in_words(group, color) for group in groups[:most]]
        rest = sum(len(group.problems) for group in groups[most:])
        if rest:
            commands = _commands(groups[most:], model)
            texts.append(f"{rest} more; to see all of them: {commands}")
        elif joined := [group for group in groups if len(group.problems) > 1]:
            texts.append(f"to see each of them: {_commands(joined, model)}")
    for text in texts:
        out.write(f"{text}\n")
    out.flush()


def _commands(groups: Iterable[ProblemGroup], model: object) -> str:
    """Return the commands that print every problem of some groups."""
    files = [group.first.file or "" for group in groups]
    configs = [file for file in files if file.endswith(".rviz")]
    commands = [f"sambot-viz config {shlex.quote(file)}" for file in configs]
    if len(configs) < len(files):
        name = "MODEL" if model is None else shlex.quote(str(model))
        commands.append(f"sambot-viz check {name}")
    return ", ".join(dict.fromkeys(commands))


def _group_in_words(group: ProblemGroup, color: bool) -> str:
    """Write several problems in one line, at the place of the first; one in full."""
    if len(group.problems) == 1:
        return problem_in_words(group.first, color)
    return _sentence(group.first, group.message, color)
