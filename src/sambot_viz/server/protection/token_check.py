"""The secrets in links: one lets a browser in, one makes it a presenter's.

The first page that is opened with ``?token=…`` is answered with a cookie and the same
address without the token, which so is neither in the history nor on a screen that is
shared. Programs may send it with every request, as ``Authorization: Bearer …`` or in
the address. Where there is a presenter, the links say ``?view=…`` and ``?present=…``;
only the secret counts, so a link that was noted down as ``?token=…`` still works.

What stays weak: without TLS, whoever reads along on the network reads the token too; a
browser that has it can pass it on.
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
"""The answer to a wrong token takes so long [s]."""
_KEPT = "%!$&'()*+,;=:@~"
"""In the last part of a path, what is sent back as it came."""
SECRET_NAMES = ("token", "view", "present")
"""The parameters of an address that may hold a secret."""
Knows = Callable[[str], bool]
"""Takes the Cookie header of a request."""
_REMEMBERED = 30 * 24 * 3600
"""How long a browser keeps the cookie [s]."""


class TokenCheck:
    """Lets in who has the token, and knows the presenter by another one.

    Guesses are slowed down for all together: so many seconds for an answer, so many
    answers at a time, one token and the cookies in a request. Who comes while that many
    guesses wait may try again later.

    Args:
        token: the secret without which nobody is let in; None lets everyone in.
        presenter: the secret of presenters, which lets them in too.
        base_path: where the page is; the cookie is sent to nowhere else. With "/" a
            browser sends it to where the page was opened, which is below the path of a
            proxy that takes it away, such as that of Jupyter.
        knows: says whether the cookies of a request are those of a user whom another
            program has let in, such as Jupyter; this is then as good as the token. It
            is called in a thread.
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
        # By the name of the cookie that remembers it. Cookies are shared by all ports
        # of a host, where other servers may be.
        self._tokens = {
            f"sambot-viz-{hashlib.sha256(b'cookie ' + secret).hexdigest()[:12]}": secret
            for secret in (one.encode() for one in (token, presenter) if one)
        }
        self._base = base_path
        self._waiting = 0

    def refusal(self, request: Request) -> Response | Awaitable[Response] | None:
        """The answer to a request that may not come in, or is to come in again.

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
        """Return the page with the cookie of the token, for who is logged in."""
        # Each costs the other program a request: they are counted with the guesses.
        self._waiting += 1
        try:
            known = await asyncio.to_thread(knows, cookies)
        finally:
            self._waiting -= 1
        if not known:
            return await self._wrong()
        return self._remember(next(iter(self._tokens)), address, headers)

    def is_presenter(self, request: Request) -> bool:
        """Whether a request comes from a browser that has the presenter's link."""
        if self._presenter is None:
            return False
        sent = [*_split(request.path)[1], *_bearers(request.headers)]
        sent += self._cookies(request.headers).values()
        # All are looked at, so that the time says nothing.
        return any([_equal(one, self._presenter) for one in sent])

    def _name_of(self, given: bytes) -> str | None:
        """The cookie of the token that this is; None when it is none."""
        right = [name for name, one in self._tokens.items() if _equal(given, one)]
        return right[0] if right else None

    def _cookies(self, headers: Headers) -> dict[str, bytes]:
        """The tokens in the cookies of a request, by the names of these.

        Other programs of the same host have cookies that no parser may know.
        """
        parts = [part for text in headers.get_all("Cookie") for part in text.split(";")]
        pairs = (part.strip().partition("=") for part in reversed(parts))
        return {name: _bytes(one) for name, _, one in pairs if name in self._tokens}

    def _remember(self, name: str, address: str, headers: Headers) -> Response:
        """The same page without the token in its address, and with a cookie."""
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
    """Return a Set-Cookie header that a browser keeps, and no script of a page reads.

    Args:
        name: of the cookie.
        value: a secret.
        base_path: where the page is; as for `TokenCheck`.
        headers: of the request that is answered.
    """
    path = "" if base_path == "/" else f"Path={base_path}; "
    tls = "https" in headers.get_all("X-Forwarded-Proto")
    secure = "; Secure" if tls else ""
    age = f"Max-Age={_REMEMBERED}"
    return f"{name}={value}; {path}{age}; HttpOnly; SameSite=Lax{secure}"


def _equal(one: bytes, two: bytes) -> bool:
    """Compare secrets; the time that it takes says nothing about them."""
    return hmac.compare_digest(one, two)


def _bearers(headers: Headers) -> list[bytes]:
    """The tokens that a program sends beside the address."""
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
    """A text of a request, which may hold bytes that are no text."""
    return text.encode(errors="replace")


def _split(path: str) -> tuple[str, list[bytes]]:
    """Where a path leads without the tokens in it, relative to it, and these."""
    # Not urlsplit, which raises for some paths that a client can send.
    where, _, text = path.partition("?")
    query = parse_qsl(text, keep_blank_values=True)
    others = [pair for pair in query if pair[0] not in SECRET_NAMES or pair == NO_VIEW]
    given = [_bytes(pair[1]) for pair in query if pair not in others]
    rest = urlencode(others, errors="replace")
    # Relative: a proxy may show the page below another path, and on another host.
    where = f"./{quote(where.rpartition('/')[2], safe=_KEPT, errors='replace')}"
    return f"{where}?{rest}" if rest else where, given
