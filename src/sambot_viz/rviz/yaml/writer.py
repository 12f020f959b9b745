"""Nodes → YAML text: unchanged parts of the file are kept.

Comments, the order of keys, quotes and blank lines survive, because only the changed
pieces of the old text are replaced. New parts are written as RViz writes them: block
style, indented by 2, dashes below their key.
"""

from __future__ import annotations

import re

from sambot_viz.rviz.yaml.yaml_nodes import (
    Collection,
    Entry,
    List,
    Map,
    Node,
    Scalar,
    YamlText,
)

STEP = 2
_NULLS = frozenset({"", "~", "null", "Null", "NULL"})
_PLAIN = re.compile(
    r"""
    (?: [^\s\-?:,\[\]{}\#&*!|>'"%@`] | [\-?:](?=[^\s,\[\]{}]) )  # the first character
    (?: [^\s:\#] | :(?=\S) | (?<=\S)\# | [ ](?=[^\s\#]) )*       # and all others
    """,
    re.VERBOSE,
)
_FLOW_SIGNS = re.compile(r"[,\[\]{}]|:(?=[,\[\]{}])")
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


class Writer:
    """Writes the nodes of one file.

    Args:
        text: the file's text, which the places of the nodes refer to; with "" all of
            it is written as RViz does.
        newline: how lines end in this file.
    """

    def __init__(self, text: str = "", newline: str = "\n"):
        self._text = text
        self._newline = newline
        self._whole = text == ""
        self._changed: dict[int, bool] = {}

    def document(self, root: Node) -> str:
        """Return the whole file."""
        self._note_changes(root)
        if self._whole or root.span is None or not self._can_patch(root):
            return self._fresh_root(root)
        before, after = self._text[: root.span.start], self._text[root.span.end :]
        return before + self._patched(root) + after

    def _note_changes(self, node: Node) -> bool:
        """Find out once what has changed, in every node below this one too."""
        changed = node.changed if isinstance(node, Scalar) else node.reshaped
        if isinstance(node, Collection):
            changed |= any([self._note_changes(e.value) for e in node.entries])
        self._changed[id(node)] = changed
        return changed

    def _fresh_root(self, root: Node) -> str:
        head = "" if root.span is None or self._whole else self._text[: root.span.start]
        if isinstance(root, Collection) and root.entries:
            return head + self._entries(root.entries, 0)
        return head + (scalar_text(root) if isinstance(root, Scalar) else "{}")

    def _can_patch(self, node: Node) -> bool:
        """Return whether the old text of a node can be kept, with changes in it."""
        if self._whole or node.span is None:
            return False
        if not self._changed[id(node)]:
            return True
        if node.alias:
            return False
        if isinstance(node, Scalar):
            return True
        if node.flow:
            values = (entry.value for entry in node.entries)
            return not node.reshaped and all(map(self._can_patch, values))
        return not node.opaque and bool(node.entries and node.original)

    def _patched(self, node: Node, flow: bool = False) -> str:
        """Return the old text of a node with the changes in it."""
        start, end = _bounds(node)
        if not self._changed[id(node)]:
            return self._text[start:end]
        if isinstance(node, Scalar):
            text = scalar_text(node, flow)
            if start == end and not self._text[start - 1].isspace():
                # A missing value begins right behind its colon or dash.
                text = f" {text}"
            broken = self._text[start:end].endswith(("\n", "\r"))
            return text + self._newline if broken else text
        if node.flow:
            return self._patched_flow(node)
        source = node.original[0].source if node.original else None
        if source is None:
            raise AssertionError("a collection without entries cannot be patched")
        anchor = self._text[start : source.lead]
        return anchor + self._entries(node.entries, source.column, source.inline)

    def _patched_flow(self, node: Map | List) -> str:
        parts: list[str] = []
        at, end = _bounds(node)
        for entry in node.entries:
            start, after = _bounds(entry.value)
            parts += [self._text[at:start], self._patched(entry.value, flow=True)]
            at = after
        return "".join(parts) + self._text[at:end]

    def _entries(self, entries: list[Entry], column: int, inline: bool = True) -> str:
        """Entries one below the other; `inline` the first one needs no indentation."""
        parts: list[str] = []
        for entry in entries:
            if parts and not parts[-1].endswith(("\n", "\r")):
                parts.append(self._newline)
            parts.append(self._entry(entry, column, inline and not parts))
        return "".join(parts)

    def _entry(self, entry: Entry, column: int, first: bool) -> str:
        source = None if self._whole else entry.source
        if source is None:
            indent = "" if first else " " * column
            head = "-" if entry.key is None else f"{quoted(entry.key, entry.quote)}:"
            return indent + head + self._fresh_value(entry, column)
        lead = self._lead(source, first)
        if entry.value is entry.given and self._can_patch(entry.value):
            body = self._text[source.start : source.value] + self._patched(entry.value)
            body += self._text[source.tail : source.end]
        else:
            head = self._text[source.start : source.head]
            head += "" if entry.key is None else ":"
            comment = self._comment(source)
            body = head + self._fresh_value(entry, source.column, comment)
        skip = first or source.inline
        shifted = self._shifted(lead + body, column - source.column, skip)
        return " " * column + shifted if source.inline and not first else shifted

    def _lead(self, source: YamlText, first: bool) -> str:
        """Comments and blank lines before an entry, and its indentation."""
        lead = self._text[source.lead : source.start]
        return lead.lstrip(" \t\r\n") if first else lead

    def _comment(self, source: YamlText) -> str:
        """Return the comment after an old value that was on the line of its key."""
        if any(c in self._text[source.head : source.tail] for c in "\r\n"):
            return ""
        return self._text[source.tail : source.end].rstrip("\r\n")

    def _shifted(self, text: str, by: int, skip: bool) -> str:
        """Return the text of an entry, indented more or less; `skip` its first line."""
        if by == 0:
            return text
        lines = text.splitlines(keepends=True)
        for i, line in enumerate(lines):
            if (i == 0 and skip) or not line.strip():
                continue
            if by > 0:
                lines[i] = " " * by + line
            else:
                indent = len(line) - len(line.lstrip(" "))
                lines[i] = line[min(indent, -by) :]
        return "".join(lines)

    def _fresh_value(self, entry: Entry, column: int, comment: str = "") -> str:
        """Return the text after a key's colon or a dash, with the line break."""
        node, end = entry.value, comment + self._newline
        if isinstance(node, Scalar):
            return f" {scalar_text(node)}{end}"
        below = column + STEP
        if not node.entries:
            if isinstance(node, List):
                return f" ~{end}"
            if entry.key is None:
                return " {}" + end
            return f"{end}{' ' * below}{{}}{self._newline}"
        if entry.key is None and isinstance(node, Map):
            return f" {self._entries(node.entries, below)}"
        return f"{end}{' ' * below}{self._entries(node.entries, below)}"


