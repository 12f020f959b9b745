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
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import Any

from sambot_viz.content_policy import policy_element

_FOLDER = Path(__file__).parent
_PREFIX = "sambot/"
"""What the names of the modules begin with in the import map."""
_COMMENT = re.compile(
    r"^[ \t]*(?://[^\n]*|/\*(?:(?!\*/).)*\*/[ \t]*)\n", re.MULTILINE | re.DOTALL
)
"""Lines that are nothing but a comment."""
_INDENT = re.compile(r"^[ \t]+", re.MULTILINE)
_IMPORT = re.compile(
    r"""^((?:import|export|\})[^"'\n]*)(["'])(\.{1,2}/[^"']+)\2""", re.MULTILINE
)
"""The line of a statement that names another module, which begins the line."""
_FIRST = "address.js"
"""Runs before all other scripts."""
_FOR_VISER = ("viser_poses.js", "viser_address.js")
"""Run before viser's own script."""
_NO_VIEW = "no_view.js"
"""The script of a page without a view."""
_EARLY = ("view/font.js", "view/still.js")
"""Run before it too; the first finds the font in an element before it."""
_FONT = "vendor/names.woff2"
_WINDOW_STYLES = (
    "window/window.css",
    "cells/cells.css",
    "panels/panels.css",
    "window/shapes.css",
)
_STYLES = (
    *_WINDOW_STYLES,
    "tree/tree.css",
    "dialogs/dialogs.css",
    "panels/graph.css",
    "panels/model.css",
    "panels/lesson.css",
)
_PLAYER_STYLES = (*_WINDOW_STYLES, "player/player.css")
_CLASS_STYLES = ("window/window.css", "board/board.css")
_TITLE = re.compile(rb"<title>.*?</title>", re.DOTALL)


def with_scripts(html: bytes, panels: bool, look: str = "rviz") -> bytes:
    """The page of viser with our scripts and style sheets in its head.

    Args:
        html: the page of viser.
        panels: whether there are panels round the view, or the view fills the page.
        look: how the view is drawn in a browser that has chosen nothing.
    """
    head = _head("main.js" if panels else "view_only.js", _css(_STYLES), look)
    head = f"{''.join(map(_plain, (_FIRST, *_FOR_VISER)))}{head}"
    return html.replace(b"</head>", head.encode() + b"</head>", 1)


def without_view(viser_protocol: str, look: str = "rviz") -> bytes:
    """The window round an empty place: a page without viser's script and without WebGL.

    Args:
        viser_protocol: what a client of viser asks for, with its version.
        look: as for `with_scripts`; what an exported page begins with.
    """
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        f'<meta name="sambot-viser" content="{escape(viser_protocol)}">'
        '<link rel="icon" href="data:,"><title>sambot-viz</title>'
        f"{_plain(_FIRST)}{_head(_NO_VIEW, _css(_STYLES), look)}"
        '</head><body><div id="root"><div id="no-view"></div></div></body></html>'
    ).encode()


def standing_alone(
    html: bytes,
    title: str,
    scene: bytes,
    about: dict[str, Any],
    motion: str,
    look: str = "rviz",
) -> bytes:
    """The page of viser as its own file, which shows a recording.

    Args:
        html: the page of viser.
        title: of the page; a plain text.
        scene: viser's recording of the first picture.
        about: what `player.js` has to know.
        motion: what moves afterwards; base64, read by `player.js`.
        look: how it is drawn.
    """
    # A name may hold anything: it must not end the element.
    data = json.dumps(about, ensure_ascii=True).replace("<", "\\u003c")
    before, _, rest = _TITLE.sub(b"", html, 1).partition(b"<head>")
    head, _, after = rest.partition(b"</head>")
    return b"".join(
        [
            before,
            b'<head><meta charset="utf-8">',
            policy_element("recording").encode(),
            f"<title>{escape(title)}</title>".encode(),
            head,
            b'<script>window.__VISER_EMBED_DATA__="',
            # The longest part; it is copied once.
            base64.b64encode(scene),
            b'";window.__VISER_EMBED_CONFIG__={darkMode:true};</script>',
            f'<script type="application/json" id="sambot-about">{data}</script>'
            f'<script type="text/plain" id="sambot-motion">{motion}</script>'
            f"{_head('player/player.js', _short(_css(_PLAYER_STYLES)), look)}".encode(),
            b"</head>",
            after,
        ]
    )


