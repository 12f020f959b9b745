"""Answer requests for the page, which is that of viser with our scripts in it."""

from __future__ import annotations

import gzip
import hashlib
import http
from functools import cache
from pathlib import Path

import viser
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz import page

LICENSES = "/sambot/licenses.txt"
"""Where the licences of the libraries in the page are."""
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
    _tag(panels, look)


def answer(
    request: Request, panels: bool = True, look: str | None = None
) -> Response | None:
    """The response to a request for the page or its licences; None for all others.

    Args:
        request: the request.
        panels: whether the page has panels round its view.
        look: how a page draws that has chosen nothing; None is RViz's.
    """
    if is_websocket(request):
        return None
    if request.path.partition("?")[0] == LICENSES:
        return _text(page.licenses())
    if not is_page(request):
        return None
    headers = Headers(
        {"Content-Type": "text/html; charset=utf-8", "ETag": _tag(panels, look)}
    )
    headers["Cache-Control"] = "no-cache"
    headers["Vary"] = "Accept-Encoding"
    if request.headers.get("If-None-Match") == _tag(panels, look):
        return Response(http.HTTPStatus.NOT_MODIFIED, "Not Modified", headers)
    content = _page(panels, look)
    if "gzip" in request.headers.get("Accept-Encoding", ""):
        headers["Content-Encoding"] = "gzip"
        content = _packed(panels, look)
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


@cache
def _page(panels: bool, look: str | None) -> bytes:
    return page.with_scripts(page_of_viser(), panels, look or "rviz")


def page_of_viser() -> bytes:
    """The HTML page that comes with viser, all in one."""
    html = Path(viser.__file__).parent / "client" / "build" / "index.html"
    return html.read_bytes()


@cache
def _packed(panels: bool, look: str | None) -> bytes:
    return gzip.compress(_page(panels, look), 6, mtime=0)


@cache
def _tag(panels: bool, look: str | None) -> str:
    return f'"{hashlib.sha256(_page(panels, look)).hexdigest()[:20]}"'


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
    headers = Headers(
        {
            "Content-Type": "text/html; charset=utf-8",
            "Content-Length": str(len(content)),
            "Cache-Control": "no-store",
            "Referrer-Policy": "no-referrer",
            **(more or {}),
        }
    )
    return Response(status, status.phrase, headers, content)
