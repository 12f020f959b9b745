"""Find definitions, calls and expressions in xacro source files.

xacro gives no line numbers; the places in its errors come from this scan of the files
that the user wrote.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Place
from sambot_viz.files import read_limited
from sambot_viz.robot.xml.diagnose.lexer import Token
from sambot_viz.robot.xml.diagnose.source_text import SourceText
from sambot_viz.unsaved import unsaved_text


@dataclass(frozen=True, slots=True)
class NamedElement:
    """A definition in a file: <xacro:property>, <xacro:macro> or <xacro:arg>.

    Attributes:
        kind: "property", "macro" or "arg".
        name: without the prefix.
        place: where it is.
        prefixed: False when it lacks the prefix xacro:, so that xacro skips it.
        params: the parameter text of a macro.
        inside: the macro in whose body it is, or "".
    """

    kind: str
    name: str
    place: Place
    prefixed: bool
    params: str = ""
    inside: str = ""


def read_source(file: str | Path) -> SourceText | None:
    """Read the text of a file; None when it cannot be read or is huge."""
    if (unread := unsaved_text(file)) is not None:
        return SourceText(unread)
    try:
        path = Path(file)
        if path.stat().st_size > limits.XACRO_SOURCE.value:
            return None
        largest = limits.XACRO_SOURCE.value
        text = read_limited(path, largest).decode("utf-8", "replace")
    except (OSError, ValueError):
        return None
    return SourceText(text.replace("\r\n", "\n"))


def definitions_in(source: SourceText, file: str) -> Iterator[NamedElement]:
    """Yield the properties, macros and arguments of a file, in document order."""
    inside: list[str] = []
    for token in source.tags:
        prefix, _, kind = token.name.rpartition(":")
        if kind == "macro" and token.closes and inside:
            inside.pop()
        if token.closes or kind not in ("property", "macro", "arg"):
            continue
        if prefix not in ("", "xacro"):
            continue
        name = token.get("name")
        if name is not None:
            place = Place(file, source.line(token.start), source.column(token.start))
            around = inside[-1] if inside else ""
            params = token.get("params") or ""
            yield NamedElement(kind, name, place, prefix == "xacro", params, around)
        if kind == "macro" and token.kind == "open":
            inside.append(name or "")


def token_place(source: SourceText, file: str, token: Token) -> Place:
    """Return the place where a token begins."""
    return Place(file, source.line(token.start), source.column(token.start))


@dataclass
class SourceSet:
    """The files of an expansion, the ones being processed first."""

    files: tuple[str, ...]
    _read: dict[str, SourceText | None] = field(
        default_factory=dict[str, "SourceText | None"]
    )

    @classmethod
    def of(cls, files: Iterable[str]) -> SourceSet:
        """Make the set of these files, each once, in this order."""
        return cls(tuple(dict.fromkeys(f for f in files if f)))

    def get(self, file: str) -> SourceText | None:
        """Return the text of a file, read at most once."""
        if file not in self._read:
            self._read[file] = read_source(file)
        return self._read[file]

    def sources(self) -> Iterator[tuple[str, SourceText]]:
        """Yield all readable files with their names."""
        for file in self.files:
            source = self.get(file)
            if source is not None:
                yield file, source

    def named(self, kind: str) -> list[NamedElement]:
        """Return everything of one kind that the files define."""
        return [
            definition
            for file, source in self.sources()
            for definition in definitions_in(source, file)
            if definition.kind == kind
        ]

    def find(self, pattern: str, near: Place | None = None) -> Place | None:
        """Find the first match of a pattern outside comments.

        Args:
            pattern: a regular expression.
            near: a match in the tag at this place comes before all others.
        """
        for file, source in self.sources():
            hits = [
                Place(file, source.line(m.start()), source.column(m.start()))
                for m in re.finditer(pattern, source.text)
                if not source.in_comment(m.start())
            ]
            if near is not None and file == near.file:
                end = _last_line_of_tag(source, near.line)
                here = [hit for hit in hits if near.line <= hit.line <= end]
                if here:
                    return here[0]
            if hits:
                return hits[0]
        return None

    def tag_at(self, place: Place, name: str) -> Token | None:
        """Return the tag with that name that begins on that line, or None."""
        source = self.get(place.file)
        if source is None:
            return None
        return next(
            (
                t
                for t in source.tags
                if t.name == name
                and not t.closes
                and source.line(t.start) == place.line
            ),
            None,
        )

    def calls(self, name: str) -> Iterator[tuple[Place, Token]]:
        """Yield all opening tags with that name."""
        for file, source in self.sources():
            for token in source.tags:
                if token.name == name and not token.closes:
                    yield token_place(source, file, token), token

    def neighbours_with_macro(self, name: str) -> list[NamedElement]:
        """Find macros of that name in files beside or below the known ones."""
        found: list[NamedElement] = []
        for folder in dict.fromkeys(Path(f).parent for f in self.files):
            for path in _xacro_files(folder):
                if str(path) in self.files:
                    continue
                source = read_source(path)
                if source is None or name not in source.text:
                    continue
                found += [
                    definition
                    for definition in definitions_in(source, str(path))
                    if definition.kind == "macro" and definition.name == name
                ]
        return found


def _xacro_files(folder: Path) -> list[Path]:
    found: list[Path] = []
    for pattern in ("*.xacro", "*/*.xacro"):
        for path in sorted(folder.glob(pattern)):
            found.append(path)
            if len(found) >= limits.XACRO_NEIGHBOURS.value:
                return found
    return found


def _last_line_of_tag(source: SourceText, line: int) -> int:
    ends = [source.line(t.end - 1) for t in source.tags if source.line(t.start) == line]
    return max(ends, default=line)
