"""The Problems panel: what is wrong, where, and how to fix it.

It is shown below the tabs at the right while there are problems. After a save with a
mistake, a note says that the robot in the picture is the last good one.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from pathlib import PurePath

import viser

from sambot_viz import problem_text, viser_private
from sambot_viz.errors import Problem, Severity
from sambot_viz.session import Event, Session
from sambot_viz.text import html_text, text

MOST_SHOWN = 60
"""Problems that are written out; the rest is counted."""
SEVERITIES: tuple[Severity, ...] = ("error", "warning", "info")
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
        self._shown: tuple[list[Problem], str] | None = None
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
        problems = problems_of(self._session)
        note = last_good_note(self._session)
        if (problems, note) == self._shown:
            return
        self._shown = (problems, note)
        viser_private.set_tab_label(self._tab, title(problems))
        self._list.content = note + problems_html(problems)
        self._panel.visible = bool(problems)


def problems_of(session: Session) -> list[Problem]:
    """The problems to show, each once, errors first, then in the order of the files.

    While the saved model has a mistake, its problems take the place of those of the
    version that is shown, whose line numbers are out of date.
    """
    saved = session.problems.of_saves
    shapes = (p for display in session.displays for p in display.problems)
    model = saved.get("model", ()) or (*session.problems.of_model, *shapes)
    config = saved.get("config", ()) or session.config.problems
    others = (*saved.get("fault", ()), *saved.get("watch", ()))
    return in_order((*model, *config, *others))


def in_order(problems: Iterable[Problem]) -> list[Problem]:
    """Errors, warnings, infos; of those with the same code and line only the first."""
    once: dict[object, Problem] = {}
    for problem in problems:
        same = problem.message if problem.line is None else ""
        once.setdefault((problem.code, problem.file, problem.line, same), problem)
    return sorted(once.values(), key=lambda p: SEVERITIES.index(p.severity))


def title(problems: Iterable[Problem]) -> str:
    """The label of the tab: "Problems (3)"."""
    count = Counter(problem.severity for problem in problems)
    return f"Problems ({count.total()})" if count else "Problems"


def last_good_note(session: Session) -> str:
    """HTML that says that the picture is older than the file, or nothing."""
    faults = session.problems.of_saves.get("model", ())
    if not any(fault.severity == "error" for fault in faults):
        return ""
    return (
        '<div class="sambot-last-good" role="alert">Showing the last good version: '
        "what was saved has a mistake.</div>"
    )


def problems_html(problems: list[Problem]) -> str:
    """The list as HTML; everything out of files is escaped."""
    parts = [_problem_html(problem) for problem in problems[:MOST_SHOWN]]
    if len(problems) > MOST_SHOWN:
        rest = Counter(problem.severity for problem in problems[MOST_SHOWN:])
        kinds = ", ".join(f"{rest[s]} {_plural(s, rest[s])}" for s in rest)
        parts.append(f'<div class="sambot-note">and {kinds} more</div>')
    return f'<div class="sambot-problems">{"".join(parts)}</div>'


def _problem_html(problem: Problem) -> str:
    lines = [
        f'<div class="sambot-problem sambot-{problem.severity}">'
        f'<div class="sambot-kind"><b>{problem.severity}</b> '
        f"{_place_html(problem)}</div>"
        f"<div>{html_text(problem.message)}</div>"
    ]
    line = problem_text.excerpt(problem)
    if line is not None and line.strip():
        lines.append(f"<pre>{_excerpt_html(line, problem.column)}</pre>")
    if problem.hint:
        lines.append(f'<div class="sambot-hint">{html_text(problem.hint)}</div>')
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
