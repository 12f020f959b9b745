"""What a page may load: the Content-Security-Policy of each kind of page.

The page of a robot has another one (`server.protection.access`), which viser's own
scripts limit.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

PageKind = Literal["text", "class", "recording", "lesson"]
"""A page to read, a page of a class, and two kinds of files: an exported recording and
a lesson."""
_STYLES = {"style-src": "'unsafe-inline'"}
_BESIDE = "'self' file:"
"""Files beside the page, on a web server or opened from a folder."""
_MAY_LOAD: Mapping[PageKind, Mapping[str, str]] = {
    "text": _STYLES,
    "class": {
        **_STYLES,
        "script-src": "'unsafe-inline' data:",
        "connect-src": "'self'",
        "frame-src": "'self'",
        "img-src": "data:",
    },
    "recording": {
        **_STYLES,
        "script-src": "'unsafe-inline' 'unsafe-eval' data: blob:",
        "worker-src": "data: blob:",
        "connect-src": "data: blob:",
        "img-src": "data: blob:",
        "font-src": "data:",
    },
    "lesson": {**_STYLES, "img-src": _BESIDE, "frame-src": _BESIDE},
}
_FILES = ("recording", "lesson")
"""The policy of a file is an element of it, which cannot limit who frames the page."""


def strict_policy(kind: PageKind) -> str:
    """Return the policy of a kind of page: all that its row does not name is refused.

    Args:
        kind: kind of the page.
    """
    framed = () if kind in _FILES else ("frame-ancestors",)
    refused = ("default-src", "base-uri", "form-action", *framed)
    rules = {**dict.fromkeys(refused, "'none'"), **_MAY_LOAD[kind]}
    return "; ".join(f"{name} {sources}" for name, sources in rules.items())


def policy_element(kind: PageKind) -> str:
    """Return the policy of a file as an element for its head."""
    policy = strict_policy(kind)
    return f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
