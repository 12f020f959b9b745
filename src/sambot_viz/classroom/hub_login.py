"""The login of a JupyterHub for a board: OAuth, with the hub as its provider.

A browser without the board's cookie goes to the hub, which lets its user log in and
sends it back with a code. The board exchanges the code for the name and the rights of
that user. The address that has the board's secret works without all this.
"""

from __future__ import annotations

import asyncio
import hmac
import http
import json
import secrets
from collections.abc import Mapping
from typing import Any, cast
from urllib.parse import parse_qs, urlencode

from websockets.http11 import Request, Response

from sambot_viz import limits
from sambot_viz.classroom.asking import ask
from sambot_viz.classroom.hub import PATIENCE, Hub
from sambot_viz.server.connections.page_files import plain_page
from sambot_viz.server.protection import access

CALLBACK = "/oauth_callback"
"""The hub sends browsers back to this path."""
_STATE, _ADMITTED = "sambot-hub-state", "sambot-hub-login"
"""Cookies: of a login that has begun, and of one that was admitted."""
_BEGUN = 600
"""A login ends within this time [s]."""
_PAGES = ("", "/", "/board", "/board/")


class HubLogin:
    """Sends browsers to the hub's login, and admits users with the right for the board.

    Args:
        hub: the hub.
        base_path: path of the board below the name of the hub.
    """

    def __init__(self, hub: Hub, base_path: str) -> None:
        self._hub, self._base = hub, base_path.rstrip("/")
        self._admitted: dict[str, None] = {}

    def knows(self, cookies: str) -> bool:
        """Return whether a Cookie header is of a user whom the hub has admitted."""
        return _cookie(cookies, _ADMITTED) in self._admitted

    async def answer(self, request: Request, path: str) -> Response | None:
        """Return the answer to a step of a login; None for all other requests.

        Args:
            request: a request without the board's secret.
            path: its path below the base path.
        """
        where, _, query = path.partition("?")
        if where == CALLBACK:
            return await self._come_back(request, query)
        known = [*request.headers.get_all("Authorization"), query]
        cookies = "; ".join(request.headers.get_all("Cookie"))
        if where not in _PAGES or any(known) or self.knows(cookies):
            return None
        return self._begin()

    def _begin(self) -> Response:
        state = secrets.token_urlsafe(24)
        asked = {
            "client_id": self._hub.client,
            "redirect_uri": f"{self._base}{CALLBACK}",
            "response_type": "code",
            "state": state,
        }
        address = f"{self._hub.base}hub/api/oauth2/authorize?{urlencode(asked)}"
        return self._go(address, _STATE, state, _BEGUN)

    def _go(self, address: str, name: str, value: str, seconds: int) -> Response:
        found = access.plain(http.HTTPStatus.SEE_OTHER, "See there.", address)
        path = f"{self._base or '/'}"
        kept = f"Path={path}; Max-Age={seconds}; HttpOnly; SameSite=Lax"
        found.headers["Set-Cookie"] = f"{name}={value}; {kept}"
        found.headers["Cache-Control"] = "no-store"
        return found

    async def _come_back(self, request: Request, query: str) -> Response:
        given = {name: values[0] for name, values in parse_qs(query).items()}
        begun = _cookie("; ".join(request.headers.get_all("Cookie")), _STATE)
        state, code = given.get("state", ""), given.get("code", "")
        same = hmac.compare_digest(state.encode(), begun.encode())
        if not (code and begun and same):
            return _refused("This login has not begun here", "Open the board again.")
        user = await asyncio.to_thread(self._user_of, code)
        if user is None:
            return _refused("The hub does not know this login", "Open the board again.")
        if not self._may_enter(user):
            return _refused(
                "This board is for teachers",
                "Ask whoever runs the hub for the right to open this service.",
            )
        if len(self._admitted) >= limits.HUB_STUDENTS.value:
            del self._admitted[next(iter(self._admitted))]
        value = secrets.token_urlsafe(24)
        self._admitted[value] = None
        return self._go(f"{self._base}/board/", _ADMITTED, value, _BEGUN)

    def _may_enter(self, user: Mapping[str, Any]) -> bool:
        service = self._hub.client.removeprefix("service-")
        right = "access:services"
        return not {right, f"{right}!service={service}"}.isdisjoint(
            map(str, user.get("scopes", ()))
        )

    def _user_of(self, code: str) -> Mapping[str, Any] | None:
        """Return the user for a code, as the hub describes it; blocks."""
        fields = {
            "client_id": self._hub.client,
            "client_secret": self._hub.token,
            "grant_type": "authorization_code",
            "code": code,
            "redirect_uri": f"{self._base}{CALLBACK}",
        }
        answer = self._ask("oauth2/token", {}, urlencode(fields).encode())
        token = answer.get("access_token")
        if not isinstance(token, str):
            return None
        return self._ask("user", {"Authorization": f"token {token}"}) or None

    def _ask(
        self, path: str, headers: Mapping[str, str], data: bytes | None = None
    ) -> Mapping[str, Any]:
        """Return a document of the hub; an empty one if there is none."""
        address, largest = f"{self._hub.api}/{path}", limits.HUB_ANSWER.value
        try:
            status, content = ask(address, PATIENCE, largest, headers, data)
            read: Any = json.loads(content) if status == http.HTTPStatus.OK else None
        except (OSError, ValueError, RecursionError):
            return {}
        return cast("Mapping[str, Any]", read) if isinstance(read, dict) else {}


def _cookie(cookies: str, name: str) -> str:
    pairs = (part.strip().partition("=") for part in cookies.split(";"))
    return next((value for found, _, value in pairs if found == name), "")


def _refused(title: str, sentence: str) -> Response:
    return plain_page(http.HTTPStatus.FORBIDDEN, title, sentence)
