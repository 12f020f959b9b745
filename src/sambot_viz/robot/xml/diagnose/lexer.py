"""A tolerant reader of XML text: tokens with offsets, and lexical errors.

expat stops at the first error and names the symptom. This reader records the error,
guesses what was meant and continues, so that `explain_xml` can name the cause and
`explain_xacro` can find lines in source files. Only expat decides whether a text is
XML.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from itertools import islice

from sambot_viz.robot.xml.diagnose.tokens import (
    Attribute,
    LexicalError,
    LexicalErrorKind,
    Token,
    TokenKind,
)

NAME = r"[^\W\d][\w.\-]*(?::[^\W\d][\w.\-]*)?"
CURLY = "“”„‟″‘’‚‛′«»"

_NAME = re.compile(NAME)
_ATTRIBUTE = re.compile(rf"\s+({NAME})\s*=\s*(?:\"([^\"<]*)\"|'([^'<]*)')")
_GOOD_TAG = re.compile(
    rf"<({NAME})((?:\s+{NAME}\s*=\s*(?:\"[^\"<]*\"|'[^'<]*'))*)\s*(/?)>"
)
_CLOSE_TAG = re.compile(rf"</({NAME})\s*>")
_LOOSE_CLOSE_TAG = re.compile(rf"(?:</\s*|<\\\s*|<\s+/\s*)({NAME})[^<>]*>?")
_LOOSE_OPEN_TAG = re.compile(rf"<\s+({NAME})(?=[\s/>])")
_BARE_AMPERSAND = re.compile(r"&(?!(?:[^\W\d][\w.\-]*|#\d+|#x[0-9A-Fa-f]+);)")
_ENTITY = re.compile(r"&([^\W\d][\w.\-]*);")
_NEXT_ATTRIBUTE = re.compile(rf"\s({NAME})\s*=\s*$")
_CURLY_END = re.compile(f"[{CURLY}\"'<>\\n]")
_VALUE_END = re.compile(r"/?>|[\n<]")
_EQUALS = re.compile(r"\s*=\s*")
_SPACE = re.compile(r"\s*")
_UNQUOTED = re.compile(r"(?:(?!/>)[^\s<>])+")
_LOOSE_COMMENT = re.compile(r"<(?:!\s*-\s*-?|--)")
MOST_ERRORS = 50
_KNOWN_ENTITIES = frozenset({"amp", "lt", "gt", "quot", "apos"})


def _cut_expression(value: str) -> bool:
    """Whether a value ends inside ${…}: its quote is inside the expression."""
    return "${" in value and "}" not in value[value.rfind("${") :]


def _ends_oddly(value: str) -> bool:
    """Whether the quote that ended this value was meant to begin another."""
    return _cut_expression(value) or bool(_NEXT_ATTRIBUTE.search(value))


def tokenize(text: str) -> tuple[list[Token], list[LexicalError]]:
    """The tokens of a text and its errors, both in document order.

    Reading ends after `MOST_ERRORS` errors, because such a text is not XML at all.
    """
    reader = _Tokenizer(text)
    reader.run()
    return reader.tokens, sorted(reader.errors, key=lambda error: error.offset)


@dataclass
class _Tokenizer:
    text: str
    tokens: list[Token] = field(default_factory=list["Token"])
    errors: list[LexicalError] = field(default_factory=list["LexicalError"])
    has_doctype: bool = False

    def run(self) -> None:
        position = 0
        while position < len(self.text) and len(self.errors) < MOST_ERRORS:
            mark = self.text.find("<", position)
            mark = len(self.text) if mark < 0 else mark
            if mark > position:
                self._text(position, mark)
            position = self._markup(mark) if mark < len(self.text) else mark

    def _note_error(
        self, kind: LexicalErrorKind, offset: int, text: str = "", tag: str = ""
    ) -> None:
        self.errors.append(LexicalError(kind, offset, text, tag))

    def _token(self, kind: TokenKind, start: int, end: int) -> int:
        self.tokens.append(Token(kind, start, end))
        return end

    def _text(self, start: int, end: int) -> None:
        self._token("text", start, end)
        self._references(start, end)

    def _references(self, start: int, end: int) -> None:
        """Note bare ampersands and unknown entities between two offsets."""
        if "&" not in self.text[start:end]:
            return
        ampersands = _BARE_AMPERSAND.finditer(self.text, start, end)
        for found in islice(ampersands, MOST_ERRORS):
            self._note_error("ampersand", found.start())
        for found in _ENTITY.finditer(self.text, start, end):
            if len(self.errors) >= MOST_ERRORS:
                return
            if found[1] not in _KNOWN_ENTITIES and not self.has_doctype:
                self._note_error("entity-undefined", found.start(), found[1])

    def _markup(self, start: int) -> int:
        text = self.text
        good = _GOOD_TAG.match(text, start)
        if good:
            return self._good_tag(good)
        close = _CLOSE_TAG.match(text, start)
        if close:
            self.tokens.append(Token("close", start, close.end(), close[1]))
            return close.end()
        if text.startswith("<!--", start):
            return self._comment(start)
        if text.startswith("<![CDATA[", start):
            return self._token("cdata", start, self._after("]]>", start))
        if text.startswith("<?", start):
            return self._token("instruction", start, self._after("?>", start))
        if text.startswith("<!DOCTYPE", start):
            return self._doctype(start)
        return self._loose_markup(start)

    def _after_space(self, position: int) -> int:
        space = _SPACE.match(self.text, position)
        return space.end() if space else position

    def _after(self, mark: str, start: int) -> int:
        found = self.text.find(mark, start)
        return len(self.text) if found < 0 else found + len(mark)

    def _doctype(self, start: int) -> int:
        self.has_doctype = True
        bracket = self.text.find("[", start)
        angle = self.text.find(">", start)
        if 0 <= bracket < angle:
            start_of_end = self._after("]", bracket)
            return self._token("doctype", start, self._after(">", start_of_end))
        return self._token("doctype", start, self._after(">", start))

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
            self._note_error("comment-double-hyphen", start + 4 + at, inner.strip())
        return self._token("comment", start, close + 3)

    def _loose_markup(self, start: int) -> int:
        """Markup that is not XML: guess the tag that was meant."""
        text = self.text
        name = _NAME.match(text, start + 1)
        if name:
            return self._loose_tag(start, name[0], name.end())
        close = _LOOSE_CLOSE_TAG.match(text, start)
        if close:
            self._note_error("tag-malformed", start, close[0].strip(), close[1])
            self.tokens.append(Token("close", start, close.end(), close[1]))
            return close.end()
        if _LOOSE_COMMENT.match(text, start):
            end = text.find(">", start)
            self._note_error("comment-malformed", start)
            return self._token("comment", start, len(text) if end < 0 else end + 1)
        spaced = _LOOSE_OPEN_TAG.match(text, start)
        if spaced:
            self._note_error("tag-malformed", start, spaced[0], spaced[1])
            return self._loose_tag(start, spaced[1], spaced.end())
        self._note_error("less-than", start)
        return self._token("text", start, start + 1)

    def _good_tag(self, found: re.Match[str]) -> int:
        attributes: dict[str, Attribute] = {}
        pieces = list(_ATTRIBUTE.finditer(self.text, found.start(2), found.end(2)))
        if any(_ends_oddly(piece[2] or piece[3] or "") for piece in pieces):
            return self._loose_tag(found.start(), found[1], found.end(1))
        for piece in pieces:
            value = piece[2] if piece[2] is not None else piece[3]
            self._add(attributes, Attribute(piece[1], value, piece.start(1)), found[1])
        self._references(found.start(2), found.end(2))
        kind: TokenKind = "empty" if found[3] else "open"
        self.tokens.append(
            Token(
                kind, found.start(), found.end(), found[1], tuple(attributes.values())
            )
        )
        return found.end()

    def _add(self, known: dict[str, Attribute], new: Attribute, tag: str) -> None:
        if new.name in known:
            self._note_error("attribute-twice", new.offset, new.name, tag)
        known.setdefault(new.name, new)

    def _loose_tag(self, start: int, tag: str, position: int) -> int:
        """A start tag with errors, read attribute by attribute."""
        attributes: dict[str, Attribute] = {}
        text = self.text
        while True:
            before = position
            if len(self.errors) >= MOST_ERRORS:
                kind, end = "open", len(text)
                break
            position = self._after_space(position)
            if position >= len(text) or text[position] == "<":
                self._note_error(
                    "tag-not-ended", start, text[start:before].strip(), tag
                )
                kind, end = "open", position
                break
            if text.startswith("/>", position):
                kind, end = "empty", position + 2
                break
            if text[position] == ">":
                kind, end = "open", position + 1
                break
            attribute = _NAME.match(text, position)
            if attribute:
                if position == before:
                    self._note_error(
                        "attributes-run-together", position, attribute[0], tag
                    )
                position = self._loose_attribute(attribute, attributes, tag)
            else:
                self._note_error("tag-malformed", position, text[position], tag)
                position += 1
        self.tokens.append(Token(kind, start, end, tag, tuple(attributes.values())))
        return end

    def _loose_attribute(
        self, name: re.Match[str], attributes: dict[str, Attribute], tag: str
    ) -> int:
        text = self.text
        equals = _EQUALS.match(text, name.end())
        if not equals:
            self._note_error("attribute-without-value", name.start(), name[0], tag)
            return name.end()
        start = equals.end()
        first = text[start : start + 1]
        if first and first in "\"'":
            value, end = self._quoted(start, name, tag)
        elif first and first in CURLY:
            value, end = self._curly(start, name, tag)
        else:
            unquoted = _UNQUOTED.match(text, start)
            value, end = (unquoted[0], unquoted.end()) if unquoted else ("", start)
            self._note_error("quotes-missing", name.start(), f"{name[0]}={value}", tag)
        self._add(attributes, Attribute(name[0], value, name.start()), tag)
        return end

    def _curly(self, start: int, name: re.Match[str], tag: str) -> tuple[str, int]:
        closing = _CURLY_END.search(self.text, start + 1)
        end = closing.start() if closing else len(self.text)
        value = self.text[start + 1 : end]
        self._note_error("quotes-curly", start, f"{name[0]}={value}", tag)
        ends_here = closing is not None and closing[0] not in "<>\n"
        return value, end + 1 if ends_here else end

    def _quoted(self, start: int, name: re.Match[str], tag: str) -> tuple[str, int]:
        """The value after an opening quote, and where to read on."""
        text, quote = self.text, self.text[start]
        close = text.find(quote, start + 1)
        value = text[start + 1 : close] if close >= 0 else text[start + 1 :]
        if close >= 0 and _cut_expression(value):
            brace = text.find("}", close)
            again = text.find(quote, brace) if brace >= 0 else -1
            if again >= 0 and not re.search(r"[<>\n]", text[close:again]):
                self._note_error("quote-in-value", close, text[start + 1 : again], tag)
                return text[start + 1 : again], again + 1
        swallowed = _NEXT_ATTRIBUTE.search(value)
        if close < 0 or swallowed or ("<" in value and "\n" in value):
            self._note_error("quote-not-closed", start, f"{name[0]}={quote}", tag)
            if swallowed and not re.search(r"[<\n]", value):
                return value[: swallowed.start()], start + 1 + swallowed.start()
            stop = _VALUE_END.search(text, start + 1)
            end = stop.start() if stop else len(text)
            return text[start + 1 : end], end
        self._references(start, close)
        for found in islice(re.finditer("<", value), MOST_ERRORS):
            self._note_error("less-than", start + 1 + found.start(), value, tag)
        return value, close + 1
