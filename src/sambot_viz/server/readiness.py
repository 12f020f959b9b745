"""The server's state in one word: whether it answers, and whether it shows content.

Service managers, containers and load balancers ask without a token and under any name,
so the answers contain nothing about the robot or its users.
"""

from __future__ import annotations

import http
from typing import Literal

from websockets.http11 import Request, Response

from sambot_viz.server.connections.page_files import is_websocket
from sambot_viz.server.protection import access

ANSWERS, READY = "/healthz", "/readyz"
"""Paths that report whether the process answers, and whether it shows content."""
ServerState = Literal["waiting", "ready", "stopping"]
"""State of a server: no content yet, content, or stopping."""


def readiness(request: Request, path: str, state: ServerState) -> Response | None:
    """Return the answer to a request for the state; None for all other requests.

    Args:
        request: the request.
        path: its path below the base path, with its query.
        state: state of the server.
    """
    where = path.partition("?")[0]
    if where not in (ANSWERS, READY) or is_websocket(request):
        return None
    if where == ANSWERS:
        return _word(http.HTTPStatus.OK, "ok")
    good = state == "ready"
    status = http.HTTPStatus.OK if good else http.HTTPStatus.SERVICE_UNAVAILABLE
    return _word(status, state)


def stopping() -> Response:
    """Return the answer to a page request while the server stops."""
    sentence = "This server stops. If it is started again, the page loads by itself."
    response = access.plain(http.HTTPStatus.SERVICE_UNAVAILABLE, sentence)
    response.headers["Retry-After"] = "2"
    return response


def _word(status: http.HTTPStatus, word: str) -> Response:
    response = access.plain(status, word)
    response.headers["Cache-Control"] = "no-store"
    return response
