"""Macros of xacro and their calls, as the files of a model have them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from sambot_viz.edits import Extent, SourceFile, Tag, source_of
from sambot_viz.errors import Edit, Place, Problem
from sambot_viz.files import relative_path

_TAGS = re.compile(r"<!--.*?-->|<(?=(?:xacro:)?\w)", re.DOTALL)
_PARAMETER = re.compile(r"(?<=[\s\"'])\*{0,2}(\w+)(?::?=('[^']*'|\"[^\"]*\"|\S+))?")
_END = "</xacro:macro>"


class Written(NamedTuple):
    """A piece of the text of a file."""

    file: str
    source: SourceFile
    extent: Extent

    @property
    def text(self) -> str:
        """What is written there."""
        return self.source.text[slice(*self.extent)]

    @property
    def place(self) -> Place:
        """Where it begins."""
        return Place(self.file, *self.source.place(self.extent.start))

    def edit(self, new: str) -> Edit:
        """Return the edit that writes another text there."""
        return self.source.edit(Place(self.file, 1), self.extent, new)


@dataclass(frozen=True, slots=True)
class MacroText:
    """A macro around a place.

    Attributes:
        name: its name.
        defaults: parameter → where its default is; None without one.
        body: what is in it.
    """

    name: str
    defaults: Mapping[str, Written | None]
    body: Written


@dataclass(frozen=True, slots=True)
class CallText:
    """A call of a macro.

    Attributes:
        tag: all of its start tag.
        values: parameter → the value that is written in it.
    """

    tag: Written
    values: Mapping[str, Written]


def tags_in(source: SourceFile) -> Iterator[Tag]:
    """Yield the start tags of a file that are in no comment."""
    for match in _TAGS.finditer(source.text):
        tag = source.tag(match.start())
        if tag is not None:
            yield tag


def macro_around(file: str, source: SourceFile, offset: int) -> MacroText | None:
    """Return the macro around an offset of a file, or None."""
    start = source.text.rfind("<xacro:macro", 0, offset)
    tag = source.tag(start) if start >= 0 else None
    end = -1 if tag is None else source.text.find(_END, tag.end)
    name = None if tag is None else tag.values.get("name")
    if tag is None or name is None or not tag.end <= offset < end:
        return None
    params = tag.values.get("params", Extent(tag.rest, tag.rest))
    defaults: dict[str, Written | None] = {}
    for one in _PARAMETER.finditer(source.text, *params):
        given = one[2] is not None
        piece = Written(file, source, Extent(*one.span(2))) if given else None
        defaults[one[1]] = piece
    body = Written(file, source, Extent(tag.end, end))
    return MacroText(source.text[slice(*name)], defaults, body)


def sources(files: Iterable[str]) -> list[tuple[str, SourceFile]]:
    """Return the files that can be read, each once, by the first of its names."""
    once: dict[str, str] = {}
    for file in files:
        once.setdefault(os.path.abspath(file), file)
    found = ((file, source_of(file)) for file in once.values())
    return [(file, source) for file, source in found if source is not None]


def as_written(files: Iterable[str], problem: Problem) -> list[str]:
    """Return paths in the way in which a finding has its own: relative, or not."""
    if os.path.isabs(problem.file or ""):
        return list(files)
    return [relative_path(file) if os.path.isabs(file) else file for file in files]


def calls_of(name: str, files: Sequence[tuple[str, SourceFile]]) -> list[CallText]:
    """Return the calls of a macro, those with a namespace too: <xacro:ns.name>.

    Args:
        name: of the macro.
        files: all files of the model.
    """
    calls: list[CallText] = []
    for file, source in files:
        if name not in source.text:
            continue
        for tag in tags_in(source):
            if is_call(source.text[slice(*tag.name)], name):
                extent = Extent(tag.name.start - 1, tag.end)
                values = {
                    key: Written(file, source, at) for key, at in tag.values.items()
                }
                calls.append(CallText(Written(file, source, extent), values))
    return calls


def is_call(tag: str, name: str) -> bool:
    """Return whether an element with this name calls a macro."""
    prefix, _, called = tag.partition(":")
    return prefix == "xacro" and (called == name or called.endswith(f".{name}"))


def properties_in(
    files: Sequence[tuple[str, SourceFile]],
) -> Iterator[tuple[str, Written]]:
    """Yield the names of properties, and their values as they are written."""
    for file, source in files:
        for tag in tags_in(source):
            named, value = tag.values.get("name"), tag.values.get("value")
            is_property = source.text[slice(*tag.name)] == "xacro:property"
            if is_property and named is not None and value is not None:
                yield source.text[slice(*named)], Written(file, source, value)


def property_value(name: str, files: Sequence[tuple[str, SourceFile]]) -> float | None:
    """Return the number that a property is set to; None for others, or for several."""
    values = [value for named, value in properties_in(files) if named == name]
    try:
        return float(values[0].text) if len(values) == 1 else None
    except ValueError:
        return None
