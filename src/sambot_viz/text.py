"""Clean every string that comes from a file and goes to a browser.

viser checks nothing: one lone surrogate in a label breaks every browser that comes
later, and direction marks or invisible characters make one name look like another.
"""

from __future__ import annotations

import html
import re

_BLANKS = re.compile("[\t\n\r\x85\u2028\u2029]+")
_INVISIBLE = re.compile(
    "[\x00-\x1f\x7f-\x9f"  # control characters
    "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"  # direction marks
    "\xad\u180e\u200b\u2060-\u2065\u206a-\u206f\ufeff\ufff9-\ufffb"  # no width
    "\U000e0000-\U000e007f]"  # tags
)
"""Joiners (U+200C and U+200D) are left: several scripts cannot be written without."""


def text(value: object, limit: int = 400) -> str:
    """Return a string that any browser can show.

    Args:
        value: anything; `str()` is taken of what is not a string.
        limit: longest length [characters]; what is longer ends with "…".

    Returns:
        One line of valid UTF-8 without control characters, direction marks and
        characters of no width; each is replaced by U+FFFD, a line break by a blank.
    """
    clean = str(value)[: limit + 1].encode("utf-8", "replace").decode("utf-8")
    clean = _INVISIBLE.sub("\N{REPLACEMENT CHARACTER}", _BLANKS.sub(" ", clean))
    return clean if len(clean) <= limit else clean[: limit - 1] + "…"


def capitalized(words: str) -> str:
    """Return a text with a capital letter at its begin, as the page has them."""
    return words[:1].upper() + words[1:]


def html_text(value: object, limit: int = 2000) -> str:
    """Escape HTML's special characters too, for `gui.add_html`."""
    return html.escape(text(value, limit), quote=True)