def name_form(title: str) -> bytes:
    """The page of a class that asks who opens it.

    Args:
        title: of the lesson.
    """
    return _of_class(title, "board/name.js")


def board(title: str) -> bytes:
    """The teacher's board of a class.

    Args:
        title: of the lesson.
    """
    return _of_class(title, "board/board.js")


def _of_class(title: str, first: str) -> bytes:
    modules = json.dumps({"imports": _modules(first)})
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        f'<link rel="icon" href="data:,"><title>{escape(title)}</title>'
        f'<script type="importmap">{modules}</script>'
        f'<script type="module">import "{_PREFIX}{first}";</script>'
        f"<style>{_css(_CLASS_STYLES)}</style></head><body></body></html>"
    ).encode()


def _css(styles: Iterable[str]) -> str:
    return "".join(_FOLDER.joinpath(name).read_text("utf-8") for name in styles)


def _short(css: str) -> str:
    """Leave out what only a reader of a style sheet needs."""
    return _INDENT.sub("", _COMMENT.sub("", css))


def _head(first: str, css: str, look: str) -> str:
    """Scripts and style sheets for the head of a page.

    The script is `async`: viser's own script must not wait for ours.

    Args:
        first: the script that the page begins with; it comes with all it imports.
        css: its style.
        look: what `look.js` begins with.
    """
    modules = _modules(first)
    return (
        f"{_early() if first != _NO_VIEW else ''}"
        f'<meta name="sambot-look" content="{escape(look)}">'
        f'<script type="importmap">{json.dumps({"imports": modules})}</script>'
        f'<script type="module" async>import "{_PREFIX}{first}";</script>'
        f"<style>{css}</style>"
    )


def _early() -> str:
    """What runs before viser's own script, and the font of the names in the view."""
    font = base64.b64encode(_FOLDER.joinpath(_FONT).read_bytes()).decode()
    scripts = "".join(map(_plain, _EARLY))
    return f'<script type="text/plain" id="sambot-font">{font}</script>{scripts}'


def _plain(name: str) -> str:
    """A script that is not a module: it runs before what comes after it."""
    return f"<script>{_FOLDER.joinpath(name).read_text('utf-8')}</script>"


def _modules(first: str) -> dict[str, str]:
    """A script and all that it imports as data addresses, by name in the import map."""
    made: dict[str, str] = {}
    pending = [first]
    while pending:
        name = pending.pop()
        if _PREFIX + name not in made:
            made[_PREFIX + name], imported = _address(name)
            pending += imported
    return dict(sorted(made.items()))


def licenses() -> bytes:
    """The licences of the libraries that are in the page."""
    names = ("LICENSES.txt", "CODEMIRROR_LICENSES.txt")
    return b"\n".join(_FOLDER.joinpath("vendor", name).read_bytes() for name in names)


def codemirror() -> bytes:
    """The editor of the panel Model, a module that the page asks for when it opens."""
    return _FOLDER.joinpath("vendor", "codemirror.js").read_bytes()


def _address(name: str) -> tuple[str, list[str]]:
    """A script as a data address, and what it imports, as paths in this folder.

    In the script these are named as in the import map.
    """
    imported: list[str] = []

    def absolute(found: re.Match[str]) -> str:
        path = posixpath.join(posixpath.dirname(name), found[3])
        imported.append(posixpath.normpath(path))
        return f'{found[1]}"{_PREFIX}{imported[-1]}"'

    source = _FOLDER.joinpath(name).read_text("utf-8")
    # The lines keep their numbers.
    source = _COMMENT.sub(lambda found: "\n" * found[0].count("\n"), source)
    source = f"{_IMPORT.sub(absolute, source)}\n//# sourceURL={_PREFIX}{name}\n"
    packed = base64.b64encode(source.encode()).decode()
    return f"data:text/javascript;charset=utf-8;base64,{packed}", imported
