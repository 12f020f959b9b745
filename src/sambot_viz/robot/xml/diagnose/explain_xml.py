"""From expat's "not well-formed" to the cause and its mend (spec/ros-nodes.md §6.7)."""

from __future__ import annotations

from typing import Protocol

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.lexer import SlipKind, Token
from sambot_viz.robot.xml.diagnose.lexical import SAYINGS
from sambot_viz.robot.xml.diagnose.prolog import prolog_problems, whole_file_problem
from sambot_viz.robot.xml.diagnose.source_text import SourceText
from sambot_viz.robot.xml.diagnose.structure import structure_problems

_MOST = 12
"""More findings than this come from one cause; the rest would bury it."""

_KNOWN_PREFIXES = {"xacro": "http://www.ros.org/wiki/xacro"}

_MISLEADING: frozenset[SlipKind] = frozenset(
    {"quote-not-closed", "comment-not-closed", "comment-nested", "tag-not-ended"}
)
"""Behind these it is a guess where the text goes on: nothing later is told."""


class Fault(Protocol):
    """What expat said: `message`, and the place counted from 1."""

    @property
    def message(self) -> str:
        """Expat's own text."""
        ...

    @property
    def line(self) -> int:
        """Line, counted from 1."""
        ...

    @property
    def column(self) -> int:
        """Column, counted from 1."""
        ...


def explain_xml(text: str, file: str, fault: Fault) -> list[Problem]:
    """Find the cause of an XML error, not its symptom.

    Args:
        text: the file as text; bytes that are no UTF-8 may stand in it as U+FFFD
            or as lone surrogates.
        file: the path as the user wrote it.
        fault: what expat said about it.

    Returns:
        One or more problems of severity "error", in document order, each with a
        line and a mend. Never empty.
    """
    source = SourceText(text.replace("\r\n", "\n"))
    whole = whole_file_problem(source, file)
    if whole is not None:
        return [whole]
    problems = prolog_problems(source, file) + _slip_problems(source, file)
    if not any(slip.kind in _MISLEADING for slip in source.slips):
        problems += structure_problems(source, file)
    problems += _prefix_problems(source, file)
    if not problems:
        problems = [_plain(fault, file)]
    return sorted(problems, key=lambda p: p.line or 0)[:_MOST]


def _plain(fault: Fault, file: str) -> Problem:
    known = (row for row in _FROM_EXPAT if fault.message.startswith(row[0]))
    _, code, message, hint = next(known, _UNKNOWN)
    message = message.format(fault.message, fault.line)
    return Problem("error", code, message, hint, file, fault.line, fault.column)


_FROM_EXPAT = (
    (
        "unknown encoding",
        "xml-encoding",
        "the first line names an encoding that does not exist ({})",
        'save the file as UTF-8 and write <?xml version="1.0"?>',
    ),
    (
        "bytes that are not",
        "xml-encoding",
        "the file is not in the encoding that its first line names ({})",
        'save the file as UTF-8 and write <?xml version="1.0"?>',
    ),
    (
        "external entities",
        "xml-external-entity",
        "the document type would read other files, which is not done",
        "delete <!DOCTYPE …> and write the content itself, or use xacro:include",
    ),
    (
        "limit on input amplification",
        "xml-external-entity",
        "the entities of the document type grow without end, which is not done",
        "delete <!DOCTYPE …>",
    ),
)
"""Faults that expat or the reader names well enough: (beginning, code, what, mend)."""

_UNKNOWN = (
    "",
    "xml-not-well-formed",
    "this is no XML from line {1} on ({0})",
    "look at this line and the one before it: every tag closed, every value in quotes",
)


def _slip_problems(source: SourceText, file: str) -> list[Problem]:
    problems: list[Problem] = []
    for slip in source.slips:
        message, hint = SAYINGS[slip.kind](source, slip)
        line, column = source.line(slip.offset), source.column(slip.offset)
        code = f"xml-{slip.kind}"
        problems.append(Problem("error", code, message, hint, file, line, column))
        if slip.kind in _MISLEADING:
            break
    return problems


def _prefix_problems(source: SourceText, file: str) -> list[Problem]:
    """Prefixes that are used but declared nowhere."""
    opened = [t for t in source.tags if not t.closes]
    robots = [t.closes for t in source.tags if t.name == "robot"]
    if not opened or (robots and all(robots)):
        # Without its root the declarations are lost too; that is told already.
        return []
    known = {"xml", "xmlns"} | {
        a.name[6:] for t in opened for a in t.attributes if a.name.startswith("xmlns:")
    }
    root = opened[0]
    problems: list[Problem] = []
    for token in opened:
        for name in (token.name, *(a.name for a in token.attributes)):
            prefix = name.partition(":")[0] if ":" in name else ""
            if prefix and prefix not in known:
                known.add(prefix)
                problems.append(_prefix_problem(source, file, root, token, name))
    return problems


def _prefix_problem(
    source: SourceText, file: str, root: Token, token: Token, name: str
) -> Problem:
    prefix = name.partition(":")[0]
    address = _KNOWN_PREFIXES.get(prefix, f"http://example.org/{prefix}")
    line = source.line(root.start)
    where = source.line(token.start)
    return Problem(
        "error",
        "xml-prefix-undeclared",
        f"the prefix {prefix}: is used (first by {name} on line {where}) but not "
        f"declared on <{root.name}>",
        f'add xmlns:{prefix}="{address}" to <{root.name}> on line {line}',
        file,
        line,
        source.column(root.start),
    )
