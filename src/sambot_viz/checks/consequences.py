"""Drop consequences of a finding: read the model again with its edits, in memory.

A finding that then disappears or changes was a consequence, and the check drops it.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace

from sambot_viz.checks.rule import Subject
from sambot_viz.edits import apply_edits, by_file, source_of
from sambot_viz.errors import Edit, Problem, RobotError
from sambot_viz.unsaved import unsaved

_MOST = 3
"""Maximum number of times to read a model again."""

Look = Callable[[Subject], list[Problem]]
"""Finds the problems of a robot."""


def without_consequences(
    subject: Subject, found: Sequence[Problem], look: Look
) -> list[Problem]:
    """Return findings without those that follow from an earlier one.

    Args:
        subject: the robot, with the problems of its text, which are the first causes.
        found: the findings of rules, in an order with causes first.
        look: applies the rules to another robot.
    """
    kept, looked = list(found), 0
    causes = [*subject.robot.problems, *kept]
    for code in dict.fromkeys(cause.code for cause in causes if cause.edits):
        own = [cause for cause in causes if cause.code == code]
        known = {p.code for p in (*subject.robot.problems, *kept)}
        if looked == _MOST or code not in known or all(p.code == code for p in kept):
            continue
        looked += 1
        better = edited(subject, tuple(e for cause in own for e in cause.edits))
        if better is None:
            continue
        again = looked_again(look, better)
        there = {_where(p) for p in (*again, *better.robot.problems)}
        if not there.isdisjoint(map(_where, own)):
            # The edits do not repair it, so it has no consequences.
            continue
        # A finding that then has other words and numbers waits for that repair.
        after = {(_where(p), p.message) for p in again}
        after |= {(_where(p), p.message) for p in kept if _outranks(p, own)}
        kept = [p for p in kept if p.code == code or (_where(p), p.message) in after]
    return kept


def _outranks(problem: Problem, causes: Sequence[Problem]) -> bool:
    """Return whether a warning would go with a remark about the text."""
    return problem.severity != "info" and all(p.severity == "info" for p in causes)


def edited(subject: Subject, edits: tuple[Edit, ...]) -> Subject | None:
    """Return the edited robot; None where the edits break it."""
    if edits not in subject.edited:
        subject.edited[edits] = _read_again(subject, edits)
    return subject.edited[edits]


def looked_again(look: Look, better: Subject) -> list[Problem]:
    """Find the problems of an edited robot; their places are in its edited files."""
    with unsaved(better.texts):
        return look(better)


def _read_again(subject: Subject, edits: tuple[Edit, ...]) -> Subject | None:
    texts = edited_texts(edits)
    if texts is None:
        return None
    try:
        with unsaved(texts):
            robot = subject.robot.edited and subject.robot.edited(texts)
    except RobotError:
        return None
    return replace(subject, robot=robot, edited={}, texts=texts) if robot else None


def edited_texts(edits: Sequence[Edit]) -> dict[str, str] | None:
    """Return whole path of a file → its text with edits; None where they overlap."""
    texts: dict[str, str] = {}
    for file, own in by_file(edits).items():
        source = source_of(file)
        if source is None:
            return None
        try:
            texts[os.path.abspath(file)] = apply_edits(own, source.text)
        except ValueError:
            return None
    return texts


def _where(problem: Problem) -> tuple[str, str | None, int | None]:
    return problem.code, problem.file, problem.line
