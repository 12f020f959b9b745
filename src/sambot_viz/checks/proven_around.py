"""Try the edits of findings about packages in memory: keep the good ones.

What is gone after the edit of an earlier finding followed from that, and is dropped.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace

from sambot_viz.checks.proven import drawback
from sambot_viz.errors import SEVERITIES, Edit, Problem

_MOST = 8
"""Maximum number of causes whose edits are tried."""

Again = Callable[[tuple[Edit, ...]], list[Problem] | None]
"""Finds the problems with edits; None where these break a file."""


def proven_around(
    found: Sequence[Problem], before: Sequence[Problem], again: Again
) -> list[Problem]:
    """Return findings about packages, without edits that make nothing better.

    Args:
        found: the findings, in an order with causes first.
        before: these, and those that follow from others.
        again: finds the problems that the edited files have.
    """
    causes: dict[object, list[Problem]] = {}
    for problem in sorted(found, key=lambda p: SEVERITIES.index(p.severity)):
        if problem.edits:
            key = problem.code, problem.place, problem.hint
            causes.setdefault(key, []).append(problem)
    kept, bad = list(found), set[Problem]()
    for cause in list(causes.values())[:_MOST]:
        if cause[0] not in kept:
            continue
        after = again(tuple(dict.fromkeys(e for p in cause for e in p.edits)))
        if after is None or drawback([cause], before, after):
            bad.update(cause)
        else:
            kept = _without_consequences(kept, cause[0], before, after)
    return [replace(p, edits=()) if p in bad else p for p in kept]


def _without_consequences(
    found: Sequence[Problem],
    cause: Problem,
    before: Sequence[Problem],
    after: Sequence[Problem],
) -> list[Problem]:
    """Return findings without those that are gone after the edits of another."""
    there = set(map(_said, after))
    # Edits move lines: what now has other words or another line may still be there.
    others = Counter(_kind(p) for p in after if _said(p) not in set(map(_said, before)))
    gone = {
        p
        for p in before
        if _said(p) not in there and not others[_kind(p)] and not _outranks(p, cause)
    }
    # The same may be said of several robots at one place.
    own = cause.code, cause.place
    return [p for p in found if (p.code, p.place) == own or p not in gone]


def _outranks(problem: Problem, cause: Problem) -> bool:
    """Return whether a warning would go with a remark."""
    return problem.severity != "info" and cause.severity == "info"


def _said(problem: Problem) -> tuple[str, str | None, str]:
    return problem.code, problem.file, problem.message


def _kind(problem: Problem) -> tuple[str, str | None]:
    return problem.code, problem.file
