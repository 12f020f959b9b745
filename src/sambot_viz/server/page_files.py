"""Answers requests for the page: viser's with our scripts in it, and our own files."""

from __future__ import annotations

import gzip
import hashlib
import http
from functools import cache
from pathlib import Path
from urllib.parse import unquote

import viser
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz import page


def answer(request: Request) -> Response | None:
    """The response to a request for a page or one of our files; None for others."""
    path = unquote(request.path.partition("?")[0]).lstrip("/")
    if request.headers.get("Upgrade") == "websocket":
        return None
    if path in ("", "index.html"):
        return _response(request, *_index())
    if path.startswith(f"{page.FOLDER}/"):
        found = _file(path.removeprefix(f"{page.FOLDER}/"))
        return None if found is None else _response(request, *found)
    return None


@cache
def _index() -> tuple[bytes, str, str]:
    html = Path(viser.__file__).parent / "client" / "build" / "index.html"
    return _packed(page.with_scripts(html.read_bytes()), "text/html; charset=utf-8")


@cache
def _file(path: str) -> tuple[bytes, str, str] | None:
    found = page.file(path)
    return None if found is None else _packed(*found)


def _packed(content: bytes, media_type: str) -> tuple[bytes, str, str]:
    """The content with gzip, its media type, and its ETag."""
    tag = f'"{hashlib.sha256(content).hexdigest()[:20]}"'
    return gzip.compress(content, 6, mtime=0), media_type, tag


def _response(request: Request, packed: bytes, media_type: str, tag: str) -> Response:
    headers = Headers({"Content-Type": media_type, "ETag": tag})
    headers["Cache-Control"] = "no-cache"
    headers["X-Content-Type-Options"] = "nosniff"
    if request.headers.get("If-None-Match") == tag:
        return Response(http.HTTPStatus.NOT_MODIFIED, "Not Modified", headers)
    content = packed
    if "gzip" in request.headers.get("Accept-Encoding", ""):
        headers["Content-Encoding"] = "gzip"
    else:
        content = gzip.decompress(packed)
    headers["Content-Length"] = str(len(content))
    return Response(http.HTTPStatus.OK, "OK", headers, content)
