"""Clean every string that comes from outside and that a person reads.

A name in a file may contain control sequences for a terminal, marks that reverse the
direction of letters, or invisible characters that make it look like another name. viser
checks nothing either: one lone surrogate in a label breaks every browser that connects
later. Output to a terminal or a log passes `outlet`, which uses the same functions.
"""

from __future__ import annotations

import json
import re
import unicodedata
from typing import Any

_SIGN = "\N{REPLACEMENT CHARACTER}"
_BLANK = "\t\n\r\x85\u2028\u2029"
_BLANKS = re.compile(f"[{_BLANK}]+")
_EACH_BLANK = re.compile(f"[{_BLANK}]")
_UNSEEN = (
    "[\x00-\x1f\x7f-\x9f"  # control characters
    "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"  # direction marks
    "\xad\u034f\u180e\u200b\u2060-\u2065\u206a-\u206f\ufeff\ufff0-\ufffb"  # no width
    "\u115f\u1160\u17b4\u17b5\u3164\uffa0"  # letters that are blank
    "\u2028\u2029"  # line breaks
    "\ud800-\udfff"  # halves of a character
    "\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e007f]"  # tags
    "|(?:(?<=[\x00-\x7f])|^)[\u200c\u200d\ufe00-\ufe0f\U000e0100-\U000e01ef]"
)
"""Joiners (U+200C and U+200D) and variation selectors are kept after a letter that is
not ASCII: several scripts cannot be written without them."""
_INVISIBLE = re.compile(_UNSEEN)
_INVISIBLE_OF_LINES = re.compile(f"(?!\n)(?:{_UNSEEN})")


def text(value: object, limit: int = 400) -> str:
    """Return a string that any browser can show.

    Args:
        value: any value; others than strings are converted with `str()`.
        limit: maximum length [characters]; longer texts end with "…".

    Returns:
        One line of valid UTF-8 without control characters, direction marks and
        characters of no width; each is replaced by U+FFFD, a line break by a blank.
    """
    clean = str(value)[: limit + 1]
    if not (clean.isascii() and clean.isprintable()):  # which most are
        clean = _INVISIBLE.sub(_SIGN, _BLANKS.sub(" ", clean))
    return clean if len(clean) <= limit else clean[: limit - 1] + "…"


def columns(value: object) -> int:
    """Return how many letters wide a text is; those of East Asia count twice."""
    said = text(value)
    return len(said) + sum(unicodedata.east_asian_width(c) in "WF" for c in said)


def line(value: object) -> str:
    """Return the same of any length, character by character, so that columns stay."""
    return _INVISIBLE.sub(_SIGN, _EACH_BLANK.sub(" ", str(value)))


def lines(value: object) -> str:
    """Return the same for a text of several lines, whose line breaks stay."""
    return _INVISIBLE_OF_LINES.sub(_SIGN, str(value).replace("\t", " "))


def json_text(value: Any, *, ascii_only: bool = True, indent: int | None = 2) -> str:
    """Return a value as JSON; invisible characters are escaped.

    Args:
        value: the value.
        ascii_only: whether other letters are escaped, too.
        indent: of each level; None writes one line.
    """
    written = json.dumps(value, indent=indent, ensure_ascii=ascii_only)
    return _INVISIBLE_OF_LINES.sub(_escaped, written)


def _escaped(found: re.Match[str]) -> str:
    return json.dumps(found[0])[1:-1] if found[0] != "\x7f" else "\\u007f"


def capitalized(words: str) -> str:
    """Return a text with a capital letter at its beginning, as the page has them."""
    return words[:1].upper() + words[1:]


def html_text(value: object, limit: int = 2000) -> str:
    """Escape HTML's special characters too, for `gui.add_html`."""
    # The import is late: commands write no HTML.
    import html

    return html.escape(text(value, limit), quote=True)


_WITHOUT_REFERENCES = re.compile(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>", re.DOTALL)


def xml_text(document: str) -> str:
    """Return an XML document that means the same, with references for the invisible.

    Comments, CDATA sections and instructions can have none: the sign stands there.
    """
    parts: list[str] = []
    end = 0
    for found in _WITHOUT_REFERENCES.finditer(document):
        parts += [_referred(document[end : found.start()]), lines(found[0])]
        end = found.end()
    return "".join([*parts, _referred(document[end:])])


def _referred(part: str) -> str:
    return _INVISIBLE_OF_LINES.sub(
        lambda found: found[0] if found[0] == "\t" else f"&#x{ord(found[0]):X};", part
    )
