"""Edits that fix problems: where text is replaced in a file, and by what.

A rule says which word is wrong at a place, and the right one; here it is found in the
file. There is an edit only where the file has the wrong word itself at one place of the
line: a value that xacro computes, or one that is there twice, has none.
"""

from __future__ import annotations

import os
import posixpath
import re
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.cached import cached_property
from sambot_viz.errors import Edit, Fix, Place
from sambot_viz.files import read_limited, relative_path
from sambot_viz.unsaved import unsaved_text

_ENCODING = re.compile(
    rb"""\s*<\?xml\b[^>]{0,200}?\bencoding\s*=\s*["']([\w.-]+)["']"""
)
_WITHOUT_TAGS = (".py", ".yaml", ".yml", ".rviz", ".txt")
_NAME = re.compile(r"<([^\s<>/=\"']+)")
_ATTRIBUTE = re.compile(r"""\s+([^\s<>/=\"']+)\s*=\s*(?:"([^"<]*)"|'([^'<]*)')""")
_END = re.compile(r"\s*(/?)>")
_SKIPPED = r"<!--.*?-->|<!\[CDATA\[.*?\]\]>"
_INCLUDE = re.compile(r"<xacro:include\b[^>]*/>")
_ROOT = re.compile(r"<(robot|sdf)\b[^>]*>")
_KEY = re.compile(r"[\"']?\s*:(?=\s)")
"""What is behind a key of YAML or of Python."""
_OUTSIDE = r"(?<![\w./-])(?<!::){}(?![\w./-]|::)"
"""A name is a whole word, and no part of a path, a number or a type."""


class Extent(NamedTuple):
    """A piece of a text: its first offset, and the one behind its last."""

    start: int
    end: int


class Tag(NamedTuple):
    """A start tag in a text.

    Attributes:
        name: where its name is.
        names: attribute → where its name is.
        values: attribute → where its value is, without the quotes.
        rest: where another attribute can be added.
        end: the offset behind it.
        is_empty: it ends with "/>".
    """

    name: Extent
    names: dict[str, Extent]
    values: dict[str, Extent]
    rest: int
    end: int
    is_empty: bool


def apply_edits(edits: Iterable[Edit], text: str) -> str:
    """Return a text with its edits made; the line ends stay as they are.

    Args:
        edits: those of one file, in any order; the same one counts once.
        text: what is in the file, decoded.

    Raises:
        ValueError: two edits replace the same text.
    """
    made: list[str] = []
    done = 0
    for start, end, new in sorted({(e.start, e.end, e.text) for e in edits}):
        if start < done:
            raise ValueError("two edits replace the same text")
        made += text[done:start], new
        done = end
    return "".join(made) + text[done:]


def by_file(edits: Iterable[Edit]) -> dict[str, list[Edit]]:
    """Return file → its edits, in the order in which they came."""
    of_file: dict[str, list[Edit]] = {}
    for edit in edits:
        of_file.setdefault(edit.file, []).append(edit)
    return of_file


def write(
    place: Place, wrong: str, right: str, after: str = "", *, hint: str = ""
) -> Fix:
    """Return the fix that writes one word for another.

    Args:
        place: the line with the wrong word; with a column, it is at or behind that. In
            XML the word is in the element that begins there.
        wrong: the word as the file has it.
        right: what to write.
        after: the end of the hint.
        hint: the hint, where it is not "write" and the right word.
    """
    edits: tuple[Edit, ...] = ()
    if (source := source_of(place.file)) is not None:
        spans = list(source.words(wrong, source.offset(place)))
        if len(spans) == 1:
            edits = (source.edit(place, spans[0], right),)
    return Fix(hint or f"write {right}{after}", edits)


def write_between(place: Place, end: Place, right: str, hint: str) -> Fix:
    """Return the fix that writes a text for all that is between two places."""
    source = source_of(place.file)
    if source is None:
        return Fix(hint)
    extent = Extent(source.offset(place), source.offset(end))
    return Fix(hint, (source.edit(place, extent, right),))


def write_attribute(
    place: Place | None,
    name: str,
    wrong: str | Sequence[float],
    right: str,
    *,
    hint: str = "",
) -> Fix:
    """Return the fix that gives an attribute another value.

    Args:
        place: where the element begins.
        name: the attribute.
        wrong: its value as the file has it, or the numbers in it.
        right: its right value.
        hint: the hint, where it is not "write" and the attribute.
    """
    edits: tuple[Edit, ...] = ()
    found = _tag_at(place) if place is not None else None
    if place is not None and found is not None:
        source, tag = found
        span = tag.values.get(name)
        if span is not None and _says(source.text[span.start : span.end], wrong):
            edits = (source.edit(place, span, right),)
    return Fix(hint or f'write {name}="{right}"', _plain(edits))


