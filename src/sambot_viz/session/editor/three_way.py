"""Merge two changes of one text, line by line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from difflib import SequenceMatcher
from typing import NamedTuple


class Segment(NamedTuple):
    """A part of three texts: lines that are alike, or were changed together.

    Attributes:
        base: before both changes.
        mine: after one of them.
        theirs: after the other one.
    """

    base: str
    mine: str
    theirs: str

    @property
    def is_conflict(self) -> bool:
        """Whether both have changed it, and not alike."""
        return self.mine not in (self.base, self.theirs) and self.theirs != self.base

    @property
    def merged(self) -> str:
        """The text with both changes; mine where they are in conflict."""
        return self.theirs if self.mine == self.base else self.mine


class _Hunk(NamedTuple):
    """Lines that replace those of the base from `start` to `end`."""

    start: int
    end: int
    side: int
    lines: Sequence[str]


def segments(base: str, mine: str, theirs: str) -> Iterator[Segment]:
    """Yield the parts of three texts in their order.

    Changes of neighbouring lines are parts of their own: each line is, where as many
    lines take the place of some. Lines that both have added at the same place are one
    part.

    Args:
        base: the text before both changes.
        mine: the text after one of them.
        theirs: the text after the other one.
    """
    lines, at = base.splitlines(keepends=True), 0
    hunks = sorted((*_hunks(lines, mine, 0), *_hunks(lines, theirs, 1)))
    for group in _together(hunks):
        start, end = group[0].start, max(hunk.end for hunk in group)
        yield _alike(lines[at:start])
        sides = (_applied(lines, start, end, group, side) for side in (0, 1))
        yield Segment("".join(lines[start:end]), *sides)
        at = end
    yield _alike(lines[at:])


def _hunks(lines: Sequence[str], text: str, side: int) -> Iterator[_Hunk]:
    changed = text.splitlines(keepends=True)
    matcher = SequenceMatcher(None, lines, changed)
    for kind, start, end, first, last in matcher.get_opcodes():
        if kind == "replace" and end - start == last - first:
            for line, new in enumerate(changed[first:last], start):
                yield _Hunk(line, line + 1, side, [new])
        elif kind != "equal":
            yield _Hunk(start, end, side, changed[first:last])


def _together(hunks: Iterable[_Hunk]) -> Iterator[list[_Hunk]]:
    """Group the hunks that change the same lines, or add lines at the same place."""
    group: list[_Hunk] = []
    end = 0
    for hunk in hunks:
        if group and hunk.start >= end and not any(_meet(one, hunk) for one in group):
            yield group
            group = []
        end = max(end, hunk.end) if group else hunk.end
        group.append(hunk)
    if group:
        yield group


def _meet(one: _Hunk, other: _Hunk) -> bool:
    """Tell whether lines cannot be in their order: one place, or no end of a line."""
    ends = not one.lines or one.lines[-1].endswith("\n")
    return one[:2] == other[:2] or not ends


def _applied(
    lines: Sequence[str], start: int, end: int, group: Iterable[_Hunk], side: int
) -> str:
    made: list[str] = []
    for hunk in group:
        if hunk.side == side:
            made += *lines[start : hunk.start], *hunk.lines
            start = hunk.end
    return "".join([*made, *lines[start:end]])


def _alike(lines: Iterable[str]) -> Segment:
    text = "".join(lines)
    return Segment(text, text, text)
