"""Tokens of XML text, and the lexical errors between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

TokenKind = Literal[
    "open", "close", "empty", "text", "comment", "instruction", "doctype", "cdata"
]
LexicalErrorKind = Literal[
    "ampersand",
    "attribute-twice",
    "attribute-without-value",
    "attributes-run-together",
    "comment-double-hyphen",
    "comment-malformed",
    "comment-nested",
    "comment-not-closed",
    "entity-undefined",
    "less-than",
    "quote-in-value",
    "quote-not-closed",
    "quotes-curly",
    "quotes-missing",
    "tag-malformed",
    "tag-not-ended",
]


@dataclass(frozen=True, slots=True)
class Attribute:
    """An attribute as written; `offset` is where its name begins."""

    name: str
    value: str
    offset: int


@dataclass(frozen=True, slots=True)
class Token:
    """A token: the text from `start` to `end` (exclusive).

    Attributes:
        kind: "open" and "empty" are <a> and <a/>, "close" is </a>.
        start: offset of the first character.
        end: offset after the last character.
        name: element name; empty for everything that is not a tag.
        attributes: those that could be read, each name once, in document order.
    """

    kind: TokenKind
    start: int
    end: int
    name: str = ""
    attributes: tuple[Attribute, ...] = ()

    @property
    def closes(self) -> bool:
        """Whether this is a closing tag."""
        return self.kind == "close"

    @property
    def shown(self) -> str:
        """The tag in a message: </a>, <a>, or <a name="…"> when it has a name."""
        if self.closes:
            return f"</{self.name}>"
        name = self.get("name")
        return f'<{self.name} name="{name}">' if name else f"<{self.name}>"

    def get(self, name: str) -> str | None:
        """The value of an attribute as written, or None."""
        return next((a.value for a in self.attributes if a.name == name), None)


@dataclass(frozen=True, slots=True)
class LexicalError:
    """A lexical error: its offset, the text it concerns, and the tag it is in."""

    kind: LexicalErrorKind
    offset: int
    text: str = ""
    tag: str = ""
