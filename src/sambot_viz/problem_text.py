"""Problems as text for people: clickable place, cause, mend, and the line itself."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TextIO

from sambot_viz.errors import Problem

_COLORS = {"error": "\033[1;31m", "warning": "\033[1;33m", "info": "\033[1;36m"}
_BOLD, _DIM, _END = "\033[1m", "\033[2m", "\033[0m"
_LONGEST_EXCERPT = 160


def excerpt(problem: Problem) -> str | None:
    """The line of the file a problem points at, or None when it cannot be read."""
    if problem.file is None or problem.line is None:
        return None
    try:
        lines = Path(problem.file).read_text("utf-8", "replace").splitlines()
    except OSError:
        return None
    if not 1 <= problem.line <= len(lines):
        return None
    return lines[problem.line - 1].expandtabs(1).rstrip()[:_LONGEST_EXCERPT]


def in_words(problem: Problem, color: bool = False) -> str:
    """A problem as lines of text: the sentence, the excerpt with a mark, the mend.

    Args:
        problem: what to say.
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


def write(problems: Iterable[Problem], stream: TextIO | None = None) -> None:
    """Write problems to standard error (or another stream), errors first."""
    out: TextIO = stream or sys.stderr
    order = ("error", "warning", "info")
    color = out.isatty() and "NO_COLOR" not in os.environ
    for problem in sorted(problems, key=lambda p: order.index(p.severity)):
        out.write(in_words(problem, color) + "\n")
    out.flush()
