"""Propose corrected lines of Python, where one line stops the file."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.robot.slips.vocabulary import meant

Repair = tuple[int, str, str]
"""A line from 1, its replacement, and the fault; "" for the message of Python."""

_WORDS = (
    *("def", "class", "return", "import", "from", "if", "elif", "else", "for", "while"),
    *("with", "try", "except", "finally", "raise", "assert", "pass", "async", "global"),
)
_OTHER_LANGUAGES = {"function": "def", "func": "def", "fn": "def", "elseif": "elif"}
_CLOSES = {"(": ")", "[": "]", "{": "}"}
_DOES_NOT_MATCH = re.compile(
    r"'([)\]}])' does not match opening parenthesis '([(\[{])'"
)
_OPENS = {closing: opening for opening, closing in _CLOSES.items()}
_CURLY = str.maketrans("\u201c\u201d\u2018\u2019", "\"\"''")

_TEXTS: tuple[tuple[str, str, str], ...] = (
    (r"\(:\s*$", "():", "the ) before the : is missing"),
    (r"(?<!:)\s*$", ":", "the : at the end is missing"),
    (r"^(\s*)import (\w+) from ([\w.]+)", r"\1from \3 import \2", "from comes first"),
    (r"""(["'])([^"']*)["']""", r"\1\2\1", "the quotation marks differ"),
    (r"""(["'])([^"']*?)([\s,)\]}]*)$""", r"\1\2\1\3", "a quotation mark is missing"),
    (r"""([(\[{=,]\s*)([\w./-]+)(["'])""", r"\1\3\2\3", "a quotation mark is missing"),
    (r"(\w)-(?=[\w-]*\s*=[^=])", r"\1_", "a name has no -"),
    (r"^(\s*\w+)\s*:\s*(?=\S)", r"\1=", "an argument has = behind its name"),
    (r"""(["'][\w/.]+["'])\s*=\s*""", r"\1: ", "a key has a : behind it"),
    (
        r"""(["'][\w/.]+["'])\s+(?=[\w"'\[({])""",
        r"\1: ",
        "a key has a : behind it",
    ),
    (r"""\[((?=["'][\w/]+["']\s*:).*)\]""", r"[{\1}]", "a : is in square brackets"),
    (r"=\s*=(?=[^=])", "=", "one = is too many"),
)
"""A pattern, the replacement of one of its matches, and the fault."""


def line_repairs(lines: list[str], at: int, message: str) -> Iterator[Repair]:
    """Yield corrections of the line of an error, or of one before it.

    Args:
        lines: of the file.
        at: the line that Python names, from 1.
        message: the message of Python.
    """
    before = next((n for n in range(at - 1, 0, -1) if lines[n - 1].strip()), at)
    opened = re.search(r"on line (\d+)", message)
    places = dict.fromkeys((at, before, int(opened[1]) if opened else at))
    for n in places:
        yield from _word(lines, n)
        straight = lines[n - 1].translate(_CURLY)
        if straight != lines[n - 1]:
            yield n, straight, "quotation marks of a text processor are none here"
    if "indent" in message or "tabs" in message:
        yield from _indents(lines, at, before)
    for n in places:
        for pattern, right, cause in _TEXTS:
            for found in re.finditer(pattern, lines[n - 1]):
                start, end = found.span()
                new = found.expand(right)
                yield n, lines[n - 1][:start] + new + lines[n - 1][end:], cause
    for n in reversed(places):
        yield from _brackets(lines, n, message)


def _word(lines: list[str], n: int) -> Iterator[Repair]:
    """Yield the line with another word at its beginning."""
    first = re.match(r"(\s*)([A-Za-z]+)\b", lines[n - 1])
    if first is None or first[2] in _WORDS:
        return
    right = _OTHER_LANGUAGES.get(first[2]) or meant(first[2], _WORDS)
    if right is not None:
        rest = lines[n - 1][first.end() :]
        yield n, f"{first[1]}{right}{rest}", f"{first[2]} is not a word of Python"


def _indents(lines: list[str], at: int, before: int) -> Iterator[Repair]:
    """Yield the line with the indentation of the lines near it."""
    near = [n for n in (before, at + 1, before - 1) if 0 < n <= len(lines)]
    cause = "the line has other blanks before it than its neighbours"
    for n in near:
        blanks = lines[n - 1][: len(lines[n - 1]) - len(lines[n - 1].lstrip())]
        for line in (at, before):
            if lines[line - 1].strip() and "\t" not in blanks:
                yield line, blanks + lines[line - 1].lstrip(), cause
                yield line, blanks + "    " + lines[line - 1].lstrip(), cause


def _brackets(lines: list[str], n: int, message: str) -> Iterator[Repair]:
    """Yield the line with one bracket added, removed or replaced."""
    line, following = lines[n - 1], "".join(lines[n : n + 1]).lstrip()
    said = _DOES_NOT_MATCH.search(message)
    closing = (_CLOSES[said[2]],) if said else tuple(_CLOSES.values())
    code = line.rstrip()
    body = code.rstrip(",)]}:")
    comma = "" if following[:1] in ("", *_OPENS) or code.endswith(",") else ","
    for wanted in closing:
        for end in range(len(body), len(code) + 1):
            cause = f"a {wanted} is missing"
            yield n, code[:end] + wanted + code[end:] + comma, cause
    for found in re.finditer(r"[)\]}]", line):
        for wanted in closing:
            if found[0] != wanted:
                cause = f"{found[0]} is where {wanted} belongs"
                yield n, line[: found.start()] + wanted + line[found.end() :], cause
    if said:
        for found in re.finditer(re.escape(said[2]), line):
            right, cause = (
                _OPENS[said[1]],
                f"{said[2]} is where {_OPENS[said[1]]} belongs",
            )
            yield n, line[: found.start()] + right + line[found.end() :], cause
    if said or "unmatched" in message:
        for found in re.finditer(r"[)\]}]", line):
            cause = f"one {found[0]} is too many"
            yield n, line[: found.start()] + line[found.end() :], cause
