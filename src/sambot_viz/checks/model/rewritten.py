"""Edit numbers at their source: in an element, a property or a call."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from sambot_viz.checks.rule import number
from sambot_viz.edits import Extent, SourceFile, Tag, source_of
from sambot_viz.errors import Edit, Place
from sambot_viz.robot.xacro.macro_texts import is_call

_PART = re.compile(r"\$\{([^}]*)\}|[^\s$]+")
_NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*(?!\s*\()")
_TAGS = re.compile(r"<(?=(?:xacro:)?\w)")
_DEEPEST = 4

Change = Callable[[float], float]
"""Returns the right number for a wrong one."""


@dataclass(frozen=True, slots=True)
class Rewriting:
    """Makes edits that change numbers of a model.

    Attributes:
        files: those of the model.
        change: returns the new value of a number.
    """

    files: Sequence[str]
    change: Change

    def attributes(self, place: Place | None, *names: str, most: int = 9) -> list[Edit]:
        """Return the edits of attributes, or of child elements with these names.

        Args:
            place: the beginning of the element.
            names: the attributes; "" for the text of the element itself.
            most: the greatest number of values to change in a list.

        Returns:
            The edits of literal numbers; computed ones have none.
        """
        source = None if place is None else source_of(place.file)
        tag = (
            None
            if place is None or source is None
            else source.tag(source.offset(place))
        )
        if place is None or source is None or tag is None:
            return []
        edits: list[Edit] = []
        for extent in _values(source, tag, names):
            edits += self._in(place.file, source, extent, most, 0)
        return edits

    def _in(
        self, file: str, source: SourceFile, extent: Extent, most: int, depth: int
    ) -> Iterator[Edit]:
        for part in list(_PART.finditer(source.text, *extent))[:most]:
            if part[1] is None:
                yield from self._number(file, source, Extent(*part.span()))
            elif depth < _DEEPEST:
                macro, params = _macro_around(source, part.start())
                for name in dict.fromkeys(_NAME.findall(part[1])):
                    calls = f"xacro:{macro}" if name in params else "xacro:property"
                    yield from self._named(name, calls, most, depth + 1)

    def _number(self, file: str, source: SourceFile, extent: Extent) -> Iterator[Edit]:
        try:
            value = float(source.text[extent.start : extent.end])
        except ValueError:
            return
        better = number(self.change(value))
        if float(better) != value:
            yield source.edit(Place(file, 1), extent, better)

    def _named(self, name: str, by: str, most: int, depth: int) -> Iterator[Edit]:
        """Yield the edits of a property, or of the calls that set a parameter."""
        for file in self.files:
            source = source_of(file)
            if source is None or name not in source.text:
                continue
            for match in _TAGS.finditer(source.text):
                tag = source.tag(match.start())
                extent = None if tag is None else _given(source, tag, by, name)
                if extent is not None:
                    yield from self._in(file, source, extent, most, depth)


def _given(source: SourceFile, tag: Tag, by: str, name: str) -> Extent | None:
    """Return the place where a tag sets a property or a macro's parameter."""
    if not is_call(source.text[slice(*tag.name)], by.removeprefix("xacro:")):
        return None
    if by != "xacro:property":
        return tag.values.get(name)
    named = tag.values.get("name")
    same = named is not None and source.text[named.start : named.end] == name
    return tag.values.get("value") if same else None


def _macro_around(source: SourceFile, offset: int) -> tuple[str, list[str]]:
    """Return the name of the macro around an offset, and its parameters."""
    start = source.text.rfind("<xacro:macro", 0, offset)
    tag = source.tag(start) if start >= 0 else None
    if tag is None or source.text.find("</xacro:macro>", start, offset) >= 0:
        return "", []
    name, params = (
        "" if at is None else source.text[at.start : at.end]
        for at in (tag.values.get("name"), tag.values.get("params"))
    )
    return name, re.findall(r"(?:^|\s)\*{0,2}(\w+)", params)


def _values(source: SourceFile, tag: Tag, names: Sequence[str]) -> Iterator[Extent]:
    end = source.end_of(tag) or tag.end
    for name in names:
        if name in tag.values:
            yield tag.values[name]
        elif not name:
            yield source.text_behind(tag)
        else:
            inner = re.compile(rf"<{name}(?=[\s>])").search(source.text, tag.end, end)
            child = None if inner is None else source.tag(inner.start())
            if child is not None and not child.is_empty:
                yield source.text_behind(child)
