"""A failed expansion together with the files it came from."""

from __future__ import annotations

import re
from dataclasses import dataclass

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xacro.diagnose.source_files import NamedElement, SourceSet
from sambot_viz.robot.xacro.result import XacroFailure


@dataclass(frozen=True)
class FailedExpansion:
    """A failure, the main file, and the sources in which things can be found."""

    failure: XacroFailure
    main_file: str
    sources: SourceSet

    @classmethod
    def of(cls, failure: XacroFailure, main_file: str) -> FailedExpansion:
        """Prepare the search; the file being processed is searched first."""
        files = [
            failure.file,
            *(file for _, file in failure.macros),
            *failure.includes,
            main_file,
            *(definition.file for definition in failure.definitions),
        ]
        return cls(failure, main_file, SourceSet.of(files))

    @property
    def report(self) -> str:
        """Xacro's report in one line for matching: "kind in macro: text"."""
        failure = self.failure
        if failure.missing_package is not None:
            return f"missing package {failure.missing_package.name}"
        inside = f" in {failure.macros[0][0]}" if failure.macros else ""
        return f"{failure.kind}{inside}: {failure.text}"

    @property
    def place(self) -> Place:
        """The element that xacro was working on, as far as the child knows it."""
        file = self.failure.file or self.main_file
        return Place(file, self.failure.line or 1, self.failure.column)

    @property
    def expression(self) -> str:
        """The innermost expression without ${ and }, or ""."""
        text = (*self.failure.expressions, "")[0].strip()
        inner = re.fullmatch(r"\$\{(.*)\}", text, re.DOTALL)
        return (inner[1] if inner else text).strip()

    def expression_place(self) -> Place:
        """Where the failed expression is written, else the element's place."""
        if not self.expression:
            return self.place
        pattern = r"\$[({]\s*(?:eval\s+)?" + re.escape(self.expression) + r"\s*[)}]"
        return self.sources.find(pattern, self.place) or self.place

    def trail(self, at: Place) -> str:
        """The macro calls on the way: " (in macro wheel, called on line 31)"."""
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

    def is_root(self, place: Place) -> bool:
        """Whether a place is inside the root tag of its file."""
        source = self.sources.get(place.file)
        root = next((t for t in source.tags if not t.closes), None) if source else None
        if source is None or root is None:
            return False
        return root.start <= source.offset(place.line, place.column or 1) < root.end

    def called_macro(self) -> tuple[str, Place, NamedElement | None]:
        """The macro whose call failed, the place of the call, its definition."""
        failure = self.failure
        name = failure.macros[0][0] if failure.macros else ""
        name = (name or (failure.element or "")).removeprefix("xacro:")
        at = self.place
        if self.sources.tag_at(at, f"xacro:{name}") is None:
            calls = [place for place, _ in self.sources.calls(f"xacro:{name}")]
            inner = failure.calls[0] if failure.calls else None
            if inner is not None and inner.macro.removeprefix("xacro:") == name:
                at = Place(inner.file, inner.line)
            elif calls:
                at = calls[0]
        return name, at, next((m for m in self.named("macro") if m.name == name), None)

    def named(self, kind: str) -> list[NamedElement]:
        """Definitions in the files, and those that only xacro has seen."""
        found = self.sources.named(kind)
        names = {one.name for one in found if one.prefixed}
        return found + [
            NamedElement(kind, d.name, Place(d.file, d.line), True, d.params)
            for d in self.failure.definitions
            if d.kind == kind and d.name not in names
        ]


def line_in(place: Place, seen_from: Place) -> str:
    """A line for a message: "line 12", with the file when it is another one."""
    if place.file == seen_from.file:
        return f"line {place.line}"
    return f"line {place.line} of {place.file}"
