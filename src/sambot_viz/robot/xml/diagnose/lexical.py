"""What each slip inside a text is called, and its mend (spec/ros-nodes.md §6.7)."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from sambot_viz.robot.xml.diagnose.lexer import CURLY, LexicalError, SlipKind
from sambot_viz.robot.xml.diagnose.source_text import SourceText


def _ampersand(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    return "a bare & is not allowed in XML", "write &amp; instead of &"


def _attribute_twice(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    return (
        f"<{slip.tag}> has the attribute {slip.text} twice",
        f"keep one {slip.text}",
    )


def _attribute_without_value(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    return (
        f"in <{slip.tag}> the word {slip.text} has no value",
        f'write {slip.text}="…", or delete it',
    )


def _run_together(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    return (
        f"in <{slip.tag}> the attribute {slip.text} stands directly behind the "
        "value before it",
        f"put a blank before {slip.text}",
    )


def _double_hyphen(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    shown = re.sub("-{2,}", "-", slip.text.strip("- \n"))
    comment = f"<!-- {shown} -->" if len(shown) <= 60 and "\n" not in shown else ""
    return (
        'a comment may not contain "--" or end with "-"',
        f"write {comment}" if shown and comment else "use one hyphen, or = signs",
    )


def _comment_malformed(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    return "a comment begins with <!-- and nothing else", "write <!-- … -->"


def _comment_nested(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    outer = next(
        t.start for t in source.tokens if t.start < slip.offset and slip.offset < t.end
    )
    return (
        f"the comment opened on line {source.line(outer)} contains another <!--: "
        "comments cannot stand inside each other, the first --> ends both",
        f"close the first comment with --> before line {source.line(slip.offset)}, "
        "or delete the inner <!-- and its -->",
    )


def _comment_not_closed(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    return (
        f"the comment opened on line {source.line(slip.offset)} is never closed, so "
        "it swallows the rest of the file",
        "end it with -->",
    )


def _entity(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    return (
        f"&{slip.text}; is not known in XML",
        "XML knows only &amp; &lt; &gt; &quot; &apos;: write the character itself",
    )


def _less_than(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    place = f" in a value of <{slip.tag}>" if slip.tag else ""
    return f"a bare < is not allowed{place}", "write &lt; instead of <"


def _quote_in_value(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    quote = source.text[slip.offset]
    other = "'" if quote == '"' else '"'
    return (
        f"the quote {quote} inside the expression ends the value too early",
        f"use the other quote inside: {slip.text.replace(quote, other)}",
    )


def _quote_not_closed(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    quote = source.text[slip.offset]
    return (
        f"the quote that opens {slip.text} in <{slip.tag}> is never closed",
        f"write {quote} at the end of the value",
    )


def _curly(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    name, _, value = slip.text.partition("=")
    return (
        f"{name} in <{slip.tag}> has curly quotes (“ ”), probably pasted from a web "
        "page or a document",
        f'use straight quotes: {name}="{value}"',
    )


def _quotes_missing(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    name, _, value = slip.text.partition("=")
    return (
        f"the value of {name} in <{slip.tag}> has no quotes",
        f'write {name}="{value.strip(CURLY)}"',
    )


def _tag_malformed(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    if slip.text.startswith("<"):
        close = "/" if re.match(r"<\s*[/\\]", slip.text) else ""
        return (
            f"{slip.text} is no tag: the name follows < or </ at once, and a closing "
            "tag holds nothing else",
            f"write <{close}{slip.tag}>" if close else f"write <{slip.tag} …>",
        )
    if slip.text == "/":
        return (
            f"in <{slip.tag}> the slash is not directly before >",
            "write /> without anything between",
        )
    return (
        f"in <{slip.tag}> the character {slip.text} stands where an attribute or > "
        "is expected",
        "delete it, or look for a quote that is missing or too many before it",
    )


def _tag_not_ended(source: SourceText, slip: LexicalError) -> tuple[str, str]:
    shown = slip.text.splitlines()[0][:60]
    return (
        f"the tag {shown} is not ended: its > is missing",
        "write > (or />) at its end",
    )


SAYINGS: Mapping[SlipKind, Callable[[SourceText, LexicalError], tuple[str, str]]] = {
    "ampersand": _ampersand,
    "attribute-twice": _attribute_twice,
    "attribute-without-value": _attribute_without_value,
    "attributes-run-together": _run_together,
    "comment-double-hyphen": _double_hyphen,
    "comment-malformed": _comment_malformed,
    "comment-nested": _comment_nested,
    "comment-not-closed": _comment_not_closed,
    "entity-undefined": _entity,
    "less-than": _less_than,
    "quote-in-value": _quote_in_value,
    "quote-not-closed": _quote_not_closed,
    "quotes-curly": _curly,
    "quotes-missing": _quotes_missing,
    "tag-malformed": _tag_malformed,
    "tag-not-ended": _tag_not_ended,
}
"""Kind of slip → the function that gives message and hint."""
