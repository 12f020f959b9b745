"""Reports misspelt names first, and suppresses problems that only follow from them.

This module corrects the names one by one in a copy of the document, and reads it again
each time: a problem that vanishes with a name was a consequence of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from dataclasses import dataclass

from sambot_viz.errors import Problem, Severity
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.slips.misspelt import CALL, Slip
from sambot_viz.robot.slips.slip_words import slip_in_words
from sambot_viz.robot.xml.element import Element

Read = Callable[[Element, ModelFindings], object]
"""Reads a document again, without a search for files."""

_MOST = 20
"""Number of single corrections; all further ones happen at once."""

_Key = tuple[str, str | None, int | None]


def report_slips(
    document: Element, slips: Sequence[Slip], findings: ModelFindings, read: Read
) -> None:
    """Add the misspelt names of a document to its problems, in place of follow-ups.

    Args:
        document: root element, which stays unchanged.
        slips: its misspelt names and misplaced elements, in document order.
        findings: findings in it, which change.
        read: finds the problems of a corrected document.
    """
    copies = _copied(document)
    corrected = copies[id(document)]
    before = first = _reading(corrected, read, frozenset())
    reports, excused = ModelFindings(), set[tuple[str, int]]()
    groups = list(_by_place(slips))
    for number, group in enumerate(groups, 1):
        for slip in group:
            _correct(slip, copies)
            excused |= _excused(slip)
        if _MOST < number < len(groups):
            continue
        after = _reading(corrected, read, excused)
        # ROS never reports a problem that only appears with another correction.
        gone: list[Severity] = [
            found
            for key, found in before.found.items()
            if key in first.found and key not in after.found
        ]
        refused = first.rejected and before.rejected and not after.rejected
        for done in groups[_MOST:] if number > _MOST else [group]:
            _report(done[0], reports, gone, refused)
        before = after
    hidden = first.found.keys() - before.found.keys()
    kept = [problem for problem in findings.problems if _key(problem) not in hidden]
    findings.problems[:] = [*reports.problems, *kept]


@dataclass(frozen=True, slots=True)
class _Reading:
    """The problems of a document, and whether ROS refuses it."""

    found: dict[_Key, Severity]
    rejected: bool


def _reading(document: Element, read: Read, excused: Set[tuple[str, int]]) -> _Reading:
    findings = ModelFindings()
    read(document, findings)
    found: dict[_Key, Severity] = {}
    for problem in findings.problems:
        if (problem.file, problem.line) not in excused:
            found[_key(problem)] = problem.severity
    return _Reading(found, findings.rejected)


def _excused(slip: Slip) -> set[tuple[str, int]]:
    """Return the place whose problems a macro may solve once it is called."""
    parent = slip.element.parent
    if parent is None or not slip.right.startswith(CALL):
        return set()
    return {(parent.place.file, parent.place.line)}


def _key(problem: Problem) -> _Key:
    return (problem.code, problem.file, problem.line)


def _report(
    slip: Slip, reports: ModelFindings, gone: Iterable[Severity], refused: bool
) -> None:
    words = slip_in_words(slip, refused)
    report = reports.error if "error" in gone else reports.warn
    report(words.code, words.message, words.hint, slip.element, slip.attribute)


def _by_place(slips: Iterable[Slip]) -> Iterator[list[Slip]]:
    """Yield slips with the same source together: a macro repeats its mistakes."""
    groups: dict[tuple[object, ...], list[Slip]] = {}
    for slip in slips:
        key = (slip.element.place, slip.attribute, slip.right)
        groups.setdefault(key, []).append(slip)
    yield from groups.values()


def _copied(document: Element) -> dict[int, Element]:
    """Copy a tree; return the copy of each element by the `id` of the original."""
    copies: dict[int, Element] = {}
    for element in document.iter():
        copy = Element(
            element.tag,
            dict(element.attributes),
            element.place,
            text=element.text,
            attribute_lines=element.attribute_lines,
            odd_blanks=element.odd_blanks,
            call=element.call,
        )
        copies[id(element)] = copy
        if element.parent is not None and id(element.parent) in copies:
            copy.parent = copies[id(element.parent)]
            copy.parent.children.append(copy)
    return copies


def _correct(slip: Slip, copies: dict[int, Element]) -> None:
    """Correct one slip in the copy."""
    element = copies[id(slip.element)]
    if slip.attribute is not None:
        element.attributes[slip.right] = element.attributes.pop(slip.attribute)
    elif not slip.parents:
        element.tag = slip.right
    elif slip.target is not None:
        for moved in (slip.element, *slip.behind):
            _move(copies[id(moved)], copies[id(slip.target)])
    else:
        _surround(element, slip.around)
        for other in slip.behind:
            if element.parent is not None:
                _move(copies[id(other)], element.parent)


def _move(element: Element, target: Element) -> None:
    if element.parent is not None:
        element.parent.children.remove(element)
    element.parent = target
    target.children.append(element)


def _surround(element: Element, tags: Iterable[str]) -> None:
    """Put new elements around one, outermost first."""
    for tag in tags:
        parent = element.parent
        if parent is None:
            return
        new = Element(tag, {}, element.place, parent=parent)
        parent.children[parent.children.index(element)] = new
        element.parent = new
        new.children.append(element)
