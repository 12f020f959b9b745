"""Explain why a text is not YAML, or not an .rviz file, and how to fix it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple, cast

import yaml

from sambot_viz.edits import write_between
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.rviz.yaml.parser import ParseFault, parse

_INI_LINE = re.compile(r"(?m)^(?:[^\s:=#\[]|\\ )+=")
_TAB_INDENT = re.compile(r"^ *\t")
_PAIR = re.compile(r":(?:\s|$)")
_MERGE_LINE = re.compile(r"(?m)^(?:<<<<<<<|>>>>>>>)(?: |$)")
_GENERAL = (
    "look at this line and the one above: all keys of one map are indented alike, with "
    "spaces only, and every colon is followed by a blank"
)


def other_format(text: str, file: str | None) -> Problem | None:
    """Return the problem of a file that is something else than YAML, by its look."""
    merge = _MERGE_LINE.search(text)
    if merge:
        return Problem(
            "error",
            "config-merge",
            "this line is the mark of a merge that is not finished",
            "choose one of the two texts and remove the marks",
            file,
            text.count("\n", 0, merge.start()) + 1,
        )
    start = text.lstrip()
    if start.startswith("<"):
        is_model = "<robot" in text or "<sdf" in text
        what = "a robot model" if is_model else "XML"
        return Problem(
            "error",
            "config-is-xml",
            f"this is {what}, not a display config",
            "give an .rviz file as the config, and the file of the robot as the model",
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
            "set the displays up again and save an .rviz file",
            file,
            1,
        )
    return None


def explain_yaml(
    text: str, error: yaml.YAMLError | ParseFault, file: str | None
) -> Problem:
    """Return the cause of a YAML error, with its line and a fix.

    Args:
        text: the file.
        error: what the reader said.
        file: the path as the user wrote it.

    Returns:
        A problem of severity "error". RViz itself shows nothing at all in this case.
    """
    slip = _Slip(text, error)
    cause = slip.cause()
    fix = Fix(cause.hint)
    right = slip.right_indent()
    if right is not None:
        message = "the indentation of this line is one blank off the others"
        column = len(_indent(slip.lines[slip.line - 1])) + 1
        cause = _YamlCause(
            slip.line, column, message, f"write {right} blanks before it"
        )
        fix = Fix(cause.hint)
        if file is not None:
            start, end = Place(file, slip.line, 1), Place(file, slip.line, column)
            fix = write_between(start, end, " " * right, cause.hint)
    problem = Problem.at(file, "error", "config-yaml", cause.message, fix)
    return replace(problem, line=cause.line, column=cause.column)


def _indent(line: str) -> str:
    return line[: len(line) - len(line.lstrip(" "))]


def _last_open(lines: Sequence[str]) -> tuple[int, int] | None:
    """Return line and column of the innermost bracket or brace that is not closed."""
    opened: list[tuple[int, int]] = []
    begins = (yaml.FlowSequenceStartToken, yaml.FlowMappingStartToken)
    ends = (yaml.FlowSequenceEndToken, yaml.FlowMappingEndToken)
    with suppress(yaml.YAMLError):
        scan = cast("Callable[[str], Iterator[Any]]", yaml.scan)  # pyright: ignore[reportUnknownMemberType]
        for token in scan("\n".join(lines)):
            if isinstance(token, begins):
                opened.append((token.start_mark.line + 1, token.start_mark.column + 1))
            elif isinstance(token, ends) and opened:
                opened.pop()
    return opened[-1] if opened else None


class _YamlCause(NamedTuple):
    line: int
    column: int | None
    message: str
    hint: str


class _Slip:
    """An error of the YAML reader, with its place and the lines around it."""

    def __init__(self, text: str, error: Any):
        self.lines = text.splitlines() or [""]
        said = [getattr(error, name, None) for name in ("context", "problem", "reason")]
        self.said = " ".join(str(part) for part in said if part) or str(error)
        self.line, self.column = self._place(text, error)
        began = getattr(error, "context_mark", None)
        self.began = (began.line + 1, began.column + 1) if began is not None else None
        self.refused = error if isinstance(error, ParseFault) else None

    def _place(self, text: str, error: Any) -> tuple[int, int | None]:
        if isinstance(error, ParseFault):
            return error.line, error.column
        mark = getattr(error, "problem_mark", None)
        mark = mark or getattr(error, "context_mark", None)
        if mark is not None:
            line, column = mark.line + 1, mark.column + 1
        else:
            position = getattr(error, "position", 0)
            before = text[: position if isinstance(position, int) else 0]
            line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        if line > len(self.lines):
            # The end of the file is after its last line.
            return len(self.lines), None
        return line, column

    def cause(self) -> _YamlCause:
        here = self.lines[self.line - 1]
        if self.refused:
            return self._at_place(self.said, self.refused.remedy)
        if _TAB_INDENT.match(here) or "found a tab" in self.said:
            message = "this line is indented with a tab, which YAML does not allow"
            return self._at_place(message, "indent with spaces only")
        if "unknown escape" in self.said:
            message = "a backslash in double quotes begins an escape YAML does not know"
            return self._at_place(message, "use single quotes, or double the backslash")
        if "quoted scalar" in self.said:
            message = "the quotes that are opened here are never closed"
            return self._at_beginning(message, "close them with the same kind of quote")
        if "flow" in self.said:
            message = "the bracket or brace opened here is not closed, or lacks a comma"
            hint = "close it, and put commas between its parts"
            if self.began is not None and self.began[0] > len(self.lines):
                # At the end of the file the reader names the end alone.
                self.began = _last_open(self.lines) or self.began
            return self._at_beginning(message, hint)
        if "not allowed" in self.said and "mapping values" in self.said:
            return self._stray_colon(here)
        if "expected key" in self.said or "<block end>" in self.said:
            return self._at_place(
                "the indentation does not fit any map or list above",
                "indent it exactly like the other keys of its map",
            )
        if "cannot start any token" in self.said:
            sign = here[self.column - 1 : self.column] if self.column else ""
            return self._at_place(
                f"a value cannot begin with '{sign}'", "put the value in quotes"
            )
        if "characters" in self.said and "allowed" in self.said:
            return self._at_place(
                "there is a character that YAML does not allow", "remove it"
            )
        if "could not find expected ':'" in self.said:
            return self._no_colon(self.line)
        return self._at_place(f"this is not YAML: {self.said}", _GENERAL)

    def right_indent(self) -> int | None:
        """Return the blanks before lines of this kind, where one more or less is wrong.

        With them the file is readable.
        """
        here = self.lines[self.line - 1]
        depth, is_item = len(_indent(here)), here.lstrip(" ").startswith("- ")
        around = (*self.lines[self.line - 2 :: -1], *self.lines[self.line :])
        alike = (x for x in around if x.lstrip(" ").startswith("- ") == is_item)
        depths = dict.fromkeys(len(_indent(line)) for line in alike if line.strip())
        for right in (d for d in depths if abs(d - depth) == 1):
            lines = [*self.lines]
            lines[self.line - 1] = " " * right + here.lstrip(" ")
            try:
                parse("\n".join(lines))
            except (yaml.YAMLError, ParseFault):
                continue
            return right
        return None

    def _at_place(self, message: str, hint: str) -> _YamlCause:
        return _YamlCause(self.line, self.column, message, hint)

    def _at_beginning(self, message: str, hint: str) -> _YamlCause:
        line, column = self.began or (self.line, self.column)
        return _YamlCause(line, column, message, hint)

    def _stray_colon(self, here: str) -> _YamlCause:
        before = here[: (self.column or 1) - 1]
        if ": " in before:
            message = "there are two colons in this line, each followed by a blank"
            return self._at_place(message, "put the value in quotes")
        above = self._line_above()
        if above and not _PAIR.search(self.lines[above - 1]):
            return self._no_colon(above)
        return self._at_place(
            "this line is indented further than the line above allows",
            "indent it like the keys around it",
        )

    def _no_colon(self, line: int) -> _YamlCause:
        while line > 1 and (
            _PAIR.search(self.lines[line - 1]) or not self.lines[line - 1]
        ):
            line -= 1
        return _YamlCause(
            line,
            None,
            "this line is not 'key: value'",
            "write a colon and a blank behind the key",
        )

    def _line_above(self) -> int:
        """The last line above that is neither blank nor a comment; 0 for none."""
        for number in range(self.line - 1, 0, -1):
            line = self.lines[number - 1].strip()
            if line and not line.startswith("#"):
                return number
        return 0
