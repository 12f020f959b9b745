"""Problems as text for people: clickable place, cause, fix, and the line itself."""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TextIO

from sambot_viz.errors import Problem

MOST = 10
"""A terminal gets at most so many problems; ``sambot-viz check`` prints all."""

_COLORS = {"error": "\033[1;31m", "warning": "\033[1;33m", "info": "\033[1;36m"}
_BOLD, _DIM, _END = "\033[1m", "\033[2m", "\033[0m"
_LONGEST_EXCERPT = 160
_ORDER = ("error", "warning", "info")


def excerpt(problem: Problem) -> str | None:
    """The line of the file a problem points at, or None when it cannot be read."""
    if problem.file is None or problem.line is None:
        return None
    try:
        stat = os.stat(problem.file)
        lines = _lines(problem.file, stat.st_mtime_ns, stat.st_size)
    except (OSError, ValueError):
        return None
    if not 1 <= problem.line <= len(lines):
        return None
    return lines[problem.line - 1].expandtabs(1).rstrip()[:_LONGEST_EXCERPT]


@lru_cache(maxsize=4)
def _lines(file: str, saved: int, size: int) -> list[str]:
    """The lines of a file, read once for many problems as long as it is not saved."""
    return Path(file).read_text("utf-8", "replace").splitlines()


def in_words(problem: Problem, color: bool = False) -> str:
    """A problem as lines of text: the sentence, the excerpt with a mark, the fix.

    Args:
        problem: what to print.
        color: with the escape codes of a terminal.
    """
    paint = _COLORS[problem.severity] if color else ""
    bold, dim, end = (_BOLD, _DIM, _END) if color else ("", "", "")
    place = f"{bold}{problem.place}:{end} " if problem.place else ""
    hint = f"; {problem.hint}" if problem.hint else ""
    lines = [
        f"{place}{paint}{problem.severity}[{problem.code}]:{end} "
        f"{problem.message}{hint}"
    ]
    line = excerpt(problem)
    if line is not None and line.strip():
        number = f"{problem.line:>5} | "
        lines.append(f"{dim}{number}{end}{line}")
        if problem.column is not None and problem.column <= len(line) + 1:
            lines.append(f"{' ' * (len(number) + problem.column - 1)}{paint}^{end}")
    return "\n".join(lines)


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
        most: after so many only the number of the others is written, and the command
            that prints all; None writes all.
        model: the model as the user wrote it, for that command.
    """
    out: TextIO = stream or sys.stderr
    color = out.isatty() and "NO_COLOR" not in os.environ
    listed = sorted(problems, key=lambda p: _ORDER.index(p.severity))
    for problem in listed[:most]:
        out.write(in_words(problem, color) + "\n")
    if most is not None and len(listed) > most:
        out.write(_rest(listed[most:], model))
    out.flush()


def _rest(problems: Sequence[Problem], model: object) -> str:
    """The last line when not all problems are written."""
    name = "MODEL" if model is None else shlex.quote(str(model))
    return f"{len(problems)} more; to see all of them: sambot-viz check {name}\n"