def write_path(place: Place | None, wrong: str, right: str) -> Fix:
    """Return the fix that names a file by another path.

    Args:
        place: where the element begins that names it.
        wrong: the path, with what xacro writes for the beginning of it.
        right: the path that it should be.
    """
    source = None if place is None else source_of(place.file)
    if place is None or source is None:
        return Fix(f"write {right}")
    for span in source.values(source.offset(place)):
        written = source.text[span.start : span.end]
        computed = max(written.rfind(")"), written.rfind("}")) + 1
        end = written[computed:]
        if not {".", "/"}.intersection(end) or not wrong.endswith(end):
            continue
        new = right
        if written != wrong:
            slash = "/" if end.startswith("/") else ""
            base = wrong[: len(wrong) - len(end)]
            new = slash + posixpath.relpath(right, base or ".")
        edit = source.edit(place, Extent(span.start + computed, span.end), new)
        return Fix(f"write {written[:computed]}{new}", _plain((edit,)))
    return Fix(f"write {right}")


def overwrite_attribute(place: Place | None, name: str, right: str) -> tuple[Edit, ...]:
    """Return the edit that gives an attribute another value, whatever it has."""
    found = _tag_at(place) if place is not None else None
    if place is None or found is None or name not in found[1].values:
        return ()
    return _plain((found[0].edit(place, found[1].values[name], right),))


def include_before(place: Place, file: str) -> Fix:
    """Return the fix that includes a xacro file before a place, behind other includes.

    Args:
        place: where a macro of the file is called.
        file: the file, as the user would write it.
    """
    path = relative_path(file, os.path.dirname(place.file) or ".").replace(os.sep, "/")
    written = f'<xacro:include filename="{path}"/>'
    hint = f"add {written} before it"
    source = source_of(place.file)
    if source is None:
        return Fix(hint)
    before = source.text[: source.offset(place)]
    last = [*_INCLUDE.finditer(before)] or [*_ROOT.finditer(before)][:1]
    if not last:
        return Fix(hint)
    behind = before[last[-1].end() :]
    blanks = behind[: len(behind) - len(behind.lstrip())] or "\n"
    blanks = "\n" + blanks.rpartition("\n")[2]
    at = Extent(last[-1].end(), last[-1].end())
    return Fix(hint, (source.edit(place, at, blanks + written),))


def write_part(
    place: Place | None, name: str, at: int, wrong: str, right: str
) -> tuple[Edit, ...]:
    """Return the edit of one of several numbers in an attribute.

    Args:
        place: where the element begins.
        name: the attribute.
        at: which of the numbers, from 0.
        wrong: the number that is there; another text is left alone.
        right: what to write.
    """
    parts = _parts(place, name)
    if at >= len(parts) or not _says(parts[at][0], [float(wrong)]):
        return ()
    return _written(place, parts[at][1], right)


def negate_part(place: Place | None, name: str, at: int) -> tuple[Edit, ...]:
    """Return the edit that gives one of several numbers in an attribute another sign.

    Args:
        place: where the element begins.
        name: the attribute.
        at: which of the numbers, from 0; xacro may compute it.
    """
    parts = _parts(place, name)
    if at >= len(parts):
        return ()
    old, extent = parts[at]
    if old.startswith("${"):
        inner = old[2:-1]
        bare = inner.removeprefix("-")
        simple = bare.isidentifier() or _is_bracketed(bare)
        if not old.endswith("}") or (bare != inner and not simple):
            return ()
        right = bare if bare != inner else f"-{inner if simple else f'({inner})'}"
        return _written(place, extent, f"${{{right}}}")
    return _written(place, extent, old[1:] if old.startswith("-") else f"-{old}")


def _is_bracketed(text: str) -> bool:
    return text[:1] == "(" and text[-1:] == ")" and "(" not in text[1:]


def exchange_attributes(place: Place, one: str, other: str) -> tuple[Edit, ...]:
    """Return the edits that exchange the values of two attributes, as they are written.

    Args:
        place: where the element begins.
        one: an attribute.
        other: another.
    """
    found = _tag_at(place)
    if found is None or not {one, other} <= found[1].values.keys():
        return ()
    source, tag = found
    here, there = tag.values[one], tag.values[other]
    first, second = source.text[slice(*here)], source.text[slice(*there)]
    return source.edit(place, here, second), source.edit(place, there, first)


