"""Whether a server answers, and whether it shows something: one word for each.

Service managers, containers and balancers ask, without a token and under any name, so
the answers say nothing of the robot or of people.
"""

from __future__ import annotations

import http
from typing import Literal

from websockets.http11 import Request, Response

from sambot_viz.server.connections.page_files import is_websocket
from sambot_viz.server.protection import access

ANSWERS, READY = "/healthz", "/readyz"
"""Where it is asked whether the process answers, and whether it shows something."""
ServerState = Literal["waiting", "ready", "stopping"]
"""Of a server: nothing is shown yet, something is, or nothing is from now on."""


def readiness(request: Request, path: str, state: ServerState) -> Response | None:
    """Return the answer to a question for the state; None for all other requests.

    Args:
        request: what was asked.
        path: of the request below the base path, with its query.
        state: of the server.
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
    """Return the answer to a page that asks while the server stops."""
    sentence = "This server stops. If it is started again, the page loads by itself."
    response = access.plain(http.HTTPStatus.SERVICE_UNAVAILABLE, sentence)
    response.headers["Retry-After"] = "2"
    return response


def _word(status: http.HTTPStatus, word: str) -> Response:
    response = access.plain(status, word)
    response.headers["Cache-Control"] = "no-store"
    return response
