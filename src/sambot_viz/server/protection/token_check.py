"""The secrets in links: one admits a browser, one makes it a presenter's.

The server answers the first page opened with ``?token=…`` with a cookie and the same
address without the token. So the token is neither in the history nor on a shared
screen. Programs may send it with every request, as ``Authorization: Bearer …`` or in
the address. Where there is a presenter, the links contain ``?view=…`` and
``?present=…``; only the secret counts, so an old link with ``?token=…`` still works.

One weakness remains: without TLS, an eavesdropper on the network can read the token. A
browser that has the token can pass it on.
"""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import http
from collections.abc import Awaitable, Callable
from urllib.parse import parse_qsl, quote, urlencode

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz import limits
from sambot_viz.server.connections.page_files import (
    NO_VIEW,
    is_websocket,
    plain_page,
)

WRONG_ANSWER = 1.0
"""Delay of the answer to a wrong token [s]."""
_KEPT = "%!$&'()*+,;=:@~"
"""Characters that the last part of a path keeps in an answer."""
SECRET_NAMES = ("token", "view", "present")
"""Parameters of an address that may contain a secret."""
Knows = Callable[[str], bool]
"""Receives the Cookie header of a request."""
_REMEMBERED = 30 * 24 * 3600
"""Time for which a browser keeps the cookie [s]."""


class TokenCheck:
    """Admits clients with the token, and recognises presenters by a second secret.

    Guesses slow down for all clients together: a delay per answer, a limit on answers
    at a time, and on the token and cookies in a request. A client that comes while the
    limit of guesses is waiting may try again later.

    Args:
        token: secret that every client needs; None admits everyone.
        presenter: secret of presenters, which admits them too.
        base_path: path of the page and scope of the cookie. With "/", a browser sends
            the cookie to the folder where it opened the page, which is below the path
            of a proxy that removes this path, such as that of Jupyter.
        knows: returns whether the cookies of a request belong to a user whom another
            program, such as Jupyter, has admitted; that is then as good as the token.
            Called in a thread.
    """

    def __init__(
        self,
        token: str | None,
        presenter: str | None = None,
        base_path: str = "/",
        knows: Knows | None = None,
    ) -> None:
        self._needed = token is not None
        self._knows = knows
        self._presenter = None if presenter is None else presenter.encode()
        # By the name of the cookie that holds it. Cookies are shared by all ports of a
        # host, where other servers may run.
        self._tokens = {
            f"sambot-viz-{hashlib.sha256(b'cookie ' + secret).hexdigest()[:12]}": secret
            for secret in (one.encode() for one in (token, presenter) if one)
        }
        self._base = base_path
        self._waiting = 0

    def refusal(self, request: Request) -> Response | Awaitable[Response] | None:
        """Return the answer to a request that may not enter, or must come again.

        Returns:
            None for a request with the token.
        """
        if not self._tokens:
            return None
        address, in_address = _split(request.path)
        given = [*in_address, *_bearers(request.headers)]
        sent = self._cookies(request.headers)
        if not (self._needed or given or sent):
            return None
        if len(given) > 1:
            return plain_page(
                http.HTTPStatus.BAD_REQUEST,
                "More than one token",
                "Open the address as sambot-viz has printed it.",
            )
        if self._waiting >= limits.WRONG_TOKENS.value:
            return plain_page(
                http.HTTPStatus.TOO_MANY_REQUESTS,
                "Too many wrong links at the moment",
                "Load the page again in a few seconds.",
                {"Retry-After": "2"},
            )
        name = self._name_of(given[0]) if given else None
        if name is not None:
            if is_websocket(request) or not in_address:
                return None
            return self._remember(name, address, request.headers)
        if any(_equal(one, self._tokens[name]) for name, one in sent.items()):
            return None
        if self._knows is not None and not given and not is_websocket(request):
            cookies = "; ".join(request.headers.get_all("Cookie"))
            if cookies:
                return self._ask(self._knows, cookies, address, request.headers)
        return self._wrong() if given or sent else _no_token()

    async def _ask(
        self, knows: Knows, cookies: str, address: str, headers: Headers
    ) -> Response:
        """Return the page with the token's cookie, for a logged-in user."""
        # Each costs the other program a request, so they count as guesses.
        self._waiting += 1
        try:
            known = await asyncio.to_thread(knows, cookies)
        finally:
            self._waiting -= 1
        if not known:
            return await self._wrong()
        return self._remember(next(iter(self._tokens)), address, headers)

    def is_presenter(self, request: Request) -> bool:
        """Return whether the browser of a request has the presenter's link."""
        if self._presenter is None:
            return False
        sent = [*_split(request.path)[1], *_bearers(request.headers)]
        sent += self._cookies(request.headers).values()
        # Compare all of them, so that the time reveals nothing.
        return any([_equal(one, self._presenter) for one in sent])

    def _name_of(self, given: bytes) -> str | None:
        """Return the name of the cookie for this token; None for a wrong token."""
        right = [name for name, one in self._tokens.items() if _equal(given, one)]
        return right[0] if right else None

    def _cookies(self, headers: Headers) -> dict[str, bytes]:
        """Return the tokens in the cookies of a request, by cookie name.

        Other programs on the host may have cookies that no parser understands.
        """
        parts = [part for text in headers.get_all("Cookie") for part in text.split(";")]
        pairs = (part.strip().partition("=") for part in reversed(parts))
        return {name: _bytes(one) for name, _, one in pairs if name in self._tokens}

    def _remember(self, name: str, address: str, headers: Headers) -> Response:
        """Return a redirect to the page without the token, with a cookie."""
        cookie = remembered(name, self._tokens[name].decode(), self._base, headers)
        more = {"Location": address, "Set-Cookie": cookie}
        return plain_page(http.HTTPStatus.SEE_OTHER, "See other", "", more)

    async def _wrong(self) -> Response:
        self._waiting += 1
        try:
            await asyncio.sleep(WRONG_ANSWER)
        finally:
            self._waiting -= 1
        return plain_page(
            http.HTTPStatus.UNAUTHORIZED,
            "This link is no longer valid",
            "Its token is wrong. Ask for the link that the program has printed at its "
            "last start.",
        )


