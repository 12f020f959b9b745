"""The Problems panel: what is wrong, where, and how to fix it."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path, PurePath
from typing import NamedTuple, cast

from sambot_viz import limits
from sambot_viz.errors import (
    SEVERITIES,
    Edit,
    Problem,
    Severity,
    UsageError,
    hint_sentence,
)
from sambot_viz.fixes import EditRefused
from sambot_viz.panels.command import TEXT, Command, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Answer, Data, Json, Level, Row
from sambot_viz.panels.unfolded import LazyRows
from sambot_viz.problems import ProblemGroup, group_problems, problem_lines
from sambot_viz.session.editor.model_text import ModelText
from sambot_viz.session.model_edits import ModelEdits
from sambot_viz.session.shown_problems import Problems
from sambot_viz.session.undo import History
from sambot_viz.text import text
from sambot_viz.unsaved import unsaved

LINES_AROUND = 2
_LONGEST_FILE = 60
_FOLDERS = re.compile(r"(?<![\w.)])/([^\s/'\"<>]+)/(?:[^\s/'\"<>]+/)*")
"""The folders of an absolute path in a text."""
_LEVELS: dict[Severity, Level] = {"error": "error", "warning": "warn", "info": "info"}


class _Fix(NamedTuple):
    """What a button does: a hint, and the edits that it is made of."""

    hint: str
    edits: tuple[Edit, ...]


class ProblemsPanel(Panel):
    """The problems of model and config, errors first; those of one cause are one row.

    What is below a row, such as the lines of the file, is only read when a page has
    unfolded the row; that of the first error is there at once.

    Args:
        problems: what is shown.
        history: keeps fixes that were written into files.
        remake: called when a page has unfolded something.
        folders: whether paths are whole; others than those at the server's own disk
            see only the names of its files.
        edits: writes fixes into files; None where no browser may.
        text: the text of the model in the editor, which takes the fixes of what is not
            saved; None without one.
    """

    name = "problems"

    def __init__(
        self,
        problems: Problems,
        history: History,
        remake: Callable[[Panel], None],
        folders: bool = True,
        edits: ModelEdits | None = None,
        text: ModelText | None = None,
    ) -> None:
        self._folders = folders
        self.remade_by = (problems.shown,)
        self._problems = problems
        self._history = history
        self._edits = edits
        self._text = text
        self._fixes: dict[str, _Fix] = {}
        self._applied: tuple[_Fix, Answer] | None = None
        self._lazy = LazyRows("problems/unfold", lambda: remake(self))

    def rows(self) -> Sequence[Row]:
        """Return the banner, and a row for each cause."""
        self._lazy.clear()
        self._fixes.clear()
        shown = self._problems.shown.value
        note = shown.note
        banner = Row("problems/good", "", "note", value=note, level="error")
        groups = group_problems(shown.listed)
        with unsaved({} if self._text is None else self._text.texts):
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
        """Return the commands to unfold a row, and to apply a fix."""
        return [self._lazy.command(), *super().commands()]

    def offers(self, command_id: str) -> bool:
        """Return whether browsers may change files, or have changed their text."""
        is_changed = self._text is not None and bool(self._text.unsaved)
        return self._edits is not None or is_changed

    @command("problems/apply", TEXT, name="Apply")
    def _apply(self, row_id: str) -> Answer:
        fix = self._fixes.get(row_id)
        if fix is not None and self._text is not None and self._text.holds(fix.edits):
            self._text.apply(fix.edits)
            hint = fix.hint if self._folders else without_folders(fix.hint)
            files = {self._text.name_of(edit.file) for edit in fix.edits}
            differs = any(buffer.name in files for buffer in self._text.unsaved)
            return Answer(f"Applied: {hint}{'; it is not saved' if differs else ''}")
        if self._edits is None or fix is None:
            raise UsageError("this problem is no longer there")
        try:
            where = self._edits.write(fix.edits, self._history)
        except EditRefused as error:
            if error.is_old and self._applied is not None and self._applied[0] == fix:
                # It was pressed twice before the file was read again.
                return self._applied[1]
            raise
        hint = fix.hint if self._folders else without_folders(fix.hint)
        said = f"Applied: {hint} in {where}"
        if self._edits.watched:
            self._problems.note_applied(fix.edits)
        else:
            said += "; start the program again to see it (--no-watch)"
        self._applied = fix, Answer(said)
        return self._applied[1]

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
            edits = group.edits if all(p.edits for p in group.problems) else ()
            yield self._hint(row_id, group.hint, edits)
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
        unfolded = self._lazy.is_unfolded(row_id) or unfolded
        below = [*self._details(problem, row_id, hint=hint)] if unfolded else None
        more = bool(problem.file or (hint and problem.hint))
        yield _head(
            row_id, parent, problem.message, problem, lazy=below is None and more
        )
        yield from below or ()

    def _details(self, problem: Problem, parent: str, *, hint: bool) -> Iterator[Row]:
        """Yield the remedy, the lines around the place, and the whole path."""
        if hint and problem.hint:
            yield self._hint(parent, problem.hint, problem.edits)
        lines = problem_lines(problem, LINES_AROUND)
        if lines:
            marked = {"line": problem.line, "column": problem.column}
            yield Row(f"{parent}/lines", parent, "lines", value=lines, extra=marked)
        if problem.file is not None:
            numbers = (n for n in (problem.line, problem.column) if n is not None)
            place = ":".join((str(Path(problem.file).absolute()), *map(str, numbers)))
            copied = {"copy": True}
            row_id = f"{parent}/place"
            yield Row(row_id, parent, "note", "the place", place, extra=copied)

    def _hint(self, parent: str, hint: str, edits: Sequence[Edit]) -> Row:
        """Return the row of a remedy, with a button that does it or the text to copy.

        What is copied must not have a folder that the page is not to see.
        """
        extra: dict[str, Json] | None = None
        texts = {edit.text for edit in edits}
        if self._may_apply(edits):
            self._fixes[parent] = _Fix(hint, tuple(edits))
            extra = {"act": ["Apply", "problems/apply", parent]}
        elif len(texts) == 1 and (
            self._folders or texts == {*map(without_folders, texts)}
        ):
            extra = {"copy": texts.pop()}
        return Row(
            f"{parent}/hint",
            parent,
            "note",
            "the fix",
            hint_sentence(hint),
            extra=extra,
        )

    def _may_apply(self, edits: Sequence[Edit]) -> bool:
        if self._text is not None and self._text.holds(edits):
            return True
        return self._edits is not None and self._edits.may_write(edits)


def place_of(problem: Problem) -> str:
    """Return the name of a problem's file, and the line."""
    return "" if problem.file is None else place_of_line(problem.file, problem.line)


def place_of_line(file: str, line: int | None) -> str:
    """Return the name of a file, and a line in it."""
    name = text(PurePath(file).name, _LONGEST_FILE)
    return name if line is None else f"{name}:{line}"


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
        extra={
            "place": place_of(problem),
            "lazy": lazy,
            **({} if parent else {"about": problem.code}),
        },
    )


def _rest(row_id: str, parent: str, count: int) -> Row:
    return Row(row_id, parent, "note", value=f"and {count} more")


def _id(*parts: object) -> str:
    """Return the same id for the same problem, whatever others there are."""
    return f"p{hashlib.blake2s(repr(parts).encode(), digest_size=8).hexdigest()}"
