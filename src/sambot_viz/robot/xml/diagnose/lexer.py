"""A tolerant reader of XML text: tokens with offsets, and lexical errors.

expat stops at the first error and names the symptom. This reader records the usual
slips, guesses what was meant and continues, so that `explain_xml` can name the cause
and `explain_xacro` can find lines in source files. Only expat decides whether a text
is XML. Reading ends where the text is none of the slips that are known here.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Literal

TokenKind = Literal[
    "open", "close", "empty", "text", "comment", "instruction", "doctype", "cdata"
]
LexicalErrorKind = Literal[
    "ampersand",
    "attribute-twice",
    "attributes-run-together",
    "comment-double-hyphen",
    "comment-nested",
    "comment-not-closed",
    "less-than",
    "quote-not-closed",
    "quotes-curly",
    "quotes-missing",
    "tag-not-ended",
]

CURLY = "“”„‟″‘’‚‛′«»"
MOST_ERRORS = 50
"""Number of errors after which reading ends, because such a text is not XML at all."""

_NAME_PATTERN = r"[^\W\d][\w.\-]*(?::[^\W\d][\w.\-]*)?"
_NAME = re.compile(_NAME_PATTERN)
ATTRIBUTE = re.compile(rf"\s+({_NAME_PATTERN})\s*=\s*(?:\"([^\"<]*)\"|'([^'<]*)')")
_GOOD_TAG = re.compile(
    rf"<({_NAME_PATTERN})((?:\s+{_NAME_PATTERN}\s*=\s*(?:\"[^\"<]*\"|'[^'<]*'))*)"
    r"\s*(/?)>"
)
_CLOSE_TAG = re.compile(rf"</({_NAME_PATTERN})\s*>")
_BARE_AMPERSAND = re.compile(r"&(?!(?:[^\W\d][\w.\-]*|#\d+|#x[0-9A-Fa-f]+);)")
_NEXT_ATTRIBUTE = re.compile(rf"\s({_NAME_PATTERN})\s*=\s*$")
_CURLY_END = re.compile(f"[{CURLY}\"'<>\\n]")
_VALUE_END = re.compile(r"/?>|[\n<]")
_EQUALS = re.compile(r"\s*=\s*")
_SPACE = re.compile(r"\s*")
_UNQUOTED = re.compile(r"(?:(?!/>)[^\s<>])+")
_CLOSED_ONLY = re.compile(r"([^\s<>\"'=][^<>\"'=\n]*)[\"']")


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
        """True for a closing tag."""
        return self.kind == "close"

    @property
    def shown(self) -> str:
        """The tag in a message: </a>, <a>, or <a name="…"> when it has a name."""
        if self.closes:
            return f"</{self.name}>"
        name = self.get("name")
        return f'<{self.name} name="{name}">' if name else f"<{self.name}>"

    def get(self, name: str) -> str | None:
        """Return the value of an attribute as written, or None."""
        return next((a.value for a in self.attributes if a.name == name), None)


@dataclass(frozen=True, slots=True)
class LexicalError:
    """A lexical error: its offset, the text it concerns, and the tag it is in.

    `end` is behind what is replaced; what is missing is added there.
    """

    kind: LexicalErrorKind
    offset: int
    text: str = ""
    tag: str = ""
    end: int = -1


@dataclass
class Reading:
    """The tokens of a text and its errors, both in document order.

    Attributes:
        text: the whole text.
        tokens: what was read.
        errors: the slips that were recognised.
        complete: False when reading ended before the end of the text.
    """

    text: str
    tokens: list[Token] = field(default_factory=list["Token"])
    errors: list[LexicalError] = field(default_factory=list["LexicalError"])
    complete: bool = False


class _UnknownError(Exception):
    """Here the text is neither XML nor one of the known slips."""


def tokenize(text: str) -> Reading:
    """Read a text as far as it is XML with the known slips."""
    tokenizer = _Tokenizer(text)
    try:
        tokenizer.run()
    except _UnknownError:
        pass
    tokenizer.errors.sort(key=lambda error: error.offset)
    return tokenizer


@dataclass
class _Tokenizer(Reading):
    def run(self) -> None:
        position = 0
        while position < len(self.text):
            mark = self.text.find("<", position)
            mark = len(self.text) if mark < 0 else mark
            if mark > position:
                self._token("text", position, mark)
                self._ampersands(position, mark)
            position = self._markup(mark) if mark < len(self.text) else mark
        self.complete = True

    def _note_error(
        self,
        kind: LexicalErrorKind,
        offset: int,
        text: str = "",
        tag: str = "",
        end: int = -1,
    ) -> None:
        if len(self.errors) >= MOST_ERRORS:
            raise _UnknownError
        self.errors.append(LexicalError(kind, offset, text, tag, end))

    def _token(self, kind: TokenKind, start: int, end: int) -> int:
        self.tokens.append(Token(kind, start, end))
        return end

    def _tag(
        self, kind: TokenKind, start: int, end: int, name: str, found: list[Attribute]
    ) -> int:
        once: dict[str, Attribute] = {}
        for attribute in found:
            if attribute.name in once:
                self._note_error(
                    "attribute-twice", attribute.offset, attribute.name, name
                )
            once.setdefault(attribute.name, attribute)
        self.tokens.append(Token(kind, start, end, name, tuple(once.values())))
        return end

    def _ampersands(self, start: int, end: int) -> None:
        for found in _BARE_AMPERSAND.finditer(self.text, start, end):
            self._note_error("ampersand", found.start())

    def _markup(self, start: int) -> int:
        text = self.text
        good = _GOOD_TAG.match(text, start)
        if good:
            pieces = ATTRIBUTE.finditer(text, good.start(2), good.end(2))
            found = [Attribute(p[1], p[2] or p[3] or "", p.start(1)) for p in pieces]
            self._ampersands(good.start(2), good.end(2))
            kind = "empty" if good[3] else "open"
            return self._tag(kind, start, good.end(), good[1], found)
        close = _CLOSE_TAG.match(text, start)
        if close:
            return self._tag("close", start, close.end(), close[1], [])
        if text.startswith("<!--", start):
            return self._comment(start)
        if text.startswith("<![CDATA[", start):
            return self._token("cdata", start, self._after("]]>", start))
        if text.startswith("<?", start):
            return self._token("instruction", start, self._after("?>", start))
        if text.startswith("<!DOCTYPE", start):
            bracket, angle = text.find("[", start), text.find(">", start)
            end = self._after("]", bracket) if 0 <= bracket < angle else start
            return self._token("doctype", start, self._after(">", end))
        name = _NAME.match(text, start + 1)
        if name is None:
            raise _UnknownError
        return self._loose_tag(start, name[0], name.end())

    def _after(self, mark: str, start: int) -> int:
        found = self.text.find(mark, start)
        return len(self.text) if found < 0 else found + len(mark)

    def _after_space(self, position: int) -> int:
        space = _SPACE.match(self.text, position)
        return space.end() if space else position

    def _comment(self, start: int) -> int:
        close = self.text.find("-->", start + 4)
        if close < 0:
            self._note_error("comment-not-closed", start)
            return self._token("comment", start, len(self.text))
        inner = self.text[start + 4 : close]
        nested = inner.find("<!--")
        hyphens = inner.find("--")
        if nested >= 0:
            self._note_error("comment-nested", start + 4 + nested)
        elif hyphens >= 0 or inner.endswith("-"):
            at = hyphens if hyphens >= 0 else len(inner) - 1
            end = close + 3
            self._note_error(
                "comment-double-hyphen", start + 4 + at, inner.strip(), "", end
            )
        return self._token("comment", start, close + 3)

    def _loose_tag(self, start: int, tag: str, position: int) -> int:
        """Read a start tag with errors, attribute by attribute."""
        found: list[Attribute] = []
        text = self.text
        while True:
            before = position
            position = self._after_space(position)
            is_slash = text[position : position + 1] == "/"
            end = self._after_space(position + 1) if is_slash else position
            if text[end : end + 1] in ("", "<"):
                written = text[start : position + is_slash].strip()
                behind = start + len(written)
                self._note_error("tag-not-ended", start, written, tag, behind)
                kind = "empty" if is_slash else "open"
                return self._tag(kind, start, end, tag, found)
            if text.startswith("/>", position):
                return self._tag("empty", start, position + 2, tag, found)
            if text[position] == ">":
                return self._tag("open", start, position + 1, tag, found)
            position = self._loose_attribute(before, position, found, tag)

    def _loose_attribute(
        self, before: int, position: int, found: list[Attribute], tag: str
    ) -> int:
        text = self.text
        name = _NAME.match(text, position)
        equals = _EQUALS.match(text, name.end()) if name else None
        if name is None or equals is None:
            raise _UnknownError
        if position == before:
            self._note_error("attributes-run-together", position, name[0], tag)
        start = equals.end()
        first = text[start : start + 1]
        if first and first in "\"'":
            value, end = self._quoted(start, name[0], tag)
        elif first and first in CURLY:
            closing = _CURLY_END.search(text, start + 1)
            end = closing.start() if closing else len(text)
            value = text[start + 1 : end]
            end += closing is not None and closing[0] not in "<>\n"
            self._note_error("quotes-curly", start, f"{name[0]}={value}", tag, end)
        else:
            found_text = _CLOSED_ONLY.match(text, start) or _UNQUOTED.match(text, start)
            value, end = (
                (found_text[found_text.lastindex or 0], found_text.end())
                if found_text
                else ("", start)
            )
            self._note_error("quotes-missing", start, f"{name[0]}={value}", tag, end)
        found.append(Attribute(name[0], value, position))
        return end

    def _quoted(self, start: int, name: str, tag: str) -> tuple[str, int]:
        """The value after an opening quote, and where to read on."""
        text, quote = self.text, self.text[start]
        close = text.find(quote, start + 1)
        value = text[start + 1 : close] if close >= 0 else text[start + 1 :]
        swallowed = _NEXT_ATTRIBUTE.search(value)
        if close < 0 or swallowed or ("<" in value and "\n" in value):
            stop = _VALUE_END.search(text, start + 1)
            end = stop.start() if stop else len(text)
            if swallowed and not re.search(r"[<\n]", value):
                end = start + 1 + swallowed.start()
            behind = start + len(text[start:end].rstrip())
            said = f"{name}={quote}"
            self._note_error("quote-not-closed", start, said, tag, behind)
            return text[start + 1 : end], end
        self._ampersands(start, close)
        for found in re.finditer("<", value):
            self._note_error("less-than", start + 1 + found.start(), value, tag)
        return value, close + 1
