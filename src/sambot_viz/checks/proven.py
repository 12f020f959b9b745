"""Keep the edits of findings only where they make a model better: try them in memory.

An edit is kept when its finding is gone afterwards, and no other error or warning came.
Without its edit a finding stays, with the same hint.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace

from sambot_viz.checks.consequences import Look, edited, edited_texts, looked_again
from sambot_viz.checks.rule import Subject
from sambot_viz.edits import source_of
from sambot_viz.errors import Problem, RobotError, Severity
from sambot_viz.robot.model import Robot
from sambot_viz.unsaved import unsaved

_MOST = 4
"""Maximum number of codes whose edits are tried, and of findings of one code."""
_HIDING = frozenset(
    """
    cmake-project-name cmake-unclosed parameters-key parameters-yaml python-syntax
    setup-py-name
    """.split()
)
"""Codes of findings that keep a file, or rules about it, from being read."""


def proven(subject: Subject, found: Sequence[Problem], look: Look) -> list[Problem]:
    """Return findings about a robot, without edits that make nothing better.

    Args:
        subject: the robot.
        found: the findings.
        look: finds the problems of another robot, those of its text too.
    """
    # Only what the files of the model say is known of an edited robot.
    files = _whole([*subject.files, *map(str, subject.robot.files)])
    own = [p for p in found if p.edits and _whole(e.file for e in p.edits) <= files]
    own = [p for p in own if not reveals(p)]
    codes = list(dict.fromkeys(problem.code for problem in own))[:_MOST]
    bad: set[int] = set()
    before = look(subject) if codes else []
    for code in codes:
        of_code = [problem for problem in own if problem.code == code]
        if _is_better(subject, of_code, before, look):
            continue
        alone = of_code[:_MOST] if len(of_code) > 1 else []
        good = [p for p in alone if _is_better(subject, [p], before, look)]
        bad.update(id(problem) for problem in of_code if problem not in good)
    return [replace(p, edits=()) if id(p) in bad else p for p in found]


def lasting(problems: Sequence[Problem], load: Callable[..., Robot]) -> list[Problem]:
    """Return the problems of a model that ROS refuses, without edits in a circle.

    Args:
        problems: why it is refused.
        load: loads the model, with `edited` as for `load_robot`.
    """
    tried = [p for p in problems if p.edits and p.severity == "error"][:_MOST]
    circles = [p for p in tried if _is_taken_back(p, load)]
    return [replace(p, edits=()) if p in circles else p for p in problems]


def _is_taken_back(problem: Problem, load: Callable[..., Robot]) -> bool:
    """Return whether the edits after those of a finding bring its text back."""
    texts = edited_texts(problem.edits)
    if texts is None:
        return False
    with unsaved(texts):
        try:
            after = load(edited=texts).problems
        except RobotError as error:
            after = error.problems
        for edits in (p.edits for p in after if p.code == problem.code and p.edits):
            again = edited_texts(edits)
            if again and again.keys() <= texts.keys():
                break
        else:
            return False
    return all(_on_disk(file) == text for file, text in again.items())


def _on_disk(file: str) -> str | None:
    source = source_of(file)
    return None if source is None else source.text


def _whole(files: Iterable[str]) -> set[str]:
    return set(map(os.path.abspath, files))


def _is_better(
    subject: Subject, tried: Sequence[Problem], before: Sequence[Problem], look: Look
) -> bool:
    better = edited(subject, tuple(edit for p in tried for edit in p.edits))
    if better is None:
        return False
    return not drawback([tried], before, looked_again(look, better))


def drawback(
    tried: Sequence[Sequence[Problem]],
    before: Sequence[Problem],
    after: Sequence[Problem],
    severities: Sequence[Severity] = ("error", "warning"),
) -> str:
    """Return why edits make nothing better; empty when they do.

    Args:
        tried: the findings whose edits are made together, those of a cause each.
        before: all findings without the edits.
        after: all findings with them.
        severities: those of new findings that count.
    """
    every = [problem for problems in tried for problem in problems]
    new = [p for severity in severities for p in _more(before, after, severity)]
    # Another fault of the same element is seen only behind this one, and one of another
    # file that has its own edits may be, too.
    written = {edit.file for p in every for edit in p.edits}
    excused = Counter((p.file, p.line) for p in every)
    caused: list[Problem] = []
    for problem in new:
        excused[where := (problem.file, problem.line)] -= 1
        if excused[where] < 0 and not _is_next(problem, written):
            caused.append(problem)
    if caused and not any(map(reveals, every)):
        return f"it leads to another {caused[0].severity}: {caused[0]}"
    is_there = any(_stays(problems, after) for problems in tried)
    return "the finding stays" if is_there else ""


def _is_next(problem: Problem, written: Collection[str]) -> bool:
    files = {edit.file for edit in problem.edits}
    return bool(files) and files.isdisjoint(written)


def reveals(problem: Problem) -> bool:
    """Return whether a part of the files is not seen because of a finding.

    What is wrong in that part is found only when this is mended.
    """
    return problem.code in _HIDING or problem.code.startswith(("xacro-", "xml-"))


def _stays(tried: Sequence[Problem], after: Sequence[Problem]) -> bool:
    """Return whether all of some findings are still there."""
    left = {_said(problem) for problem in after}
    return all(_said(problem) in left for problem in tried)


def _more(
    before: Sequence[Problem], after: Sequence[Problem], severity: Severity
) -> list[Problem]:
    """Return the findings of a severity whose codes occur more often than before."""
    old = Counter(p.code for p in before if p.severity == severity)
    new = Counter(p.code for p in after if p.severity == severity)
    codes = new - old
    return [p for p in after if p.severity == severity and p.code in codes]


def _said(problem: Problem) -> tuple[str, str | None, int | None, str]:
    # The same may be said of a later line, where each cause is reported once.
    return problem.code, problem.file, problem.line, problem.message