def _bounds(node: Node) -> tuple[int, int]:
    return (0, 0) if node.span is None else (node.span.start, node.span.end)


def scalar_text(node: Scalar, flow: bool = False) -> str:
    """Return a scalar on one line.

    Args:
        node: what to write; a text that was quoted stays quoted.
        flow: it is in braces or brackets, where commas mean something.

    Returns:
        Text that reads back as the same scalar.
    """
    if node.null:
        return "~"
    return quoted(node.text, node.quote, flow)


def quoted(text: str, quote: str = "", flow: bool = False) -> str:
    """A text as YAML, in the given quotes if it can be, plain if it need not be."""
    if quote in ("", "|", ">") and _can_be_plain(text, flow):
        return text
    if quote == "'" and text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    return '"' + "".join(map(_escaped, text)) + '"'


def _can_be_plain(text: str, flow: bool) -> bool:
    if text in _NULLS or text in ("=", "<<") or not text.isprintable():
        return False
    if text.startswith(("---", "...")) or _PLAIN.fullmatch(text) is None:
        return False
    return not (flow and _FLOW_SIGNS.search(text))


def _escaped(character: str) -> str:
    if character in _ESCAPES:
        return _ESCAPES[character]
    if character.isprintable():
        return character
    code = ord(character)
    if code < 0x100:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"
