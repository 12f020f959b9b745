"""The page's own files: scripts, style sheets, and the HTML page with them in it.

The scripts are plain modules that import each other by relative paths. In the HTML page
each is a data address in an import map, so that one request brings all of them: while
the program starts, every further request would wait for it.
"""

from __future__ import annotations

import base64
import json
import posixpath
import re
from pathlib import Path

_FOLDER = Path(__file__).parent
_PREFIX = "sambot/"
"""What the names of the modules begin with in the import map."""
_IMPORT = re.compile(r"""(\bfrom\s*|\bimport\s*)(["'])(\.{1,2}/[^"']+)\2""")
_STYLES = ("window.css", "tree.css", "dialogs.css")


def with_scripts(html: bytes, panels: bool) -> bytes:
    """The page of viser with our scripts and style sheets in its head.

    The script is `async`: viser's own script must not wait for ours.

    Args:
        html: the page of viser.
        panels: whether there are panels round the view, or the view fills the page.
    """
    modules = {
        _PREFIX + path.relative_to(_FOLDER).as_posix(): _address(path)
        for path in sorted(_FOLDER.rglob("*.js"))
    }
    styles = "".join(_FOLDER.joinpath(name).read_text("utf-8") for name in _STYLES)
    first = "main.js" if panels else "bare.js"
    head = (
        f'<script type="importmap">{json.dumps({"imports": modules})}</script>'
        f'<script type="module" async>import "{_PREFIX}{first}";</script>'
        f"<style>{styles}</style>"
    )
    return html.replace(b"</head>", head.encode() + b"</head>", 1)


def licenses() -> bytes:
    """The licences of the libraries that are in the page."""
    return _FOLDER.joinpath("vendor", "LICENSES.txt").read_bytes()


def _address(path: Path) -> str:
    """A script as a data address; what it imports is named as in the import map."""
    folder = path.parent.relative_to(_FOLDER).as_posix()

    def absolute(found: re.Match[str]) -> str:
        name = posixpath.normpath(posixpath.join(_PREFIX, folder, found[3]))
        return f'{found[1]}"{name}"'

    source = _IMPORT.sub(absolute, path.read_text("utf-8"))
    name = _PREFIX + path.relative_to(_FOLDER).as_posix()
    packed = base64.b64encode(f"{source}\n//# sourceURL={name}\n".encode())
    return "data:text/javascript;charset=utf-8;base64," + packed.decode()
