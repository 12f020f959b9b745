"""YAML text → nodes that know their place in it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, cast

import yaml

from sambot_viz import limits
from sambot_viz.rviz.yaml.yaml_nodes import (
    Collection,
    Entry,
    List,
    Map,
    Node,
    Scalar,
    Span,
    YamlText,
    copied,
)

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_parse_events: Any = cast(Any, yaml).parse
_NULLS = frozenset({"", "~", "null", "Null", "NULL"})
_TO_LINE_END = re.compile(r"[ \t]*(?:#[^\r\n]*)?(?:\r\n|\r|\n|\Z)")
_GAP = re.compile(r"(?:[ \t\r\n]+|#[^\r\n]*)*")
_ANCHORS = re.compile(r"(?:[ \t]*[&!][^\s]*)+[ \t]*(?:#[^\r\n]*)?(?:\r\n|\r|\n)")
"""The anchor and the tag of a whole map or list are on a line above it."""


class ParseFault(Exception):
    """Something that YAML allows and that is refused here.

    Attributes:
        reason: what it is.
        remedy: what to do about it.
        line: its line, from 1.
        column: its column, from 1.
    """

    def __init__(self, reason: str, remedy: str, line: int, column: int):
        super().__init__(reason)
        self.reason, self.remedy = reason, remedy
        self.line, self.column = line, column


def parse(text: str) -> Node | None:
    """Read the first document of a YAML stream.

    Args:
        text: the file, decoded, with its own line breaks.

    Returns:
        Its root; None if the stream has no document.

    Raises:
        yaml.YAMLError: the text is not YAML.
        ParseFault: it is too deep or too large, or an alias is unknown or contains
            itself.
    """
    reader = _Reader(text)
    for event in reader.events:
        if isinstance(event, yaml.DocumentStartEvent):
            return reader.node(next(reader.events), 0)
    return None


class _Reader:
    def __init__(self, text: str):
        self.text = text
        self.events = cast("Iterator[Any]", _parse_events(text, Loader=_LOADER))
        self.anchors: dict[str, Node | None] = {}
        self.nodes = 0
        self.flow = 0

    def node(self, event: Any, depth: int, after: int | None = None) -> Node:
        """Read a node; `after` is where the key or dash before it ends."""
        self._require_room(event, 1, depth)
        if isinstance(event, yaml.AliasEvent):
            return self._alias(event, depth)
        anchor: str | None = event.anchor
        if anchor is not None:
            self.anchors[anchor] = None
        if isinstance(event, yaml.ScalarEvent):
            node: Node = _scalar(event)
        else:
            node = self._collection(event, depth, after)
        if anchor is not None:
            self.anchors[anchor] = node
        return node

    def _require_room(self, event: Any, size: int, depth: int) -> None:
        """Refuse documents that are nested too deeply or too large."""
        if depth > limits.CONFIG_DEPTH.value:
            why = "lists and maps are nested too deeply"
            raise _fault(
                event, why, f"nest them at most {limits.CONFIG_DEPTH.value} deep"
            )
        self.nodes += size
        most = limits.CONFIG_VALUES.value
        if self.nodes > most:
            why = f"the file has more than {most:,} names and values"
            raise _fault(event, why, "remove what is not needed, or split the file")

    def _alias(self, event: Any, depth: int) -> Node:
        target = self.anchors.get(event.anchor)
        if target is None:
            known = event.anchor in self.anchors
            why = "is inside what it names" if known else "names no anchor above it"
            why = f"the alias *{event.anchor} {why}"
            raise _fault(event, why, "write the value out")
        size, height = _extent(target)
        self._require_room(event, size, depth + height)
        node = _as_original(copied(target))
        node.span = _span(event)
        node.alias = True
        return node

    def _collection(self, event: Any, depth: int, after: int | None) -> Node:
        is_map = isinstance(event, yaml.MappingStartEvent)
        node = Map() if is_map else List()
        node.span = _span(event)
        node.flow = bool(event.flow_style)
        self.flow += node.flow
        end = start = self._body_start(node, after)
        while not isinstance(
            first := next(self.events), (yaml.MappingEndEvent, yaml.SequenceEndEvent)
        ):
            key = self.node(first, depth + 1) if is_map else None
            after = _known(key).end if key else self._after_dash(end)
            value = self.node(next(self.events) if key else first, depth + 1, after)
            entry = self._entry(node, key, value, end)
            node.entries.append(entry)
            end = entry.source.end if entry.source else _known(value).end
        if node.flow:
            end = first.end_mark.index
        self.flow -= node.flow
        node.span = Span(start, end, node.span.line, node.span.column)
        node.original = tuple(node.entries)
        return node

    def _body_start(self, node: Map | List, after: int | None) -> int:
        """Return the start of a map or list: of the comments above its first entry."""
        start = _known(node).start
        if node.flow or self.flow or after is None:
            return start
        broken = self.text.find("\n", after, start)
        return broken + 1 if broken >= 0 else start

    def _after_dash(self, lead: int) -> int:
        return _matched(_GAP, self.text, _matched(_ANCHORS, self.text, lead)) + 1

    def _entry(self, parent: Collection, key: Node | None, value: Node, lead: int):
        span = _known(key or value)
        text, quote = None, ""
        if isinstance(key, Scalar):
            text, quote = key.text, key.quote
        elif key is not None:
            text = self.text[span.start : span.end]
        entry = Entry(text, value, value, quote=quote)
        if not self.flow:
            entry.source = self._source(parent, key, value, lead)
        return entry

    def _source(
        self, parent: Collection, key: Node | None, value: Node, lead: int
    ) -> YamlText | None:
        """Return the place of an entry that has separate lines."""
        if not parent.entries:
            lead = _matched(_ANCHORS, self.text, lead)
        start = _matched(_GAP, self.text, lead)
        if key is None and self.text[start : start + 1] != "-":
            parent.opaque = True
            return None
        if key is not None and (start != _known(key).start or key.changed):
            # A question mark is before the key, or the key is an alias.
            parent.opaque = True
            return None
        line = max(self.text.rfind(end, 0, start) for end in "\r\n") + 1
        tail = _known(value).end
        return YamlText(
            lead=lead,
            start=start,
            head=_known(key).end if key is not None else start + 1,
            value=_known(value).start,
            tail=tail,
            end=self._line_end(tail),
            column=start - line,
            inline=not parent.entries and lead > line,
        )

    def _line_end(self, tail: int) -> int:
        """Return the position after the comment and line break of a one-line value."""
        if self.text[tail - 1 : tail] in ("\n", "\r"):
            return tail
        return _matched(_TO_LINE_END, self.text, tail)


def _matched(pattern: re.Pattern[str], text: str, start: int) -> int:
    """Return the end of a match that begins at `start`."""
    match = pattern.match(text, start)
    return match.end() if match else start


def _scalar(event: Any) -> Scalar:
    quote = "" if event.style in (None, "") else str(event.style)
    null = quote == "" and event.implicit[0] and event.value in _NULLS
    return Scalar(event.value, null, quote, _span(event), event.value)


def _span(event: Any) -> Span:
    mark = event.start_mark
    return Span(mark.index, event.end_mark.index, mark.line + 1, mark.column + 1)


def _known(node: Node) -> Span:
    if node.span is None:
        raise AssertionError("a node from a file has a place")
    return node.span


def _extent(node: Node) -> tuple[int, int]:
    """Return how many nodes there are in a node, itself too, and how deep they nest."""
    if isinstance(node, Scalar):
        return 1, 0
    inner = [_extent(entry.value) for entry in node.entries]
    size = 1 + sum(size for size, _ in inner)
    return size, 1 + max((height for _, height in inner), default=0)


def _as_original(node: Node) -> Node:
    """Make the present state of what an alias repeats the state in the file."""
    if isinstance(node, Scalar):
        node.original = node.text
        return node
    node.original = tuple(node.entries)
    for entry in node.entries:
        entry.given = _as_original(entry.value)
    return node


def _fault(event: Any, reason: str, remedy: str) -> ParseFault:
    mark = event.start_mark
    return ParseFault(reason, remedy, mark.line + 1, mark.column + 1)