def exchange_parts(
    place: Place | None, name: str, one: int, other: int
) -> tuple[Edit, ...]:
    """Return the edits that exchange two of the numbers in an attribute.

    Args:
        place: where the element begins.
        name: the attribute.
        one: a number, from 0.
        other: another.
    """
    parts = _parts(place, name)
    if max(one, other) >= len(parts):
        return ()
    (first, here), (second, there) = parts[one], parts[other]
    return (*_written(place, here, second), *_written(place, there, first))


def _parts(place: Place | None, name: str) -> list[tuple[str, Extent]]:
    """Return the texts between blanks in an attribute, and where they are."""
    found = _tag_at(place) if place is not None else None
    if found is None or name not in found[1].values:
        return []
    start, end = found[1].values[name]
    parts = re.finditer(r"\S+", found[0].text[start:end])
    return [(m[0], Extent(start + m.start(), start + m.end())) for m in parts]


def _written(place: Place | None, extent: Extent, new: str) -> tuple[Edit, ...]:
    source = None if place is None else source_of(place.file)
    return (source.edit(place, extent, new),) if place and source else ()


def write_behind(place: Place, added: str) -> tuple[Edit, ...]:
    """Return the edit that writes a text behind the one of an element.

    Args:
        place: where the element begins.
        added: what is missing at its end.
    """
    found = _tag_at(place)
    if found is None or found[1].is_empty:
        return ()
    source, tag = found
    text = source.text_behind(tag)
    at = Extent(text.end, text.end)
    return (source.edit(place, at, added),) if text.start < text.end else ()


def put_into(place: Place | None, written: str) -> tuple[Edit, ...]:
    """Return the edit that writes an element as the first in another one."""
    found = _tag_at(place) if place is not None else None
    if place is None or found is None or found[1].is_empty:
        return ()
    source, tag = found
    behind = source.text[tag.end :]
    blanks = behind[: len(behind) - len(behind.lstrip())]
    return (source.edit(place, Extent(tag.end, tag.end), f"{blanks}{written}"),)


def write_as_text(place: Place, name: str) -> tuple[Edit, ...]:
    """Return the edits that make an attribute of an element without content its text.

    Args:
        place: where the element begins.
        name: the attribute.
    """
    edits, found = delete_attribute(place, name), _tag_at(place)
    if found is None or not edits:
        return ()
    source, tag = found
    text = source.text[slice(*tag.values[name])]
    if tag.is_empty:
        element = source.text[slice(*tag.name)]
        end = Extent(tag.rest, tag.end)
        return (*edits, source.edit(place, end, f">{text}</{element}>"))
    inside = Extent(tag.end, source.text.find("<", tag.end))
    return (*edits, source.edit(place, inside, text))


def delete_attribute(place: Place, name: str) -> tuple[Edit, ...]:
    """Return the edit that deletes an attribute, with the blanks before it."""
    found = _tag_at(place)
    if found is None or name not in found[1].values:
        return ()
    source, tag = found
    before = source.text[: tag.names[name].start]
    gone = Extent(len(before.rstrip()), tag.values[name].end + 1)
    return (source.edit(place, gone, ""),)


def copy_as(
    place: Place | None, tag: str, other: str, parts: Sequence[str]
) -> tuple[Edit, ...]:
    """Return the edit that writes an element again behind it, with another tag.

    Args:
        place: where the element begins.
        tag: its tag.
        other: that of the copy.
        parts: the tags of the children that the copy has.
    """
    found = _tag_at(place) if place is not None else None
    end = None if found is None else found[0].end_of(found[1])
    if place is None or found is None or end is None:
        return ()
    source, start = found[0], found[0].offset(place)
    blanks = source.text[source.text.rfind("\n", 0, start) + 1 : start]
    if blanks.strip() or source.text[slice(*found[1].name)] != tag:
        return ()
    text = "".join(
        f"\n{blanks}  {source.text[at : source.end_of(inner)]}"
        for part in parts
        for match in re.finditer(rf"<{part}(?=[\s/>])", source.text[start:end])
        if (inner := source.tag(at := start + match.start())) is not None
    )
    added = f"\n{blanks}<{other}>{text}\n{blanks}</{other}>"
    return (source.edit(place, Extent(end, end), added),)


