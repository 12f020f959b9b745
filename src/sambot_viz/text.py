"""The one gate for every string that comes from a file and goes to a browser.

viser checks nothing: a lone surrogate in a label breaks every browser that comes
later, and a slash in a name makes another level of the scene tree
(spec/viser.md §4).
"""

from __future__ import annotations

import html
import re

_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\ufeff]")
_BLANKS = re.compile(r"[\t\n\r]+")


def text(value: object, limit: int = 400) -> str:
    """A string that any browser can show.

    Args:
        value: anything; `str()` is taken of what is no string.
        limit: longest length in characters; what is longer ends with "…".

    Returns:
        One line of valid UTF-8 without control characters or direction marks.
    """
    clean = str(value).encode("utf-8", "replace").decode("utf-8")
    clean = _CONTROL.sub("\N{REPLACEMENT CHARACTER}", _BLANKS.sub(" ", clean))
    return clean if len(clean) <= limit else clean[: limit - 1] + "…"


def html_text(value: object, limit: int = 2000) -> str:
    """The same, with HTML's special characters escaped, for `gui.add_html`."""
    return html.escape(text(value, limit), quote=True)
