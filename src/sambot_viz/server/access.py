"""Which web pages may use this server: by default only its own.

viser accepts every connection, so any page that a user visits could open
``ws://localhost:8080``, see the robot and move it. Here a browser is only let in from
the page that this server itself sent, or from an origin that was allowed by name: a
page of another origin is refused, and so is one that reached the server under a foreign
name (DNS rebinding). Other pages cannot show this one in a frame. Programs send no
Origin and are let in. With a token (`server.token_check`), nobody is let in without it.

What stays weak: a server that listens on a network, and has no allowed origins, cannot
know its own names, so it takes any name that a browser reached it by, also a foreign
one. Without a token, whoever can reach the port can use the page. Passwords of users
and TLS are the job of a proxy.
"""

from __future__ import annotations

import contextlib
import http
import ipaddress
import socket
from collections.abc import Awaitable, Callable, Generator, Sequence
from typing import Any
from urllib.parse import urlsplit

import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz.options import Options
from sambot_viz.server import page_files
from sambot_viz.server.token_check import TokenCheck

_PROTOCOL = f"viser-v{viser.__version__}"
_VERSION_MISMATCH = 1002


def only_this_machine(host: str) -> bool:
    """Whether an address or name can only be reached from this machine."""
    address = _address(host)
    return host == "localhost" if address is None else address.is_loopback


def is_welcome(
    host: str, origin: str | None, listening_on: str, allowed: Sequence[str] = ()
) -> bool:
    """Whether a request may be answered.

    Args:
        host: its Host header, such as "127.0.0.1:8080".
        origin: its Origin header, or None (programs, and pages by themselves).
        listening_on: the address the server listens on.
        allowed: origins that were allowed, such as "https://lab.example.org".
    """
    if origin is not None and origin in allowed:
        return True
    if host not in map(_netloc, allowed):
        name = _hostname(host)
        if only_this_machine(listening_on):
            if not only_this_machine(name):
                return False
        elif allowed and not _is_own_name(name):
            return False
    return origin is None or _netloc(origin) == host


def content_policy(host: str, listening_on: str, allowed: Sequence[str] = ()) -> str:
    """The Content-Security-Policy: what the page may ask for, and who may frame it.

    viser's page would take a robot, and with it scripts, from any server that its
    address names (``?websocket=``, ``?playbackPath=``); it may only ask its own.
    Notebooks on this machine may show it, when the server is for this machine.

    Args:
        host: the Host header of the request for the page.
        listening_on: as for `is_welcome`.
        allowed: as for `is_welcome`.
    """
    local = ("http://localhost:*", "http://127.0.0.1:*")
    pages = ("'self'", *(local if only_this_machine(listening_on) else ()), *allowed)
    # Not all browsers take 'self' for websockets too.
    own = f"'self' ws://{host} wss://{host} data: blob:"
    return f"connect-src {own}; frame-ancestors {' '.join(pages)}"


def without_base(path: str, base: str) -> str:
    """The path of a request below the base path.

    Some proxies take the base path away, and some do not.

    Args:
        path: with its query: "/robot/?dark".
        base: "/robot", or "/".
    """
    rest = path.removeprefix(base)
    if base == "/" or rest == path or rest[:1] not in ("", "/", "?"):
        return path
    return rest if rest.startswith("/") else f"/{rest}"


def _address(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        return ipaddress.ip_address(host)
    except ValueError:
        return None


def _is_own_name(name: str) -> bool:
    """Whether no foreign page can have been reached under this name."""
    own = socket.gethostname()
    return _address(name) is not None or name in ("localhost", own, f"{own}.local")


def _netloc(origin: str) -> str:
    try:
        return urlsplit(origin).netloc
    except ValueError:
        return ""


def _hostname(netloc: str) -> str:
    try:
        return urlsplit(f"//{netloc}").hostname or ""
    except ValueError:
        return ""


@contextlib.contextmanager
def checked(options: Options) -> Generator[None]:
    """Servers that are started in here check every request before viser answers it.

    viser gives no way to look at a request, so the function with which it starts its
    server is replaced for the moment of the start.

    Args:
        options: where the server listens, and for whom.
    """
    module = websockets.asyncio.server
    original: Callable[..., Any] = module.serve
    token = (
        None if options.token is None else TokenCheck(options.token, options.base_path)
    )
    page_files.prepare(options.panels)

    def serve(handler: Any, *arguments: Any, **settings: Any) -> Any:
        answer = settings.get("process_request")

        def check(
            connection: ServerConnection, request: Request
        ) -> Response | Awaitable[Response] | None:
            refused = _refusal(request, options) or (token and token.refusal(request))
            if refused:
                return refused
            path, _, query = request.path.partition("?")
            if path == options.base_path != "/" and not page_files.is_websocket(
                request
            ):
                # The page names its files relative to the folder it is in.
                where = f"./{path.rpartition('/')[2]}/{'?' if query else ''}{query}"
                return _plain(http.HTTPStatus.SEE_OTHER, "See there.", where)
            request.path = without_base(request.path, options.base_path)
            try:
                response = page_files.answer(request, options.panels)
                if response is None and answer:
                    response = answer(connection, request)
            except (OSError, ValueError):
                # The file name is too long for the system, or contains a NUL.
                return _plain(http.HTTPStatus.NOT_FOUND, "No such page.")
            if response is not None:
                response.headers["Content-Security-Policy"] = content_policy(
                    request.headers["Host"], options.host, options.allowed_origins
                )
                response.headers["Referrer-Policy"] = "no-referrer"
            return response

        async def handle(connection: ServerConnection) -> None:
            if connection.subprotocol == _PROTOCOL:
                await handler(connection)
            else:
                # viser would write a line on the terminal for every attempt.
                await connection.close(_VERSION_MISMATCH, "Version mismatch.")

        settings["process_request"] = check
        return original(handle, *arguments, **settings)

    module.serve = serve  # type: ignore[assignment, misc]
    try:
        yield
    finally:
        module.serve = original  # type: ignore[assignment, misc]


def _refusal(request: Request, options: Options) -> Response | None:
    """The answer to a request from where none may come."""
    hosts, origins = (request.headers.get_all(name) for name in ("Host", "Origin"))
    if len(hosts) != 1 or len(origins) > 1:
        return _plain(http.HTTPStatus.BAD_REQUEST, "One Host, one Origin.")
    origin = origins[0] if origins else None
    if is_welcome(hosts[0], origin, options.host, options.allowed_origins):
        return None
    sentence = "This page may not use this server; see --allow-origin."
    return _plain(http.HTTPStatus.FORBIDDEN, sentence)


def _plain(status: http.HTTPStatus, sentence: str, location: str = "") -> Response:
    content = f"{sentence}\n".encode()
    headers = Headers({"Content-Length": str(len(content))})
    if location:
        headers["Location"] = location
    return Response(status, status.phrase, headers, content)
