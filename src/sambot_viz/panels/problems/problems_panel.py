"""The Problems panel: what is wrong, where, and how to fix it."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path, PurePath
from typing import cast

from sambot_viz import limits
from sambot_viz.errors import Problem, Severity
from sambot_viz.panels.command import Command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json, Level, Row
from sambot_viz.panels.unfolded import LazyRows
from sambot_viz.problems import SEVERITIES, ProblemGroup, group_problems, problem_lines
from sambot_viz.session.shown_problems import Problems
from sambot_viz.text import text

LINES_AROUND = 2
_LONGEST_FILE = 60
_FOLDERS = re.compile(r"(?<![\w.)])/([^\s/'\"<>]+)/(?:[^\s/'\"<>]+/)*")
"""The folders of an absolute path in a text."""
_LEVELS: dict[Severity, Level] = {"error": "error", "warning": "warn", "info": "info"}


class ProblemsPanel(Panel):
    """The problems of model and config, errors first; those of one cause are one row.

    What is below a row, such as the lines of the file, is only read when a page has
    unfolded the row; that of the first error is there at once.

    Args:
        problems: what is shown.
        remake: called when a page has unfolded something.
        folders: whether paths are whole; others than those at the server's own disk
            see only the names of its files.
    """

    name = "problems"

    def __init__(
        self,
        problems: Problems,
        remake: Callable[[Panel], None],
        folders: bool = True,
    ) -> None:
        self._folders = folders
        self.remade_by = (problems.shown,)
        self._problems = problems
        self._lazy = LazyRows("problems/unfold", lambda: remake(self))

    def rows(self) -> Sequence[Row]:
        """Return the banner, and a row for each cause."""
        self._lazy.clear()
        shown = self._problems.shown.value
        note = shown.note
        banner = Row("problems/good", "", "note", value=note, level="error")
        groups = group_problems(shown.listed)
        made = [*([banner] if note else ()), *self._group_rows(groups)]
        if self._folders:
            return made
        return [replace(row, value=without_folders(row.value)) for row in made]

    def data(self) -> Sequence[Data]:
        """Return how many causes there are of each severity."""
        shown = self._problems.shown.value
        groups = group_problems(shown.listed)
        count = Counter(group.severity for group in groups)
        counts = {severity: count[severity] for severity in SEVERITIES}
        state = {"old": bool(shown.note), "checking": shown.checking}
        return [Data("problems/count", {**counts, **state})]

    def commands(self) -> list[Command]:
        """Return the command to unfold a row."""
        return [self._lazy.command()]

    def _group_rows(self, groups: Sequence[ProblemGroup]) -> Iterator[Row]:
        for index, group in enumerate(groups[: limits.PROBLEM_ROWS.value]):
            first = index == 0 and group.severity == "error"
            if len(group.problems) == 1:
                yield from self._problem_rows(group.first, "", unfolded=first)
            else:
                yield from self._several_rows(group, unfolded=first)
        if not groups and self._problems.shown.value.checking:
            yield Row("problems/none", "", "note", value="Checking…")
        elif not groups:
            yield Row("problems/none", "", "note", value="No problems.", level="ok")
        elif len(groups) > limits.PROBLEM_ROWS.value:
            yield _rest("problems/rest", "", len(groups) - limits.PROBLEM_ROWS.value)

    def _several_rows(self, group: ProblemGroup, *, unfolded: bool) -> Iterator[Row]:
        row_id = _group_id(group)
        unfolded = self._lazy.is_unfolded(row_id) or unfolded
        yield _head(row_id, "", group.message, group.first, lazy=not unfolded)
        if not unfolded:
            return
        if group.hint:
            yield _hint(row_id, group.hint)
        for problem in group.problems[: limits.PROBLEM_ROWS.value]:
            yield from self._problem_rows(problem, row_id, hint=False)
        if len(group.problems) > limits.PROBLEM_ROWS.value:
            yield _rest(
                f"{row_id}/rest",
                row_id,
                len(group.problems) - limits.PROBLEM_ROWS.value,
            )

    def _problem_rows(
        self,
        problem: Problem,
        parent: str,
        *,
        hint: bool = True,
        unfolded: bool = False,
    ) -> Iterator[Row]:
        own = _problem_id(problem)
        row_id = f"{parent}/{own}" if parent else own
        below = [*_details(problem, row_id, hint=hint)] if unfolded else None
        if below is None and self._lazy.is_unfolded(row_id):
            below = [*_details(problem, row_id, hint=hint)]
        more = bool(problem.file or (hint and problem.hint))
        yield _head(
            row_id, parent, problem.message, problem, lazy=below is None and more
        )
        yield from below or ()


def place_of(problem: Problem) -> str:
    """Return the name of a problem's file, and the line."""
    if problem.file is None:
        return ""
    name = text(PurePath(problem.file).name, _LONGEST_FILE)
    return name if problem.line is None else f"{name}:{problem.line}"


def without_folders(value: Json) -> Json:
    """Leave out the folders of this computer in a sentence, or in lines of a file."""
    if isinstance(value, list):
        return [
            (number, without_folders(line))
            for number, line in cast("list[tuple[int, str]]", value)
        ]
    if not isinstance(value, str):
        return value
    return _FOLDERS.sub(lambda m: "" if _is_folder(m[1]) else m[0], value)


@cache
def _is_folder(name: str) -> bool:
    """Tell folders of the disk from the names of topics, which look like them."""
    return Path(f"/{name}").is_dir()


def rows_by_place(problems: Iterable[Problem]) -> dict[str, str]:
    """Return the ids of the rows that say what is wrong at a line, by `place_of`."""
    return {
        place_of(problem): _group_id(group)
        for group in group_problems(problems)[: limits.PROBLEM_ROWS.value]
        for problem in group.problems
        if problem.line is not None
    }


def _group_id(group: ProblemGroup) -> str:
    first = group.first
    if len(group.problems) == 1:
        return _problem_id(first)
    return _id(group.severity, first.code, group.hint, first.cause)


def _problem_id(problem: Problem) -> str:
    return _id(problem.severity, problem.place, str(problem))


def _head(
    row_id: str, parent: str, message: str, problem: Problem, *, lazy: bool
) -> Row:
    return Row(
        row_id,
        parent,
        "note",
        value=message,
        level=_LEVELS[problem.severity],
        expanded=not lazy,
        extra={"place": place_of(problem), "lazy": lazy},
    )


def _details(problem: Problem, parent: str, *, hint: bool) -> Iterator[Row]:
    """Yield the remedy, the lines around the place, and the whole path."""
    if hint and problem.hint:
        yield _hint(parent, problem.hint)
    lines = problem_lines(problem, LINES_AROUND)
    if lines:
        marked = {"line": problem.line, "column": problem.column}
        yield Row(f"{parent}/lines", parent, "lines", value=lines, extra=marked)
    if problem.file is not None:
        numbers = (n for n in (problem.line, problem.column) if n is not None)
        place = ":".join((str(Path(problem.file).absolute()), *map(str, numbers)))
        extra = {"copy": True}
        yield Row(f"{parent}/place", parent, "note", "the place", place, extra=extra)


def _hint(parent: str, hint: str) -> Row:
    return Row(f"{parent}/hint", parent, "note", "Fix", f"To fix it: {hint}")


def _rest(row_id: str, parent: str, count: int) -> Row:
    return Row(row_id, parent, "note", value=f"and {count} more")


def _id(*parts: object) -> str:
    """Return the same id for the same problem, whatever others there are."""
    return f"p{hashlib.blake2s(repr(parts).encode(), digest_size=8).hexdigest()}"