def remembered(name: str, value: str, base_path: str, headers: Headers) -> str:
    """Return a Set-Cookie header for a cookie that scripts of a page cannot read.

    Args:
        name: name of the cookie.
        value: a secret.
        base_path: path of the page; as for `TokenCheck`.
        headers: headers of the request.
    """
    path = "" if base_path == "/" else f"Path={base_path}; "
    tls = "https" in headers.get_all("X-Forwarded-Proto")
    secure = "; Secure" if tls else ""
    age = f"Max-Age={_REMEMBERED}"
    return f"{name}={value}; {path}{age}; HttpOnly; SameSite=Lax{secure}"


def _equal(one: bytes, two: bytes) -> bool:
    """Compare secrets in a time that does not depend on their contents."""
    return hmac.compare_digest(one, two)


def _bearers(headers: Headers) -> list[bytes]:
    """Return the tokens that a program sends outside the address."""
    pairs = (text.partition(" ") for text in headers.get_all("Authorization"))
    return [_bytes(one.strip()) for kind, _, one in pairs if kind.lower() == "bearer"]


def _no_token() -> Response:
    return plain_page(
        http.HTTPStatus.UNAUTHORIZED,
        "This robot is only shown to those who have the link",
        "Open the whole address that sambot-viz has printed, "
        "with the token at its end.",
    )


def _bytes(text: str) -> bytes:
    """Encode a text of a request, which may contain bytes that are not text."""
    return text.encode(errors="replace")


def _split(path: str) -> tuple[str, list[bytes]]:
    """Return a path without its tokens, relative to itself, and the tokens."""
    # Not urlsplit, which raises for some paths that a client can send.
    where, _, text = path.partition("?")
    query = parse_qsl(text, keep_blank_values=True)
    others = [pair for pair in query if pair[0] not in SECRET_NAMES or pair == NO_VIEW]
    given = [_bytes(pair[1]) for pair in query if pair not in others]
    rest = urlencode(others, errors="replace")
    # Relative: a proxy may show the page below another path, and on another host.
    where = f"./{quote(where.rpartition('/')[2], safe=_KEPT, errors='replace')}"
    return f"{where}?{rest}" if rest else where, given
