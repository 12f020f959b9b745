"""The Problems panel: what is wrong, where, and how to fix it.

It is shown below the tabs at the right while there are problems. After a save with a
mistake, a note says that the robot in the picture is the last good one.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from pathlib import PurePath

import viser

from sambot_viz import viser_private
from sambot_viz.errors import Problem
from sambot_viz.problem_groups import ProblemGroup, group_problems
from sambot_viz.problem_text import problem_lines
from sambot_viz.session import Event, Session
from sambot_viz.session.shown_problems import last_good_note, problems_of
from sambot_viz.text import html_text, text

MOST_SHOWN = 60
"""Groups that are written out; the rest is counted."""
_LONGEST_NAME = 60
_LONGEST_EXCERPT = 100
_WORD = re.compile(r"</?[\w:.-]+|[\w:.-]+|\S")


class ProblemsPanel:
    """The problems of a session's model and config, errors first.

    Args:
        session: whose problems these are.
        panel: the panel to fill; it is hidden while there are none.
    """

    def __init__(self, session: Session, panel: viser.PanelHandle) -> None:
        self._session = session
        self._panel = panel
        self._tab = panel.add_tab("Problems")
        self._shown: tuple[list[ProblemGroup], str] | None = None
        with self._tab:
            self._list = session.audience.gui.add_html("")
        session.listeners.append(self._hear)
        self._write()

    def close(self) -> None:
        """Stop following the session."""
        self._session.listeners.remove(self._hear)

    def _hear(self, event: Event) -> None:
        if event in ("problems", "config", "robot", "status"):
            self._write()

    def _write(self) -> None:
        groups = group_problems(problems_of(self._session))
        note = last_good_note(self._session)
        if (groups, note) == self._shown:
            return
        self._shown = (groups, note)
        viser_private.set_tab_label(self._tab, title(groups))
        self._list.content = _note_html(note) + problems_html(groups)
        self._panel.visible = bool(groups)


def title(groups: Sequence[ProblemGroup]) -> str:
    """The label of the tab: "Problems (3)"."""
    return f"Problems ({len(groups)})" if groups else "Problems"


def _note_html(note: str) -> str:
    if not note:
        return ""
    return f'<div class="sambot-last-good" role="alert">{html_text(note)}</div>'


def problems_html(groups: Sequence[ProblemGroup]) -> str:
    """The list as HTML; everything out of files is escaped."""
    parts = [_group_html(group) for group in groups[:MOST_SHOWN]]
    if len(groups) > MOST_SHOWN:
        rest = Counter(group.severity for group in groups[MOST_SHOWN:])
        kinds = ", ".join(f"{rest[s]} {_plural(s, rest[s])}" for s in rest)
        parts.append(f'<div class="sambot-note">and {kinds} more</div>')
    return f'<div class="sambot-problems">{"".join(parts)}</div>'


def _group_html(group: ProblemGroup) -> str:
    problem = group.first
    lines = [
        f'<div class="sambot-problem sambot-{group.severity}">'
        f'<div class="sambot-kind"><b>{group.severity}</b> '
        f"{_place_html(problem)}</div>"
        f"<div>{html_text(group.message)}</div>"
    ]
    for _, line in problem_lines(problem, context=0):
        if line.strip():
            lines.append(f"<pre>{_excerpt_html(line, problem.column)}</pre>")
    if group.hint:
        lines.append(f'<div class="sambot-hint">{html_text(group.hint)}</div>')
    lines.append("</div>")
    return "".join(lines)


def _place_html(problem: Problem) -> str:
    """The place as "file:line:column"; a mouse that rests on it sees the whole path."""
    if problem.file is None:
        return ""
    name = text(PurePath(problem.file).name, _LONGEST_NAME)
    numbers = (n for n in (problem.line, problem.column) if n is not None)
    place = ":".join((name, *map(str, numbers)))
    return (
        f'<span class="sambot-place" title="{html_text(problem.place)}">'
        f"{html_text(place)}</span>"
    )


def _excerpt_html(line: str, column: int | None) -> str:
    """The part of a line around a column, the word that begins there underlined."""
    at = 0 if column is None else min(column - 1, len(line))
    start = max(len(line) - len(line.lstrip()), at - _LONGEST_EXCERPT // 2)
    end = start + _LONGEST_EXCERPT
    word = _WORD.match(line, at)
    length = 0 if column is None or word is None else len(word.group())
    before, marked, after = line[start:at], line[at : at + length], line[at + length :]
    after = after[: max(0, end - at - length)]
    return (
        ("…" if line[:start].strip() else "")
        + html_text(before)
        + (f"<u>{html_text(marked)}</u>" if marked else "")
        + html_text(after)
        + ("…" if end < len(line) else "")
    )


def _plural(severity: str, count: int) -> str:
    return severity if count == 1 else f"{severity}s"
