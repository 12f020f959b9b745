"""Problems as the editor of a page marks them in a text."""

from __future__ import annotations

import hashlib

from sambot_viz.edits import Extent, SourceFile
from sambot_viz.errors import Edit, Place, Problem, hint_sentence
from sambot_viz.panels.problems.problems_panel import without_folders
from sambot_viz.panels.rows.row import Json
from sambot_viz.session.editor.file_text import to_units


def marked(
    problem: Problem, source: SourceFile, *, folders: bool, can_fix: bool
) -> Json:
    """Return a problem for the editor; places are in UTF-16 units.

    Args:
        problem: it is in this text.
        source: the text.
        folders: whether messages may name folders of the server.
        can_fix: whether its edits can be made.
    """
    start, end = _extent(problem, source)
    words, hint = problem.message, hint_sentence(problem.hint)
    if not folders:
        words, hint = (str(without_folders(said)) for said in (words, hint))
    return {
        "id": problem_id(problem),
        "from": to_units(source.text, start),
        "to": to_units(source.text, end),
        "severity": problem.severity,
        "message": words,
        "hint": hint,
        "edits": _edits(problem, source),
        "fix": can_fix,
    }


def problem_id(problem: Problem) -> str:
    """Return a name of a problem, the same as long as it is there."""
    said = repr((problem.place, problem.code, problem.message))
    return hashlib.blake2s(said.encode("utf-8", "replace"), digest_size=8).hexdigest()


def _edits(problem: Problem, source: SourceFile) -> Json:
    """Return the edits of a problem in this text; None where it has others."""
    edits, here = problem.edits, hash(source.text)
    if not edits or any(edit.seen != here for edit in edits):
        return None
    return [
        [to_units(source.text, e.start), to_units(source.text, e.end), e.text]
        for e in sorted(set(edits), key=_start)
    ]


def _start(edit: Edit) -> tuple[int, int]:
    return edit.start, edit.end


def _extent(problem: Problem, source: SourceFile) -> Extent:
    """Return what is marked: what a fix replaces, the name of a tag, or a line."""
    here = hash(source.text)
    place = Place(problem.file or "", problem.line or 1, problem.column)
    start = min(source.offset(place), len(source.text))
    begin = source.offset(Place(place.file, place.line))
    for edit in problem.edits:
        # A fix may change lines before, too.
        if edit.seen == here and edit.end > edit.start >= begin:
            return Extent(edit.start, edit.end)
    tag = source.tag(start)
    if tag is not None:
        return Extent(start, tag.name.end)
    line = source.text[start:].partition("\n")[0]
    return Extent(start, start + len(line.rstrip()))
