"""How a text is written in YAML: plain where YAML allows it, as RViz writes."""

from __future__ import annotations

import re

from sambot_viz.rviz.yaml.nodes import Scalar

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


def scalar_text(node: Scalar, flow: bool = False) -> str:
    """A scalar on one line.

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
