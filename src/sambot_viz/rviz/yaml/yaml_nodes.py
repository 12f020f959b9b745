"""The tree of a YAML document as RViz sees it: maps, lists and text.

RViz knows no numbers and no booleans in a file, only text; null is "nothing given".
Every node read from a file remembers its place in the text,
so that saving changes only what was changed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias, TypeVar, Union

Plain: TypeAlias = Union[str, "dict[str, Plain]", "list[Plain]", None]
"""A node as ordinary Python values: text, None for null, dicts and lists."""


class Span(NamedTuple):
    """The place of something in the text of the file.

    Attributes:
        start: index of its first character.
        end: index after its last character.
        line: line of its first character, from 1.
        column: column of its first character, from 1.
    """

    start: int
    end: int
    line: int
    column: int


@dataclass(eq=False, slots=True)
class Scalar:
    """One text.

    Attributes:
        text: what it says; of a null, how it was written ("", "~", "null").
        null: nothing is given.
        quote: how it was written: "" plain, "'", '"', "|" or ">".
        span: its place in the file; None when it was made here.
        original: `text` as the file has it.
        alias: it repeats an anchor elsewhere (``*name``).
    """

    text: str
    null: bool = False
    quote: str = ""
    span: Span | None = None
    original: str | None = None
    alias: bool = False

    @property
    def changed(self) -> bool:
        """Return whether it says something else than in the file."""
        return self.text != self.original

    def assign(self, text: str) -> None:
        """Change the text; the same text is not a change."""
        if self.null:
            self.null, self.original = False, None
        self.text = text


class YamlText(NamedTuple):
    """The place of an entry of a map or list in the file.

    Attributes:
        lead: index after the previous entry; comments and indentation follow.
        start: index of the key, or of a list's dash.
        head: index after the key, or after the dash.
        value: index of the value.
        tail: index after the value.
        end: index after the comment that follows the value, and its line break.
        column: indentation of the entry.
        inline: whether it followed a dash, without its own indentation.
    """

    lead: int
    start: int
    head: int
    value: int
    tail: int
    end: int
    column: int
    inline: bool


@dataclass(eq=False, slots=True)
class Entry:
    """A key with its value, or an item of a list (whose key is None).

    Attributes:
        key: the key, however it was quoted.
        value: the value it has now.
        given: the value it had in the file.
        source: its place there; None in braces or brackets, or if it cannot be edited
            in place.
        quote: how the key was quoted.
    """

    key: str | None
    value: Node
    given: Node | None = None
    source: YamlText | None = None
    quote: str = ""


C = TypeVar("C", "Map", "List")


@dataclass(eq=False, slots=True)
class Collection:
    """Base of maps and lists.

    Attributes:
        entries: in the order of the file.
        span: its place in the file; None when it was made here.
        original: the entries it had in the file.
        flow: it is written in braces or brackets.
        opaque: it is written in a way that cannot be edited in place.
        alias: it repeats an anchor elsewhere (``*name``).
    """

    entries: list[Entry] = field(default_factory=list["Entry"])
    span: Span | None = None
    original: tuple[Entry, ...] | None = None
    flow: bool = False
    opaque: bool = False
    alias: bool = False

    @property
    def reshaped(self) -> bool:
        """Return whether entries were added, removed, moved or given another node."""
        return self.original is None or not (
            len(self.entries) == len(self.original)
            and all(a is b for a, b in zip(self.entries, self.original, strict=True))
            and all(entry.value is entry.given for entry in self.entries)
        )

    @property
    def changed(self) -> bool:
        """Return whether it or anything in it differs from the file."""
        return self.reshaped or any(entry.value.changed for entry in self.entries)


@dataclass(eq=False, slots=True)
class Map(Collection):
    """A map; where a key is given twice, the later one counts."""

    def entry(self, key: str) -> Entry | None:
        """Return the entry that holds for a key."""
        for entry in reversed(self.entries):
            if entry.key == key:
                return entry
        return None

    def get(self, key: str) -> Node | None:
        """Return the value of a key; None when it is missing or null."""
        entry = self.entry(key)
        if entry is None or (isinstance(entry.value, Scalar) and entry.value.null):
            return None
        return entry.value

    def text(self, key: str) -> str | None:
        """Return the text of a key; None when it is missing, null, a map or a list."""
        node = self.get(key)
        return node.text if isinstance(node, Scalar) else None

    def keys(self) -> Iterator[str]:
        """Yield each key once, in the order of the file."""
        return iter(dict.fromkeys(e.key for e in self.entries if e.key is not None))

    def made(self, key: str, kind: type[C]) -> C:
        """Return the map or list of a key; an empty one is put where there is none."""
        found = self.get(key)
        if not isinstance(found, kind):
            found = kind()
            self.put(key, found)
        return found

    def put(self, key: str, value: Node) -> None:
        """Give a key another value; a new key goes where RViz would write it.

        RViz writes keys in the order of their characters. Where the file keeps that
        order, so does the new key; otherwise it becomes the last one.
        """
        entry = self.entry(key)
        if entry is not None:
            entry.value = value
            return
        keys = [e.key or "" for e in self.entries]
        index = len(keys)
        if keys == sorted(keys):
            index = sum(1 for known in keys if known < key)
        self.entries.insert(index, Entry(key, value))

    def put_text(self, key: str, text: str) -> None:
        """Give a key a text; the way its old text was quoted stays."""
        node = self.get(key)
        if isinstance(node, Scalar):
            node.assign(text)
        else:
            self.put(key, Scalar(text))

    def remove(self, key: str) -> None:
        """Remove a key, also when it is given several times."""
        self.entries[:] = [e for e in self.entries if e.key != key]


@dataclass(eq=False, slots=True)
class List(Collection):
    """A list; its entries have no keys."""

    @property
    def items(self) -> list[Node]:
        """The values, in order."""
        return [entry.value for entry in self.entries]


Node: TypeAlias = Scalar | Map | List


def plain(node: Node | None) -> Plain:
    """Return the node as ordinary Python values."""
    if isinstance(node, Map):
        return {key: plain(node.get(key)) for key in node.keys()}
    if isinstance(node, List):
        return [plain(item) for item in node.items]
    return None if node is None or node.null else node.text


def items_of(node: Node | None) -> list[tuple[Entry, Map]]:
    """Return the maps in a list of the file, with their entries."""
    if not isinstance(node, List):
        return []
    return [(e, e.value) for e in node.entries if isinstance(e.value, Map)]


def copied(node: Node) -> Node:
    """Return a copy that belongs to no place in the file."""
    if isinstance(node, Scalar):
        return Scalar(node.text, node.null, node.quote)
    return copied_map(node) if isinstance(node, Map) else List(_copied_entries(node))


def copied_map(node: Map) -> Map:
    """Return a copy of a map that belongs to no place in the file."""
    return Map(_copied_entries(node))


def _copied_entries(node: Map | List) -> list[Entry]:
    return [Entry(e.key, copied(e.value), quote=e.quote) for e in node.entries]


def same(first: Node, second: Node) -> bool:
    """Return whether two nodes say the same, whatever the way they are written.

    An empty list and a null are the same: RViz writes "~" for both.
    """
    if _is_nothing(first) or _is_nothing(second):
        return _is_nothing(first) and _is_nothing(second)
    if isinstance(first, Scalar) or isinstance(second, Scalar):
        if not (isinstance(first, Scalar) and isinstance(second, Scalar)):
            return False
        return first.text == second.text
    if type(first) is not type(second) or len(first.entries) != len(second.entries):
        return False
    pairs = zip(first.entries, second.entries, strict=True)
    return all(a.key == b.key and same(a.value, b.value) for a, b in pairs)


def _is_nothing(node: Node) -> bool:
    return node.null if isinstance(node, Scalar) else _is_empty_list(node)


def _is_empty_list(node: Map | List) -> bool:
    return isinstance(node, List) and not node.entries
