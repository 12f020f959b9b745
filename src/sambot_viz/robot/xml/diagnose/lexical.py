"""Messages for lexical errors of XML, in a table."""

from __future__ import annotations

import re
from dataclasses import dataclass

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.lexer import CURLY
from sambot_viz.robot.xml.diagnose.source_text import SourceText
from sambot_viz.robot.xml.diagnose.tokens import LexicalError

_ROWS: tuple[tuple[str, str, str, str], ...] = (
    ("xml-ampersand", "", "a bare & is not allowed in XML", "write &amp; instead of &"),
    (
        "xml-attribute-twice",
        "",
        "<{x.tag}> has the attribute {x.text} twice",
        "keep one {x.text}",
    ),
    (
        "xml-attribute-without-value",
        "",
        "in <{x.tag}> the attribute {x.text} has no value",
        'write {x.text}="…", or delete it',
    ),
    (
        "xml-attributes-run-together",
        "",
        "in <{x.tag}> the attribute {x.text} comes directly after the value before it",
        "put a blank before {x.text}",
    ),
    (
        "xml-comment-double-hyphen",
        r"(?=.*[^\s-])[^\n]{1,60}$",
        'a comment may not contain "--" or end with "-"',
        "write <!-- {x.single_hyphens} -->",
    ),
    (
        "xml-comment-double-hyphen",
        "",
        'a comment may not contain "--" or end with "-"',
        "use one hyphen, or = signs",
    ),
    (
        "xml-comment-malformed",
        "",
        "a comment begins with <!-- and nothing else",
        "write <!-- … -->",
    ),
    (
        "xml-comment-nested",
        "",
        "the comment opened on line {x.outer_line} contains another <!--: comments "
        "cannot be inside each other, the first --> ends both",
        "close the first comment with --> before line {x.line}, or delete the inner "
        "<!-- and its -->",
    ),
    (
        "xml-comment-not-closed",
        "",
        "the comment opened on line {x.line} is never closed, so it swallows the rest "
        "of the file",
        "end it with -->",
    ),
    (
        "xml-entity-undefined",
        "",
        "&{x.text}; is not defined in XML",
        "XML knows only &amp; &lt; &gt; &quot; &apos;: write the character itself",
    ),
    (
        "xml-less-than",
        "",
        "a bare < is not allowed{x.in_value}",
        "write &lt; instead of <",
    ),
    (
        "xml-quote-in-value",
        "",
        "the quote {x.quote} inside the expression ends the value too early",
        "use the other quote inside: {x.other_quotes}",
    ),
    (
        "xml-quote-not-closed",
        "",
        "the quote that opens {x.text} in <{x.tag}> is never closed",
        "write {x.quote} at the end of the value",
    ),
    (
        "xml-quotes-curly",
        "",
        "{x.name} in <{x.tag}> has curly quotes (“ ”), probably pasted from a web page "
        "or a document",
        'use straight quotes: {x.name}="{x.value}"',
    ),
    (
        "xml-quotes-missing",
        "",
        "the value of {x.name} in <{x.tag}> has no quotes",
        'write {x.name}="{x.value}"',
    ),
    (
        "xml-tag-malformed",
        r"<\s*[/\\]",
        "{x.text} is not a tag: the name must follow < or </ directly, and a closing "
        "tag contains nothing else",
        "write </{x.tag}>",
    ),
    (
        "xml-tag-malformed",
        "<",
        "{x.text} is not a tag: the name must follow < or </ directly, and a closing "
        "tag contains nothing else",
        "write <{x.tag} …>",
    ),
    (
        "xml-tag-malformed",
        "/$",
        "in <{x.tag}> the slash is not directly before >",
        "write /> without anything between",
    ),
    (
        "xml-tag-malformed",
        "",
        "in <{x.tag}> there is the character {x.text} where an attribute or > is "
        "expected",
        "delete it, or look for a missing or extra quote before it",
    ),
    (
        "xml-tag-not-ended",
        "",
        "the tag {x.first_line} is not ended: its > is missing",
        "write > (or />) at its end",
    ),
)
"""Code, a pattern for the text of the error, message, hint. The first row that fits
counts; {x.…} is a property of `_Facts`."""


def lexical_problem(source: SourceText, file: str, error: LexicalError) -> Problem:
    """The problem for a lexical error.

    Args:
        source: the text.
        file: its name, for the place.
        error: an error of that text.
    """
    facts = _Facts(source, error)
    code, _, message, hint = next(
        row
        for row in _ROWS
        if row[0] == f"xml-{error.kind}" and re.match(row[1], error.text)
    )
    message, hint = message.format(x=facts), hint.format(x=facts)
    return source.error(file, code, error.offset, message, hint)


@dataclass(frozen=True, slots=True)
class _Facts:
    """What a sentence can name."""

    source: SourceText
    error: LexicalError

    @property
    def tag(self) -> str:
        return self.error.tag

    @property
    def text(self) -> str:
        return self.error.text

    @property
    def line(self) -> int:
        return self.source.line(self.error.offset)

    @property
    def name(self) -> str:
        return self.text.partition("=")[0]

    @property
    def value(self) -> str:
        return self.text.partition("=")[2].strip(CURLY)

    @property
    def first_line(self) -> str:
        return self.text.splitlines()[0][:60]

    @property
    def single_hyphens(self) -> str:
        return re.sub("-{2,}", "-", self.text.strip("- \n"))

    @property
    def in_value(self) -> str:
        return f" in a value of <{self.tag}>" if self.tag else ""

    @property
    def quote(self) -> str:
        return self.source.text[self.error.offset]

    @property
    def other_quotes(self) -> str:
        return self.text.replace(self.quote, "'" if self.quote == '"' else '"')

    @property
    def outer_line(self) -> int:
        offset = self.error.offset
        tokens = self.source.tokens
        return self.source.line(
            next(t.start for t in tokens if t.start < offset < t.end)
        )
