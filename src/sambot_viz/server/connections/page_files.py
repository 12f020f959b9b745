"""Answer requests for the page, which is that of viser with our scripts in it."""

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
from sambot_viz.server.connections.viser_page import ViserPage, taken_apart

VISER_PROTOCOL = f"viser-v{viser.__version__}"
"""What a client of viser asks for when it opens its connection."""
NO_VIEW = ("view", "none")
"""In the query of an address: a page without a view."""
Parts = Literal["all", "view", "window"]
"""What a page has: the view in a window, the view alone, or a window without it."""
_FOLDER = "sambot/"
"""Where the files beside the page are."""
LICENSES = f"/{_FOLDER}licenses.txt"
"""Where the licences of the libraries in the page are."""
CODEMIRROR = f"/{_FOLDER}codemirror.js"
"""Where the editor is, which no page asks for before its panel is opened."""
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
    """The response to a request for the page or its licences; None for all others.

    Args:
        request: the request.
        panels: whether the program has panels round its view.
        look: how a page draws that has chosen nothing; None is RViz's.
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
    """The editor: its name is the same in all versions."""
    tag = _tag_of(page.codemirror())
    return _kept(request, "text/javascript", tag, page.codemirror)


def _kept(
    request: Request, kind: str, tag: str, content: Callable[[], bytes]
) -> Response:
    """Return a file that a browser keeps, and asks for whether it has changed."""
    headers = Headers({"Content-Type": f"{kind}; charset=utf-8", "ETag": tag})
    headers["Cache-Control"] = "no-cache"
    headers["Vary"] = "Accept-Encoding"
    if request.headers.get("If-None-Match") == tag:
        return Response(http.HTTPStatus.NOT_MODIFIED, "Not Modified", headers)
    return _packable(request, headers, content())


def _script(request: Request, content: bytes) -> Response:
    """Viser's script: what has another content has another name."""
    headers = Headers({"Content-Type": "text/javascript; charset=utf-8"})
    headers["Cache-Control"] = "private, max-age=31536000, immutable"
    headers["Vary"] = "Accept-Encoding"
    return _packable(request, headers, content)


def _packable(request: Request, headers: Headers, content: bytes) -> Response:
    """Return a file, packed if the browser takes that."""
    if "gzip" in request.headers.get("Accept-Encoding", ""):
        headers["Content-Encoding"] = "gzip"
        content = _packed(content)
    headers["Content-Length"] = str(len(content))
    return Response(http.HTTPStatus.OK, "OK", headers, content)


def is_websocket(request: Request) -> bool:
    """Whether a request asks for the connection of a page, not for a file."""
    return request.headers.get("Upgrade", "").lower() == "websocket"


def is_page(request: Request) -> bool:
    """Whether a request asks for the page, or for the connection of one."""
    path = request.path.partition("?")[0]
    return is_websocket(request) or path in ("/", "/index.html")


def _text(content: bytes) -> Response:
    headers = Headers({"Content-Type": "text/plain; charset=utf-8"})
    headers["Content-Length"] = str(len(content))
    return Response(http.HTTPStatus.OK, "OK", headers, content)


def _parts(request: Request, panels: bool) -> Parts:
    """What is in the page that a request asks for."""
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
    """The HTML page that comes with viser, all in one."""
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
    """Return an answer that a browser shows as a page: one heading and a sentence.

    Args:
        status: of the answer.
        title: the heading; nothing that a request has brought.
        text: the sentence; as `title`.
        more: further headers.
    """
    content = _PLAIN_PAGE.format(title=title, text=text).encode()
    return _html(status, content, {"Cache-Control": "no-store", **(more or {})})


def reading_page(text: str) -> Response:
    """Return an answer that is a page to read: HTML and styles, and nothing that runs.

    Args:
        text: the HTML; what a file or a request has brought is escaped in it.
    """
    policy = "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'"
    more = {"Content-Security-Policy": policy, "X-Content-Type-Options": "nosniff"}
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
