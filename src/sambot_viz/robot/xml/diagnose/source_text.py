"""Lines, columns and tokens of a source text."""

from __future__ import annotations

import bisect
import re
from collections.abc import Iterable
from dataclasses import dataclass

from sambot_viz.cached import cached_property
from sambot_viz.edits import together, write_between
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xml.diagnose.lexer import Reading, Token, tokenize

Change = tuple[int, int, str]
"""Where a piece of the text begins and ends, and what is written for it."""

ROOTS = ("robot", "sdf")
"""The tags of the root elements of models."""


@dataclass(frozen=True)
class SourceText:
    """A text with its lines, and its tokens on demand."""

    text: str

    @cached_property
    def _starts(self) -> list[int]:
        return [0, *(m.end() for m in re.finditer(r"\n", self.text))]

    def line(self, offset: int) -> int:
        """Return the line of an offset, counted from 1."""
        return bisect.bisect_right(self._starts, offset)

    def column(self, offset: int) -> int:
        """Return the column of an offset in its line, counted from 1."""
        return offset - self._starts[self.line(offset) - 1] + 1

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a line and a column, both counted from 1."""
        return self._starts[min(line, len(self._starts)) - 1] + column - 1

    def error(
        self,
        file: str,
        code: str,
        offset: int,
        message: str,
        hint: str,
        changes: Iterable[Change] = (),
    ) -> Problem:
        """Make a problem of severity "error" at an offset, with what repairs it."""

        def place(at: int) -> Place:
            return Place(file, self.line(at), self.column(at))

        fixes = [write_between(place(a), place(b), new, hint) for a, b, new in changes]
        fix = together(hint, *fixes)
        return Problem.at(place(offset), "error", code, message, fix)

    def starts_line(self, offset: int) -> bool:
        """Return whether only blanks precede an offset in its line."""
        while offset and self.text[offset - 1] in " \t":
            offset -= 1
        return offset == 0 or self.text[offset - 1] == "\n"

    @cached_property
    def _comments(self) -> list[tuple[int, int]]:
        pattern = re.compile(r"<!--.*?(?:-->|\Z)", re.DOTALL)
        return [match.span() for match in pattern.finditer(self.text)]

    def in_comment(self, offset: int) -> bool:
        """Return whether an offset is inside a comment."""
        before = bisect.bisect_right(self._comments, (offset, len(self.text))) - 1
        return before >= 0 and offset < self._comments[before][1]

    @cached_property
    def read(self) -> Reading:
        """The tokens and the lexical errors, both in document order."""
        return tokenize(self.text)

    @cached_property
    def tags(self) -> list[Token]:
        """Only the tags: open, close and empty tokens."""
        return [t for t in self.read.tokens if t.name]
