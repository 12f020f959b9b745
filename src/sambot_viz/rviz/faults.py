"""From YAML's complaint to the cause and its mend, and files that are no .rviz."""

from __future__ import annotations

import re
from typing import Any

import yaml

from sambot_viz.errors import Problem
from sambot_viz.rviz.parser import ParseFault

_INI_LINE = re.compile(r"(?m)^(?:[^\s:=#\[]|\\ )+=")
_TAB_INDENT = re.compile(r"^ *\t")
_GENERAL = "look at this line and the one above: the same indentation for all keys of \
one map, spaces only, 'key: value' with a blank behind the colon"


def other_format(text: str, file: str | None) -> Problem | None:
    """The problem of a file that is something else than YAML, by its look."""
    start = text.lstrip()
    if start.startswith("<"):
        what = "a robot model" if "<robot" in text else "XML"
        return Problem(
            "error",
            "config-is-xml",
            f"this is {what}, not a display config",
            "give an .rviz file as the config, and the URDF or xacro file as the model",
            file,
            1,
        )
    lines = [line for line in text.splitlines() if line.strip()]
    if lines and 2 * len(_INI_LINE.findall(text)) > len(lines):
        return Problem(
            "error",
            "config-is-vcg",
            "this is a config of RViz before 1.9 (.vcg, lines of 'name=value'), which "
            "today's RViz cannot read either",
            "set the displays up anew and save an .rviz file",
            file,
            1,
        )
    return None


def explain_yaml(
    text: str, error: yaml.YAMLError | ParseFault, file: str | None
) -> Problem:
    """The cause of a YAML error, with its line and a mend.

    Args:
        text: the file.
        error: what the reader said.
        file: the path as the user wrote it.

    Returns:
        A problem of severity "error". RViz itself shows nothing at all in this case
        (spec/rviz-core.md §12, 15).
    """
    line, column, said = _place(text, error)
    lines = text.splitlines()
    message, hint = _cause(lines, line, said)
    return Problem("error", "config-yaml", message, hint, file, line, column)


def _place(text: str, error: Any) -> tuple[int, int, str]:
    if isinstance(error, ParseFault):
        return error.line, error.column, error.reason
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    said = " ".join(
        str(part)
        for part in (getattr(error, "context", None), getattr(error, "problem", None))
        if part
    )
    if mark is not None:
        return mark.line + 1, mark.column + 1, said
    position = getattr(error, "position", 0)
    before = text[: position if isinstance(position, int) else 0]
    reason = str(getattr(error, "reason", "") or error)
    return before.count("\n") + 1, len(before) - before.rfind("\n"), reason


def _cause(lines: list[str], line: int, said: str) -> tuple[str, str]:
    here = lines[line - 1] if 0 < line <= len(lines) else ""
    if _TAB_INDENT.match(here) or "found a tab" in said:
        return (
            "this line is indented with a tab, which YAML does not allow",
            "indent with spaces only",
        )
    if "quoted scalar" in said:
        return (
            "a text in quotes that begins here or above is never closed",
            "close it with the same kind of quote",
        )
    if "flow" in said:
        return (
            "a list in [ ] or a map in { } that begins here or above is not closed, or "
            "a comma is missing in it",
            "close it, and put a comma between its parts",
        )
    if "not allowed in this context" in said:
        return (
            "a key stands where none can stand: there is a second colon in the line "
            "above or in this one, or the line is indented too far",
            "put quotes around a value that contains ': ', or indent the line like "
            "the keys around it",
        )
    if "expected key" in said or "expected <block end>" in said:
        return (
            "the indentation does not fit: this line belongs to no map or list above",
            "indent it exactly like the other keys of its map",
        )
    if "special characters" in said or "control characters" in said:
        return "there is a character that YAML does not allow", "remove it"
    if "could not find expected ':'" in said:
        return "this or the line above is no 'key: value'", _GENERAL
    return f"this is no YAML: {said}", _GENERAL
