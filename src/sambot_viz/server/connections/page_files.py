"""Answer requests for the page: viser's page with our scripts in it."""

from __future__ import annotations

import gzip
import hashlib
import http
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Literal
from urllib.parse import parse_qsl

import viser
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz import page
from sambot_viz.content_policy import strict_policy
from sambot_viz.server.connections.viser_page import ViserPage, taken_apart

VISER_PROTOCOL = f"viser-v{viser.__version__}"
"""Subprotocol that a client of viser requests when it connects."""
NO_VIEW = ("view", "none")
"""Part of an address's query that asks for a page without a view."""
Parts = Literal["all", "view", "window"]
"""Parts of a page: the view in a window, the view alone, or a window without it."""
_FOLDER = "sambot/"
"""Folder of the files beside the page."""
LICENSES = f"/{_FOLDER}licenses.txt"
"""Path of the licences of the page's libraries."""
CODEMIRROR = f"/{_FOLDER}codemirror.js"
"""Path of the editor, which a page requests when its panel opens."""
_PLAIN_PAGE = """\
<!doctype html><meta charset="utf-8">
<meta name="viewport" content="width=device-width"><title>sambot-viz</title>
<style>body {{ font: 16px/1.5 sans-serif; max-width: 34em; margin: 4em auto }}</style>
<h1>{title}</h1><p>{text}</p>
"""


def prepare(panels: bool = True, look: str | None = None) -> None:
    """Make the page now: it takes much longer while a thread imports modules.

    Args:
        panels: as for `answer`.
        look: as for `answer`.
    """
    _tag("all" if panels else "view", look)


def answer(
    request: Request, panels: bool = True, look: str | None = None
) -> Response | None:
    """Return the answer to a request for the page or its licences; None for others.

    Args:
        request: the request.
        panels: whether the program has panels around its view.
        look: look of a page whose user has chosen none; None is RViz's.
    """
    if is_websocket(request):
        return None
    path = request.path.partition("?")[0]
    if path == LICENSES:
        return _text(page.licenses())
    if path == CODEMIRROR:
        return _codemirror(request)
    apart = _taken_apart()
    if apart is not None and path == f"/{_FOLDER}{apart.name}":
        return _script(request, apart.script)
    if not is_page(request):
        return None
    parts = _parts(request, panels)
    tag = _tag(parts, look)
    return _kept(request, "text/html", tag, lambda: _page(parts, look))


def _codemirror(request: Request) -> Response:
    """Return the editor, whose name is the same in all versions."""
    tag = _tag_of(page.codemirror())
    return _kept(request, "text/javascript", tag, page.codemirror)


def _kept(
    request: Request, kind: str, tag: str, content: Callable[[], bytes]
) -> Response:
    """Return a file that a browser stores, and revalidates at each use."""
    headers = Headers({"Content-Type": f"{kind}; charset=utf-8", "ETag": tag})
    headers["Cache-Control"] = "no-cache"
    headers["Vary"] = "Accept-Encoding"
    if request.headers.get("If-None-Match") == tag:
        return Response(http.HTTPStatus.NOT_MODIFIED, "Not Modified", headers)
    return _packable(request, headers, content())


def _script(request: Request, content: bytes) -> Response:
    """Return viser's script; its name changes with its content."""
    headers = Headers({"Content-Type": "text/javascript; charset=utf-8"})
    headers["Cache-Control"] = "private, max-age=31536000, immutable"
    headers["Vary"] = "Accept-Encoding"
    return _packable(request, headers, content)


def _packable(request: Request, headers: Headers, content: bytes) -> Response:
    """Return a file, compressed if the browser accepts that."""
    if "gzip" in request.headers.get("Accept-Encoding", ""):
        headers["Content-Encoding"] = "gzip"
        content = _packed(content)
    headers["Content-Length"] = str(len(content))
    return Response(http.HTTPStatus.OK, "OK", headers, content)


def is_websocket(request: Request) -> bool:
    """Return whether a request asks for a page's connection, not for a file."""
    return request.headers.get("Upgrade", "").lower() == "websocket"


def is_page(request: Request) -> bool:
    """Return whether a request asks for the page, or for a page's connection."""
    path = request.path.partition("?")[0]
    return is_websocket(request) or path in ("/", "/index.html")


def _text(content: bytes) -> Response:
    headers = Headers({"Content-Type": "text/plain; charset=utf-8"})
    headers["Content-Length"] = str(len(content))
    return Response(http.HTTPStatus.OK, "OK", headers, content)


def _parts(request: Request, panels: bool) -> Parts:
    """Return the parts of the page that a request asks for."""
    query = parse_qsl(request.path.partition("?")[2])
    if not panels or ("panels", "0") in query:
        return "view"
    return "window" if NO_VIEW in query else "all"


@cache
def _page(parts: Parts, look: str | None) -> bytes:
    if parts == "window":
        return page.without_view(VISER_PROTOCOL, look or "rviz")
    apart = _taken_apart()
    html = page_of_viser() if apart is None else apart.html
    return page.with_scripts(html, parts == "all", look or "rviz")


@cache
def _taken_apart() -> ViserPage | None:
    return taken_apart(page_of_viser(), _FOLDER)


def page_of_viser() -> bytes:
    """Return viser's HTML page, a single file."""
    html = Path(viser.__file__).parent / "client" / "build" / "index.html"
    return html.read_bytes()


@cache
def _packed(content: bytes) -> bytes:
    return gzip.compress(content, 6, mtime=0)


@cache
def _tag(parts: Parts, look: str | None) -> str:
    return _tag_of(_page(parts, look))


def _tag_of(content: bytes) -> str:
    return f'"{hashlib.sha256(content).hexdigest()[:20]}"'


def plain_page(
    status: http.HTTPStatus,
    title: str,
    text: str,
    more: dict[str, str] | None = None,
) -> Response:
    """Return an answer that a browser shows as a page: a heading and a sentence.

    Args:
        status: status of the answer.
        title: the heading; it must not contain text from a request.
        text: the sentence; the same holds.
        more: further headers.
    """
    content = _PLAIN_PAGE.format(title=title, text=text).encode()
    return _html(status, content, {"Cache-Control": "no-store", **(more or {})})


def reading_page(text: str) -> Response:
    """Return an answer that is a page to read: HTML and styles, and no scripts.

    Args:
        text: the HTML, with text from files and requests escaped.
    """
    more = {
        "Content-Security-Policy": strict_policy("text"),
        "X-Content-Type-Options": "nosniff",
    }
    return _html(http.HTTPStatus.OK, text.encode(), more)


def _html(status: http.HTTPStatus, content: bytes, more: dict[str, str]) -> Response:
    headers = Headers(
        {
            "Content-Type": "text/html; charset=utf-8",
            "Content-Length": str(len(content)),
            "Referrer-Policy": "no-referrer",
            **more,
        }
    )
    return Response(status, status.phrase, headers, content)
