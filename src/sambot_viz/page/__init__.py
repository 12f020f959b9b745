"""The page's own files: scripts, style sheets and the HTML page that loads them."""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import PurePosixPath

FOLDER = "sambot"
"""Below the address of the page."""
_TYPES = {".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8"}
_HEAD = (
    f'<link rel="stylesheet" href="./{FOLDER}/window.css">'
    f'<script type="module" src="./{FOLDER}/main.js"></script>'
)


@cache
def file(path: str) -> tuple[bytes, str] | None:
    """A file of the page and its media type; None when there is no such file.

    Args:
        path: below this folder, such as "main.js".
    """
    pure = PurePosixPath(path)
    media_type = _TYPES.get(pure.suffix)
    if media_type is None or pure.is_absolute() or ".." in pure.parts:
        return None
    found = resources.files(__name__).joinpath(*pure.parts)
    return (found.read_bytes(), media_type) if found.is_file() else None


def with_scripts(html: bytes) -> bytes:
    """Viser's page with our scripts and style sheet in its head."""
    return html.replace(b"</head>", _HEAD.encode() + b"</head>", 1)
