"""``sambot-viz check --fix``: show edits, ask, write them, and check again."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from sambot_viz.checks.proven import drawback
from sambot_viz.errors import Edit, Problem, Severity
from sambot_viz.fixes import (
    EditRefused,
    FileChange,
    changes,
    undo_changes,
    write_changes,
)
from sambot_viz.outlet import Line, Painted, Style, ask, write_out
from sambot_viz.problems import ProblemGroup, group_in_words, group_problems
from sambot_viz.robot.packages.package_index import package_of

_MOST_ROUNDS = 10
"""Rounds at most: edits may bring findings to light that have edits themselves."""
_MODELS = (".urdf", ".xacro", ".sdf", ".gazebo")
_QUESTION = "Apply? [y]es [n]o [a]ll [q]uit"
_STYLES: dict[str, Style] = {"+": "added", "-": "removed", "@": "dim"}


def folders_of(model: Path, folder: Path | None) -> list[Path]:
    """Return the folders in which files may be changed.

    Args:
        model: the model; files of its package may be changed, without one those
            beside it.
        folder: the folder that was given in place of a model.
    """
    package = package_of(model)
    return [package] if folder is None else [folder, package]


class _Made(NamedTuple):
    """Edits that were written together: of how many findings, and in which files."""

    findings: int
    changes: tuple[FileChange, ...]

    def is_only_of(self, file: str) -> bool:
        return all(change.file == file for change in self.changes)


class Fixing:
    """Applies the edits of findings in rounds, with a question for each.

    Args:
        check: finds the problems.
        folders: the folders whose files may be changed.
        asks: whether to ask before each write.
        infos: whether to apply the edits of infos too.
    """

    def __init__(
        self,
        check: Callable[[], list[Problem]],
        folders: Sequence[Path],
        *,
        asks: bool,
        infos: bool = True,
    ) -> None:
        self._check = check
        self._folders = folders
        self._asks = asks
        self._infos = infos
        self._quits = False
        self._settled: set[object] = set()
        self._made: list[_Made] = []

    def run(self) -> list[Problem]:
        """Apply the wanted edits, and return the problems that are left."""
        problems = self._check()
        for _ in range(_MOST_ROUNDS):
            chosen = self._choose(problems)
            if chosen:
                problems = self._apply(chosen, problems)
            if self._quits or not chosen:
                break
        left = sum(bool(p.edits) and not self._takes(p) for p in problems)
        if not self._settled and not left:
            write_out("no finding has an edit")
        elif fixed := sum(each.findings for each in self._made):
            write_out(f"{_counted(fixed, 'finding')} fixed in {self._places()}")
        if left:
            write_out(f"to fix {_counted(left, 'info')} too, add --infos")
        return problems

    def _takes(self, finding: Problem) -> bool:
        return self._infos or finding.severity != "info"

    def _places(self) -> str:
        files = {change.file for each in self._made for change in each.changes}
        return next(iter(files)) if len(files) == 1 else _counted(len(files), "file")

    def _choose(self, problems: Sequence[Problem]) -> list[ProblemGroup]:
        """Show the edits that can be made together, and ask which are wanted."""
        chosen: list[ProblemGroup] = []
        taken: list[Edit] = []
        groups = [g for g in group_problems(filter(self._takes, problems)) if g.edits]
        groups = [g for g in groups if _key(g) not in self._settled]
        # Findings in other files may follow from the model, so it comes first.
        for group in list(filter(_is_of_model, groups)) or groups:
            key = _key(group)
            if _overlap(group.edits, taken):
                continue
            self._settled.add(key)
            write_out(*group_in_words(group))
            try:
                shown = changes(group.edits, self._folders)
            except EditRefused as error:
                write_out(f"not applied: {error}")
                continue
            write_out(*(line for change in shown for line in _diff(change)))
            if self._wants():
                chosen.append(group)
                taken += group.edits
            if self._quits:
                break
        return chosen

    def _wants(self) -> bool:
        while self._asks:
            answer = ask(_QUESTION)
            word = "q" if answer is None else answer.lower()
            if word in ("y", "yes"):
                return True
            if word in ("n", "no"):
                return False
            if word in ("q", "quit"):
                self._quits = True
                return False
            self._asks = word not in ("a", "all")
        return True

    def _apply(
        self, groups: Sequence[ProblemGroup], before: list[Problem]
    ) -> list[Problem]:
        """Apply edits together or, if that causes errors, one by one."""
        alone = len(groups) == 1
        try:
            made = self._write(groups)
        except EditRefused as error:
            if alone:
                write_out(f"not applied: {error}")
            after = self._check()
            return after if alone else self._apply_each(groups, after)
        after = self._check()
        worse = _worse(groups, before, after)
        if not worse:
            findings = sum(len(group.problems) for group in groups)
            self._note(_Made(findings, tuple(made)))
            return after
        undo_changes(made)
        if not alone:
            return self._apply_each(groups, before)
        write_out(f"{groups[0].first.place}: not applied: {worse}")
        return before

    def _note(self, new: _Made) -> None:
        """Remember what was written, without what it takes back."""
        for change in new.changes:
            for at, earlier in enumerate(self._made):
                if any(change.brings_back(other) for other in earlier.changes):
                    write_out(f"{change.file}: as it was before: edits undo each other")
                    rest = self._made[at:]
                    self._made[at:] = [e for e in rest if not e.is_only_of(change.file)]
                    return
        self._made.append(new)

    def _apply_each(
        self, groups: Sequence[ProblemGroup], problems: list[Problem]
    ) -> list[Problem]:
        for key in map(_key, groups):
            now = (group for group in group_problems(problems) if _key(group) == key)
            if (group := next(now, None)) is not None:
                problems = self._apply([group], problems)
        return problems

    def _write(self, groups: Sequence[ProblemGroup]) -> list[FileChange]:
        edits = [edit for group in groups for edit in group.edits]
        made = changes(edits, self._folders)
        write_changes(made)
        return made


def _key(group: ProblemGroup) -> object:
    """Return a key that stays the same when other edits move a text in its line."""
    edits = tuple((e.file, e.end - e.start, e.text) for e in group.edits)
    return group.first.code, group.first.file, group.first.line, group.hint, edits


def _is_of_model(group: ProblemGroup) -> bool:
    return all(edit.file.endswith(_MODELS) for edit in group.edits)


def _overlap(edits: Sequence[Edit], others: Sequence[Edit]) -> bool:
    return any(
        one.file == other.file and one.start <= other.end and other.start <= one.end
        for one in edits
        for other in others
    )


def _errors(problems: Sequence[Problem]) -> int:
    return sum(problem.severity == "error" for problem in problems)


def _worse(
    groups: Sequence[ProblemGroup], before: Sequence[Problem], after: Sequence[Problem]
) -> str:
    """Return why edits make nothing better; empty when they do."""
    counted: list[Severity] = []
    # An error in place of another one may be seen only without that.
    if len(groups) > 1 or _errors(after) > _errors(before):
        counted.append("error")
    # Behind an error no warning of the model was seen.
    if not _errors(before):
        counted.append("warning")
    return drawback([group.problems for group in groups], before, after, counted)


def _diff(change: FileChange) -> Iterator[Line]:
    for number, written in enumerate(change.diff()):
        style = "bold" if number < 2 else _STYLES.get(written[0])
        yield written if style is None else [Painted(written, style)]


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