def move_before(place: Place, outer: Place) -> tuple[Edit, ...]:
    """Return the edits that move an element, with its line, before one around it.

    Args:
        place: where the element begins.
        outer: where the one around it begins.
    """
    found, around = _tag_at(place), _tag_at(outer)
    if found is None or around is None or place.file != outer.file:
        return ()
    source, tag = found
    start, at = source.offset(place), source.offset(outer)
    end, last = source.end_of(tag), source.end_of(around[1])
    if end is None or last is None or not at < start < end < last:
        # A macro elsewhere makes the element.
        return ()
    text = source.text[start:end]
    line = len(source.text[:start].rstrip(" \t"))
    blanks = source.text[source.text.rfind("\n", 0, at) + 1 : at]
    between = f"\n{blanks}" if not blanks.strip() else ""
    moved = source.edit(outer, Extent(at, at), f"{text}{between}")
    line -= source.text[:line].endswith("\n")
    return (source.edit(place, Extent(line, end), ""), moved)


def rename_attribute(
    place: Place, wrong: str, right: str, value: str, hint: str
) -> Fix:
    """Return the fix that gives an attribute another name.

    Args:
        place: where the element begins.
        wrong: the name as the file has it.
        right: its right name.
        value: what its value is to be; the same is left as it is in the file.
        hint: the hint.
    """
    edits: list[Edit] = []
    found = _tag_at(place)
    if found is not None and wrong in found[1].names and right not in found[1].names:
        source, tag = found
        edits.append(source.edit(place, tag.names[wrong], right))
        span = tag.values[wrong]
        if value.startswith(written := source.text[span.start : span.end]):
            added = value.removeprefix(written)
            behind = Extent(span.end, span.end)
            edits += [source.edit(place, behind, added)] if added else []
    return Fix(hint, _plain(tuple(edits)))


def rename_element(place: Place, wrong: str, right: str, hint: str) -> Fix:
    """Return the fix that gives an element another name, in its end tag too.

    Args:
        place: where it begins.
        wrong: the name as the file has it.
        right: its right name.
        hint: the hint.
    """
    found = _tag_at(place)
    if found is None:
        return Fix(hint)
    source, tag = found
    last = tag.name if tag.is_empty else source.closing_name(tag)
    if last is None or source.text[tag.name.start : tag.name.end] != wrong:
        return Fix(hint)
    spans = dict.fromkeys((tag.name, last))
    return Fix(hint, tuple(source.edit(place, span, right) for span in spans))


def together(hint: str, *fixes: Fix) -> Fix:
    """Return one fix that does what several do, or that has no edits."""
    if not all(fix.edits for fix in fixes):
        return Fix(hint)
    return Fix(hint, tuple(edit for fix in fixes for edit in fix.edits))


def exchange(hint: str, one: tuple[Place, str], other: tuple[Place, str]) -> Fix:
    """Return the fix that writes each of two texts, with its line, for the other."""
    (here, said), (there, instead) = one, other
    return together(hint, write(here, said, instead), write(there, instead, said))


def _says(written: str, value: str | Sequence[float]) -> bool:
    if isinstance(value, str):
        return written == value
    try:
        return [float(part) for part in written.split()] == list(value)
    except ValueError:
        return False


def _tag_at(place: Place) -> tuple[SourceFile, Tag] | None:
    source = source_of(place.file)
    tag = source.tag(source.offset(place)) if source is not None else None
    return None if source is None or tag is None else (source, tag)


def _plain(edits: tuple[Edit, ...]) -> tuple[Edit, ...]:
    """Leave out what would be markup in a value."""
    return () if any(set(edit.text) & set("<&\"'") for edit in edits) else edits


