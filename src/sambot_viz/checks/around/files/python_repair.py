"""Find what stops a Python file in every version of Python, and where to fix it."""

from __future__ import annotations

import ast
import re
import warnings

from sambot_viz.checks.around.files.fault import Fault
from sambot_viz.checks.around.files.line_repairs import line_repairs

_NEWER = re.compile(
    r"\b[fFtT][rR]?[\"']|\b[rR][fFtT][\"']|^\s*(type|match|except)\b|"
    r"(def|class) \w+\["
)
"""Text that only some versions of Python read."""

_NAME_AT_END = re.compile(r"[A-Za-z_][\w.]*$")
_FURTHER = 2
"""An error this number of lines further on is a separate one."""
_MOST_LINES = 200
_COMMA = "a comma is missing at the end of this line"


def fault_in_python(text: str) -> Fault | None:
    """Return what stops Python; None when at least one version may read the file."""
    error = _error(text)
    if error is None or error.lineno is None:
        return None
    lines = text.splitlines()
    last = max(error.end_lineno or 0, error.lineno)
    at = max(1, min(error.lineno, len(lines)))
    if any(_NEWER.search(line) for line in lines[max(at - 2, 0) : last]):
        return None
    comma = _comma(lines, at, last)
    if comma is not None:
        code = lines[comma - 1].partition("#")[0].rstrip()
        return Fault(comma, _COMMA, "add a comma there", f"{code},")
    opened = _opened(lines, at) if "unexpected indent" in error.msg else None
    if opened is not None:
        return opened
    cause = error.msg.removeprefix("invalid syntax. ").rstrip("?.")
    for n, better, said in line_repairs(lines, at, error.msg):
        again = _error("\n".join([*lines[: n - 1], better, *lines[n:]]))
        # A change that only moves the error counts where a change of one more line
        # fixes it.
        if again is None or _is_separate(again, lines, n, better, max(last, n)):
            return Fault(n, said or cause, f"write {better.strip()}", better)
    return Fault(at, cause, _hint(error.msg))


def _is_separate(
    error: SyntaxError, lines: list[str], n: int, better: str, last: int
) -> bool:
    """Return whether a later error has its own repair."""
    at = error.lineno or 0
    if not last + _FURTHER < at <= len(lines):
        return False
    both = [*lines[: n - 1], better, *lines[n:]]
    repairs = line_repairs(both, at, error.msg)
    texts = ("\n".join([*both[: m - 1], b, *both[m:]]) for m, b, _ in repairs)
    return any(_error(text) is None for text in texts)


def _error(text: str) -> SyntaxError | None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ast.parse(text)
    except SyntaxError as error:
        return error
    except (ValueError, RecursionError, MemoryError):
        return None
    return None


def _comma(lines: list[str], first: int, last: int) -> int | None:
    """Return the line after which a comma repairs the file, or None."""
    code = [line.partition("#")[0].rstrip() for line in lines]
    candidates = [n for n in range(max(1, first - 2), last + 1) if code[n - 1]]
    for n in candidates[:_MOST_LINES]:
        if code[n - 1][-1] in ",([{:=":
            continue
        better = [*lines[: n - 1], code[n - 1] + ",", *lines[n:]]
        again = _error("\n".join(better))
        if again is None or (again.lineno or 0) > last:
            return n
    return None


def _opened(lines: list[str], at: int) -> Fault | None:
    """Find a name before an indented line that becomes a call when a ( follows it."""
    n = next((n for n in range(at - 1, 0, -1) if lines[n - 1].strip()), 0)
    name = _NAME_AT_END.search(lines[n - 1]) if n else None
    if name is None:
        return None
    again = _error("\n".join([*lines[: n - 1], lines[n - 1] + "(", *lines[n:]]))
    if again is not None and (again.lineno or 0) <= at:
        return None
    return Fault(n, f"the ( after {name[0]} is missing", f"write {name[0]}(")


def _hint(message: str) -> str:
    if "never closed" in message:
        return "close the bracket"
    if "unterminated" in message:
        return "close the quotation mark"
    if "indent" in message or "tabs" in message:
        return "write as many blanks before it as before its neighbours"
    if "expected ':'" in message:
        return "add a colon at the end of the line"
    return "correct this line or the one above it"
