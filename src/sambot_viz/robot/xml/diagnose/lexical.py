"""Messages for lexical errors of XML, in a table."""

from __future__ import annotations

import re

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.lexer import CURLY, LexicalError, LexicalErrorKind
from sambot_viz.robot.xml.diagnose.source_text import SourceText

_ROWS: dict[LexicalErrorKind, tuple[str, str]] = {
    "ampersand": ("a bare & is not allowed in XML", "write &amp; instead of &"),
    "attribute-twice": ("<{tag}> has the attribute {text} twice", "keep one {text}"),
    "attributes-run-together": (
        "in <{tag}> the attribute {text} comes directly after the value before it",
        "put a blank before {text}",
    ),
    "comment-double-hyphen": (
        'a comment may not contain "--" or end with "-"',
        "{single_hyphens}",
    ),
    "comment-nested": (
        "the comment opened on line {outer_line} contains another <!--: comments "
        "cannot be inside each other, the first --> ends both",
        "close the first comment with --> before line {line}, or delete the inner "
        "<!-- and its -->",
    ),
    "comment-not-closed": (
        "the comment opened on line {line} is never closed, so it swallows the rest "
        "of the file",
        "end it with -->",
    ),
    "less-than": (
        "a bare < is not allowed in a value of <{tag}>",
        "write &lt; instead of <",
    ),
    "quote-not-closed": (
        "the quote that opens {text} in <{tag}> is never closed",
        "write {quote} at the end of the value",
    ),
    "quotes-curly": (
        "{name} in <{tag}> has curly quotes (“ ”), probably pasted from a web page "
        "or a document",
        'use straight quotes: {name}="{value}"',
    ),
    "quotes-missing": (
        "the value of {name} in <{tag}> has no quotes",
        'write {name}="{value}"',
    ),
    "tag-not-ended": (
        "the tag {first_line} is not ended: its > is missing",
        "write > (or />) at its end",
    ),
}
"""Message and hint of each kind; the words in braces are made in `lexical_problem`."""


def lexical_problem(source: SourceText, file: str, error: LexicalError) -> Problem:
    """Make the problem for a lexical error.

    Args:
        source: the text.
        file: its name, for the place.
        error: an error of that text.
    """
    offset = error.offset
    around = (t.start for t in source.read.tokens if t.start < offset < t.end)
    name, _, value = error.text.partition("=")
    facts = {
        "tag": error.tag,
        "text": error.text,
        "line": source.line(offset),
        "outer_line": source.line(next(around, offset)),
        "name": name,
        "value": value.strip(CURLY),
        "quote": source.text[offset],
        "first_line": error.text.partition("\n")[0][:60],
        "single_hyphens": _single_hyphens(error.text),
    }
    message, hint = (part.format_map(facts) for part in _ROWS[error.kind])
    return source.error(file, f"xml-{error.kind}", offset, message, hint)


def _single_hyphens(comment: str) -> str:
    """Advise what to write for a comment with "--"."""
    words = re.sub("-{2,}", "-", comment.strip("- \n"))
    if words.strip("- ") and "\n" not in comment and len(comment) <= 60:
        return f"write <!-- {words} -->"
    return "use one hyphen, or = signs"
