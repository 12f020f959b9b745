"""Edits that do what a hint says: what it tells to write is what is written.

Hints about elements of XML have few forms: "write" or "add" and attributes, or and an
element, "delete it". Each form is one function over the tag at the place; a hint with
"…" in it, or with more than one place, stays a hint.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import replace

from sambot_viz.edits import Extent, SourceFile, Tag, source_of
from sambot_viz.errors import Edit, Place, Problem

_END = r"(?=$|, or |; | to turn |: )"
_ATTRIBUTE = r"[\w:.-]+=\"[^\"…]*\""
_ATTRIBUTES = re.compile(
    rf"(?:write|add) ({_ATTRIBUTE}(?:(?: and | )?{_ATTRIBUTE})*)"
    rf"(?: in the <(\w+)>[^,;<]*| to <([\w:]+)> on line (\d+)| with [^<;…]*)?{_END}"
)
_PAIR = re.compile(r'([\w:.-]+)="([^"]*)"')
_ELEMENT = re.compile(
    r"(?:write|add) (<[^…]*?>)((?: into it| inside it| to the model| before it)?)"
    rf"(?:, (?:or|here or) [^…]*| with [^…]*)?{_END}"
)
_WORDS = re.compile("> [a-z]")
_NUMBERS = re.compile(
    rf"write (\w+(?=$)|[+-]?[\d.]+(?:e[+-]?\d+)?(?: [+-]?[\d.e+-]+)*){_END}"
)
_AROUND = re.compile(r"write ((?:<\w+>)+) before it and ((?:</\w+>)+) behind it$")
_MOVE = re.compile(
    r"move <([\w:]+)> into <(\w+)(?: name=\"([^\"]*)\")?> \(line (\d+)\)$"
)
_DELETE = re.compile(r"delete (?:(it)|<([\w:]+)>|(?:the )?([\w:]+))(?=$|: )")
_OPENS = re.compile(r"<(?=[^\s<>/=\"'!?])")
_BLANKS = re.compile(r"[ \t]*")

_DOUBTFUL = frozenset({"frame-unknown", "launch-world-name", "sdf-joint-to-frame"})
"""Codes whose hint is one of several ways: another file, or another meaning."""

Changes = list[tuple[Extent, str]]
"""Pieces of a text, and what is written for each."""


def with_edits(problems: Iterable[Problem]) -> list[Problem]:
    """Return problems with the edits that their hints say, where they have none."""
    return [
        problem if problem.edits else replace(problem, edits=_edits(problem))
        for problem in problems
    ]


def _edits(problem: Problem) -> tuple[Edit, ...]:
    if problem.file is None or problem.line is None or problem.code in _DOUBTFUL:
        return ()
    for pattern, changes_of in _FORMS:
        said = pattern.match(problem.hint)
        if said is None:
            continue
        place = Place(problem.file, problem.line, problem.column)
        source = source_of(place.file)
        tag = None if source is None else _tag_at(source, place)
        if source is None or tag is None:
            return ()
        changes = changes_of(source, tag, said)
        return tuple(source.edit(place, extent, new) for extent, new in changes)
    return ()


def _tag_at(source: SourceFile, place: Place) -> Tag | None:
    """Read the tag at a place; without a column the last one that is on the line."""
    start = source.offset(place)
    if place.column is not None:
        return source.tag(start)
    end = source.text.find("\n", start)
    end = len(source.text) if end < 0 else end
    opened = [match.start() for match in _OPENS.finditer(source.text, 0, end)]
    tag = source.tag(opened[-1]) if opened else None
    return tag if tag is not None and tag.end > start else None


def _attributes(source: SourceFile, tag: Tag, said: re.Match[str]) -> Changes:
    if said[4]:
        other = _tag_at(source, Place("", int(said[4])))
        if other is None:
            return []
        tag = other
    wanted = said[2] or said[3]
    if wanted and _name(source, tag) != wanted:
        return []
    return _set(source, tag, _PAIR.findall(said[1]))


def _set(source: SourceFile, tag: Tag, pairs: Iterable[tuple[str, str]]) -> Changes:
    """Give attributes values; nothing where a value is computed and the new one not."""
    changes: Changes = []
    added = ""
    for name, value in pairs:
        extent = tag.values.get(name)
        if set(value) & set("<&"):
            return []
        if extent is None:
            added += f' {name}="{value}"'
        elif "$" in source.text[extent.start : extent.end] and "$" not in value:
            return []
        elif source.text[extent.start : extent.end] != value:
            changes.append((extent, value))
    if added:
        changes.append((Extent(tag.rest, tag.rest), added))
    return changes


def _element(source: SourceFile, tag: Tag, said: re.Match[str]) -> Changes:
    """Write an element in place of another, into it, or attributes of its own."""
    written, where = said[1].replace("> and <", "><"), said[2]
    new = SourceFile(written, "")
    first = new.tag(0)
    if first is None or _WORDS.search(written):
        return []
    if where == " before it":
        return [(Extent(tag.name.start - 1, tag.name.start - 1), written)]
    same = _name(new, first) == _name(source, tag)
    if not where and not same and (found := _inner(source, tag, written)):
        return found
    if first.end == len(written) and (same or not first.is_empty):
        values = ((name, written[slice(*at)]) for name, at in first.values.items())
        owner = tag if same else _around(source, tag, _name(new, first))
        return [] if owner is None else _set(source, owner, values)
    inner = [source.tag(at) for at in _inside(source, tag, written)]
    if inner and all(inner) and not where:
        texts = re.findall(r">([^<]+)</", written)
        return [
            (source.text_behind(child), text)
            for child, text in zip(inner, texts, strict=True)
            if child is not None
        ]
    if where or (said[0].startswith("add") and not same):
        return _put_into(source, tag, written)
    end = source.end_of(tag)
    if end is None:
        return []
    old = source.text[tag.name.start - 1 : end]
    inner = source.text[tag.end : end].rpartition("</")[0].strip()
    if "<" in inner or not (same or inner or tag.values):
        # What holds others, or says nothing, is no other way of saying the same.
        return []
    if "$" in old and "$" not in written:
        written = _with_expressions(source, tag, written)
    if "$" in old and "$" not in written:
        return []
    return [(Extent(tag.name.start - 1, end), written)]


def _with_expressions(source: SourceFile, tag: Tag, written: str) -> str:
    """Write the attributes of an element, as the file has them, for their values.

    Returns:
        The text as it was, where an attribute that is computed is not in it.
    """
    names = re.findall(r"<(\w+)>[^<]*</\1>", written)
    for name, extent in tag.values.items():
        value = source.text[extent.start : extent.end]
        if "$" in value and names.count(name) != 1:
            return written
    for name in names:
        if name in tag.values:
            value = source.text[slice(*tag.values[name])]
            inner = rf"(?<=<{name}>)[^<]*(?=</{name}>)"
            written = re.sub(inner, lambda _, value=value: value, written)
    return written


def _wrapped(source: SourceFile, tag: Tag, said: re.Match[str]) -> Changes:
    """Write other elements around one."""
    end, start = source.end_of(tag), tag.name.start - 1
    if end is None:
        return []
    return [(Extent(start, start), said[1]), (Extent(end, end), said[2])]


def _moved(source: SourceFile, tag: Tag, said: re.Match[str]) -> Changes:
    """Move an element, with its line, to the end of another one."""
    other, end = _tag_at(source, Place("", int(said[4]))), source.end_of(tag)
    if other is None or end is None or _name(source, tag) != said[1]:
        return []
    named = other.values.get("name")
    name = None if named is None else source.text[slice(*named)]
    behind = other.end <= tag.name.start - 1 < (source.end_of(other) or other.end)
    # An <origin> may be meant for the link, which has none.
    of_link = said[1] == "origin" and said[2] != "joint"
    if behind or of_link or (_name(source, other), name) != (said[2], said[3]):
        return []
    written = source.text[tag.name.start - 1 : end]
    put = _put_into(source, other, written)
    return [*_without(source, tag, end), *put] if put else []


def _inner(source: SourceFile, tag: Tag, written: str) -> Changes:
    """Give elements in another, each there once and without content, attributes."""
    changes: Changes = []
    elements = [SourceFile(each, "") for each in re.findall(r"<[^<>]+/>", written)]
    if "".join(each.text for each in elements) != written:
        return []
    end = source.end_of(tag) or tag.end
    for new in elements:
        first = new.tag(0)
        name = "" if first is None else _name(new, first)
        found = list(re.finditer(rf"<{name}\b", source.text[tag.end : end]))
        old = source.tag(tag.end + found[0].start()) if len(found) == 1 else None
        if first is None or old is None:
            return []
        pairs = [(key, new.text[slice(*at)]) for key, at in first.values.items()]
        made = _set(source, old, pairs)
        if not made:
            return []
        changes += made
    return changes


def _inside(source: SourceFile, tag: Tag, written: str) -> list[int]:
    """Return where an element has each of the written ones, in it and once; or none."""
    end = source.end_of(tag) or tag.end
    places: list[int] = []
    for name in re.findall(r"<(\w+)>[^<$]+</", written):
        found = [
            match.start()
            for match in re.finditer(rf"<{name}>[^<$]+</", source.text)
            if tag.end <= match.start() < end
        ]
        if len(found) != 1:
            return []
        places += found
    return places


def _around(source: SourceFile, tag: Tag, name: str) -> Tag | None:
    """Return the nearest element of a name that is around another, or None."""
    start = tag.name.start - 1
    pattern = re.compile(rf"<{re.escape(name)}(?=[\s/>])")
    for match in reversed(list(pattern.finditer(source.text, 0, start))):
        other = source.tag(match.start())
        end = None if other is None else source.end_of(other)
        if end is not None and end > start:
            return other
    return None


def _put_into(source: SourceFile, tag: Tag, written: str) -> Changes:
    """Write elements at the end of another, as far to the right as those before."""
    start = tag.name.start - 1
    line = source.text.rfind("\n", 0, start) + 1
    blanks = _BLANKS.match(source.text, line)
    left = blanks[0] if blanks is not None and blanks.end() == start else ""
    if tag.is_empty:
        name = _name(source, tag)
        slash = source.text.rindex("/", 0, tag.end)
        begin = len(source.text[:slash].rstrip())
        return [(Extent(begin, tag.end), f">{written}</{name}>")]
    closing = source.closing_name(tag)
    if closing is None:
        return []
    at = closing.start - 2
    before = source.text[tag.end : at]
    if "\n" not in before:
        return [(Extent(at, at), written)]
    inner = len(before.rstrip()) + tag.end
    return [(Extent(inner, inner), f"\n{left}  {written}")]


def _numbers(source: SourceFile, tag: Tag, said: re.Match[str]) -> Changes:
    """Write other numbers for the text of an element."""
    extent = source.text_behind(tag)
    old = source.text[extent.start : extent.end]
    if tag.is_empty or not old or "$" in old or "=" in old:
        return []
    return [(extent, said[1])]


def _deleted(source: SourceFile, tag: Tag, said: re.Match[str]) -> Changes:
    """Delete an element with its line, or an attribute."""
    if said[3]:
        name, value = tag.names.get(said[3]), tag.values.get(said[3])
        if name is None or value is None:
            return []
        start = len(source.text[: name.start].rstrip())
        return [(Extent(start, value.end + 1), "")]
    end = source.end_of(tag)
    if end is None or (said[2] and said[2] != _name(source, tag)):
        return []
    return _without(source, tag, end)


def _without(source: SourceFile, tag: Tag, end: int) -> Changes:
    start = tag.name.start - 1
    line = source.text.rfind("\n", 0, start) + 1
    behind = source.text.find("\n", end)
    rest = source.text[end : behind if behind >= 0 else len(source.text)]
    if line and not source.text[line:start].strip() and not rest.strip():
        return [(Extent(line - 1, end + len(rest)), "")]
    return [(Extent(start, end), "")]


def _name(source: SourceFile, tag: Tag) -> str:
    return source.text[tag.name.start : tag.name.end]


_FORMS: tuple[
    tuple[re.Pattern[str], Callable[[SourceFile, Tag, re.Match[str]], Changes]],
    ...,
] = (
    (_ATTRIBUTES, _attributes),
    (_AROUND, _wrapped),
    (_MOVE, _moved),
    (_ELEMENT, _element),
    (_NUMBERS, _numbers),
    (_DELETE, _deleted),
)
"""How hints begin, and what each form changes."""
