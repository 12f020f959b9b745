"""Problems as text for people: clickable place, cause, fix, and the lines around."""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import TextIO

from sambot_viz.errors import Problem
from sambot_viz.problem_groups import ProblemGroup, group_problems, in_order

MOST = 10
"""A terminal gets at most so many groups; ``sambot-viz check`` prints each problem."""

_COLORS = {"error": "\033[1;31m", "warning": "\033[1;33m", "info": "\033[1;36m"}
_BOLD, _DIM, _END = "\033[1m", "\033[2m", "\033[0m"
_PLAIN = ("", "", "")
_LONGEST_LINE = 160


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


def in_words(problem: Problem, color: bool = False) -> str:
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
    """Place, severity and code of a problem with a message, and the hint."""
    paint, bold, end = (_COLORS[problem.severity], _BOLD, _END) if color else _PLAIN
    place = f"{bold}{problem.place}:{end} " if problem.place else ""
    hint = f"; {problem.hint}" if problem.hint else ""
    return f"{place}{paint}{problem.severity}[{problem.code}]:{end} {message}{hint}"


def write(
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
        texts = [in_words(problem, color) for problem in in_order(problems)]
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
    """Several problems in one line, at the place of the first; one in full."""
    if len(group.problems) == 1:
        return in_words(group.first, color)
    return _sentence(group.first, group.message, color)
