"""One failed expansion together with the files it came from."""

from __future__ import annotations

import re
from dataclasses import dataclass

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xacro.diagnose.source_files import NamedElement, SourceSet
from sambot_viz.robot.xacro.result import XacroFailure


@dataclass(frozen=True)
class FailedExpansion:
    """A failure, the main file, and the sources to look things up in."""

    failure: XacroFailure
    main_file: str
    sources: SourceSet

    @classmethod
    def of(cls, failure: XacroFailure, main_file: str) -> FailedExpansion:
        """The case of a failure; the file being processed is searched first."""
        files = [
            failure.file,
            *(file for _, file in failure.macros),
            *failure.includes,
            main_file,
            *(definition.file for definition in failure.definitions),
        ]
        return cls(failure, main_file, SourceSet.of(files))

    @property
    def place(self) -> Place:
        """Where xacro stood when it failed, as far as the child could say."""
        file = self.failure.file or self.main_file
        return Place(file, self.failure.line or 1, self.failure.column)

    @property
    def expression(self) -> str:
        """The innermost expression without ${ and }, or ""."""
        text = (self.failure.expression or "").strip()
        inner = re.fullmatch(r"\$\{(.*)\}", text, re.DOTALL)
        return (inner[1] if inner else text).strip()

    def expression_place(self) -> Place:
        """Where the failed expression is written, else where xacro stood."""
        if not self.expression:
            return self.place
        pattern = r"\$[({]\s*(?:eval\s+)?" + re.escape(self.expression) + r"\s*[)}]"
        return self.sources.find(pattern, self.place) or self.place

    def trail(self, at: Place) -> str:
        """The macro calls that led there: " (in macro wheel, called on line 31)"."""
        calls = self.failure.calls
        if not calls or (calls[0].line == at.line and calls[0].file == at.file):
            return ""
        steps = [
            f"in macro {call.macro}, called on line {call.line}"
            + (f" of {call.file}" if call.file != at.file else "")
            for call in calls[:3]
        ]
        return f" ({'; '.join(steps)})"

    def error(self, code: str, message: str, hint: str, at: Place) -> Problem:
        """A problem of severity "error" at a place."""
        return Problem("error", code, message, hint, at.file, at.line, at.column)

    def named(self, kind: str) -> list[NamedElement]:
        """What the files define, and what xacro met that the scan cannot see."""
        found = self.sources.named(kind)
        names = {thing.name for thing in found if thing.prefixed}
        return found + [
            NamedElement(kind, d.name, Place(d.file, d.line), True, d.params)
            for d in self.failure.definitions
            if d.kind == kind and d.name not in names
        ]


def line_in(place: Place, seen_from: Place) -> str:
    """Such as "line 12", with the file when it is another one."""
    if place.file == seen_from.file:
        return f"line {place.line}"
    return f"line {place.line} of {place.file}"