@dataclass(frozen=True)
class SourceFile:
    """What is in a file.

    Attributes:
        text: decoded, without a byte order mark, with its line ends.
        encoding: by which it is encoded again.
        is_markup: False for a form in which < begins no tag.
    """

    text: str
    encoding: str
    is_markup: bool = True

    def edit(self, place: Place, extent: Extent, new: str) -> Edit:
        """Return the edit that writes a text into the file of a place."""
        if "\r\n" in self.text:
            new = new.replace("\r\n", "\n").replace("\n", "\r\n")
        return Edit(place.file, *extent, new, seen=hash(self.text))

    @cached_property
    def _lines(self) -> list[int]:
        return [0, *(match.end() for match in re.finditer("\n", self.text))]

    def offset(self, place: Place) -> int:
        """Return the offset of a place; of a line without a column its beginning."""
        if place.line > len(self._lines):
            return len(self.text)
        return self._lines[place.line - 1] + (place.column or 1) - 1

    def place(self, offset: int) -> tuple[int, int]:
        """Return the line and the column of an offset, both counted from 1."""
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1

    def words(self, word: str, offset: int) -> list[Extent]:
        """Return where a word is in an element of XML, or in the rest of a line."""
        pieces = self.values(offset) or [self._rest_of_line(offset)]
        whole = [span for span in pieces if self.text[span.start : span.end] == word]
        if whole:
            return whole
        pattern = re.compile(_OUTSIDE.format(re.escape(word)))
        found = [
            Extent(*match.span())
            for piece in pieces
            for match in pattern.finditer(self.text, *piece)
        ]
        values = [s for s in found if not _KEY.match(self.text, s.end)]
        return values or found

    def _rest_of_line(self, offset: int) -> Extent:
        end = self.text.find("\n", offset)
        return Extent(offset, len(self.text) if end < 0 else end)

    def values(self, offset: int) -> list[Extent]:
        """Return where the values of an element's attributes are, and its text."""
        tag = self.tag(offset)
        if tag is None:
            return []
        text = [] if tag.is_empty else [self.text_behind(tag)]
        return [*tag.values.values(), *text]

    def text_behind(self, tag: Tag) -> Extent:
        """Return the text between a tag and the next, without blanks around it."""
        end = self.text.find("<", tag.end)
        written = self.text[tag.end : len(self.text) if end < 0 else end]
        start = tag.end + len(written) - len(written.lstrip())
        return Extent(start, start + len(written.strip()))

    def tag(self, offset: int) -> Tag | None:
        """Read the start tag that begins at an offset; None when there is none."""
        name = _NAME.match(self.text, offset) if self.is_markup else None
        if name is None:
            return None
        names: dict[str, Extent] = {}
        values: dict[str, Extent] = {}
        at = name.end()
        while match := _ATTRIBUTE.match(self.text, at):
            names[match[1]] = Extent(*match.span(1))
            values[match[1]] = Extent(*match.span(2 if match[2] is not None else 3))
            at = match.end()
        end = _END.match(self.text, at)
        if end is None:
            return None
        return Tag(Extent(*name.span(1)), names, values, at, end.end(), bool(end[1]))

    def end_of(self, tag: Tag) -> int | None:
        """Return the offset behind an element; None when it is not closed."""
        if tag.is_empty:
            return tag.end
        name = self.closing_name(tag)
        return None if name is None else self.text.index(">", name.end) + 1

    def closing_name(self, tag: Tag) -> Extent | None:
        """Return where the name is in the end tag that belongs to a start tag."""
        name = re.escape(self.text[tag.name.start : tag.name.end])
        inside = r"(?:\"[^\"]*\"|'[^']*'|[^\"'>])*?"
        pattern = re.compile(
            rf"{_SKIPPED}|<{name}(?=[\s/>]){inside}(/?)>|</({name})\s*>", re.DOTALL
        )
        depth = 1
        for match in pattern.finditer(self.text, tag.end):
            if match[2] is not None:
                depth -= 1
            elif match[1] == "":
                depth += 1
            if not depth:
                return Extent(*match.span(2))
        return None


def source_of(file: str) -> SourceFile | None:
    """Return what is in a file; None when it cannot be read as text."""
    if (text := unsaved_text(file)) is not None:
        return _of_text(text, not file.endswith(_WITHOUT_TAGS))
    try:
        stat = os.stat(file)
        if not os.path.isfile(file) or stat.st_size > limits.FIXED_FILE.value:
            return None
        return _read(file, stat.st_mtime_ns, stat.st_size)
    except (OSError, ValueError, LookupError):
        return None


@lru_cache(maxsize=8)
def _of_text(text: str, is_markup: bool) -> SourceFile:
    """Return a text that is not saved; its lines are counted once."""
    return SourceFile(text, "utf-8", is_markup)


@lru_cache(maxsize=8)
def _read(file: str, saved: int, size: int) -> SourceFile:
    """Read a file once for many problems, until it is saved."""
    found = decoded(read_limited(Path(file), limits.FIXED_FILE.value))
    return replace(found, is_markup=not file.endswith(_WITHOUT_TAGS))


def decoded(data: bytes) -> SourceFile:
    """Return the content of a file as text.

    Raises:
        ValueError: it is not in the encoding that it claims.
        LookupError: there is no such encoding.
    """
    if data.startswith(b"\xef\xbb\xbf"):
        return SourceFile(data.decode("utf-8-sig"), "utf-8-sig")
    declared = _ENCODING.match(data)
    encoding = declared[1].decode("ascii") if declared else "utf-8"
    return SourceFile(data.decode(encoding), encoding)
