"""A page of one heading and a sentence, for those who cannot see the robot."""

from __future__ import annotations

import http

from websockets.datastructures import Headers
from websockets.http11 import Response

_PAGE = """\
<!doctype html><meta charset="utf-8">
<meta name="viewport" content="width=device-width"><title>sambot-viz</title>
<style>body {{ font: 16px/1.5 sans-serif; max-width: 34em; margin: 4em auto }}</style>
<h1>{title}</h1><p>{text}</p>
"""


def plain_page(
    status: http.HTTPStatus,
    title: str,
    text: str,
    more: dict[str, str] | None = None,
) -> Response:
    """An answer that a browser shows as a page.

    Args:
        status: of the answer.
        title: the heading; nothing that a request has brought.
        text: the sentence; as `title`.
        more: further headers.
    """
    content = _PAGE.format(title=title, text=text).encode()
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
