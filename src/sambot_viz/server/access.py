"""Which web pages may use this server: by default only its own.

viser accepts every connection, so any page that a user visits could open
``ws://localhost:8080``, see the robot and move it. Here a browser is only let in from
the page that this server itself sent, or from an origin that was allowed by name: a
page of another origin is refused, and so is one that reached the server under a foreign
name (DNS rebinding). Other pages cannot show this one in a frame. Programs send no
Origin and are let in. With a token (`server.token_check`), nobody is let in without it,
and the name does not count: a page under a foreign name has neither the token nor the
cookie. So the proxy of Jupyter, which shows the page under names that this server
cannot know, is let in with the token. That proxy adds the token to all that Jupyter
lets through, but Jupyter itself refuses the websockets of pages of another origin, and
it passes Host and Origin on as they came, so that they are compared here too.

A server that listens on a network takes its addresses, its host name, and names that
cannot be bought: the attack needs a name in the DNS of all. Any other name has to be
allowed as an origin.

What stays weak: without a token, whoever can reach the port can use the page. Passwords
of users and TLS are the job of a proxy.
"""

from __future__ import annotations

import asyncio
import contextlib
import http
import ipaddress
import re
import socket
from collections.abc import Awaitable, Callable, Generator, Sequence
from functools import partial
from typing import Any, cast
from urllib.parse import parse_qs, urlsplit

import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response
from websockets.protocol import State

from sambot_viz.options import Options
from sambot_viz.server import page_files
from sambot_viz.server.channel import SUBPROTOCOL, Channels
from sambot_viz.server.connection import ClientContext, Connection
from sambot_viz.server.connection_limit import ConnectionLimiter
from sambot_viz.server.token_check import TokenCheck

_PROTOCOL = f"viser-v{viser.__version__}"
_VERSION_MISMATCH = 1002
_HOST = re.compile(r"([A-Za-z0-9._-]+|\[[0-9A-Fa-f:.]+\])(:[0-9]+)?")
"""A Host header; it goes into the policy of the page."""
_NOT_FOR_SALE = (".local", ".lan", ".internal", ".home.arpa")
"""Names with these ends are only known in one network."""
COPY = "/copy"
"""Below this path, a page shows a private copy of the shared robot."""
_TICKET = re.compile(r"[A-Za-z0-9_-]{16,64}")
_ONCE = ("Origin", "Upgrade", "If-None-Match", "Accept-Encoding")
"""Headers that are read, and so may be there once at most."""


def only_this_machine(host: str) -> bool:
    """Whether an address or name can only be reached from this machine."""
    address = _address(host)
    return host == "localhost" if address is None else address.is_loopback


def is_welcome(
    host: str,
    origin: str | None,
    listening_on: str,
    allowed: Sequence[str] = (),
    any_name: bool = False,
) -> bool:
    """Whether a request may be answered.

    Args:
        host: its Host header, such as "127.0.0.1:8080".
        origin: its Origin header, or None (programs, and pages by themselves).
        listening_on: the address the server listens on.
        allowed: origins that were allowed, such as "https://lab.example.org".
        any_name: whether the server may be reached by a name that it does not know,
            because it asks for a token.
    """
    if origin is not None and origin in allowed:
        return True
    name = _hostname(host)
    named = (any_name and name != "") or host in map(_netloc, allowed)
    if not named and not _is_own_name(name, listening_on):
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


def without_copy(path: str) -> tuple[str, bool]:
    """Return the path of a request without `COPY`, and whether that was in it."""
    where, mark, query = path.partition("?")
    if where != COPY and not where.startswith(f"{COPY}/"):
        return path, False
    return f"{where[len(COPY) :] or '/'}{mark}{query}", True


def _address(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        return ipaddress.ip_address(host)
    except ValueError:
        return None


def _is_own_name(name: str, listening_on: str) -> bool:
    """Whether no page of a stranger can have been reached under this name."""
    if only_this_machine(listening_on):
        return only_this_machine(name)
    if name == "" or _address(name) is not None:
        return name != ""
    own = name in (listening_on, socket.gethostname())
    return own or "." not in name or name.endswith(_NOT_FOR_SALE)


def _netloc(origin: str) -> str:
    try:
        return urlsplit(origin).netloc
    except ValueError:
        return ""


def _hostname(host: str) -> str:
    """The name in a Host header, without its port; "" for what is not a name."""
    match = _HOST.fullmatch(host)
    return "" if match is None else match[1].strip("[]").lower()


@contextlib.contextmanager
def checked(
    options: Options,
    listening: socket.socket | None,
    largest_message: int,
    channels: Channels,
) -> Generator[asyncio.Event]:
    """Check every request to a server that is started in here before viser does.

    viser gives no way to look at a request, so the function with which it starts its
    server is replaced for the moment of the start. The port listens before that start
    is over: what clients send meanwhile is not read.

    Args:
        options: where the server listens, and for whom.
        listening: a socket of the file system that listens in place of a port, or None.
        largest_message: a connection that sends a longer one is closed [bytes].
        channels: serves the channels of the pages.

    Yields:
        The event after which clients are given to viser, to be set on the event loop
        of the server when the inbound filter is there.
    """
    ready = asyncio.Event()
    module = websockets.asyncio.server
    original: Callable[..., Any] = module.serve
    check_token = TokenCheck(options.token, options.presenter, options.base_path)
    page_files.prepare(options.panels)
    limiter = ConnectionLimiter()

    def serve(handler: Any, *arguments: Any, **settings: Any) -> Any:
        answer = settings.get("process_request")

        def check(
            connection: Connection, request: Request
        ) -> Response | Awaitable[Response | None] | None:
            refused = _refusal(request, options) or check_token.refusal(request)
            if refused:
                return refused
            if folder := _folder(request, options.base_path):
                return _plain(http.HTTPStatus.SEE_OTHER, "See there.", folder)
            request.path = without_base(request.path, options.base_path)
            request.path, copy = without_copy(request.path)
            presenter = check_token.is_presenter(request)
            connection.context = _context(request, presenter, copy)
            is_page = page_files.is_page(request) and not connection.context.channel
            if is_page and not presenter and limiter.is_full(_pages(connection)):
                return limiter.refusal()
            try:
                response = page_files.answer(request, options.panels)
                if response is None and answer:
                    response = answer(connection, request)
            except (OSError, ValueError):
                # The file name is too long for the system, or contains a NUL.
                return _plain(http.HTTPStatus.NOT_FOUND, "No such page.")
            if page_files.is_websocket(request):
                return response or channels.claim(connection)
            if response is not None:
                response.headers["Content-Security-Policy"] = content_policy(
                    request.headers["Host"], options.host, options.allowed_origins
                )
                response.headers["Referrer-Policy"] = "no-referrer"
            return response

        async def handle(connection: ServerConnection) -> None:
            if connection.subprotocol == SUBPROTOCOL:
                await channels.serve(cast(Connection, connection))
            elif connection.subprotocol == _PROTOCOL:
                await ready.wait()
                # One that has left meanwhile has nothing that could be prepared.
                if connection.state is State.OPEN:
                    await handler(connection)
            else:
                # viser would write a line on the terminal for every attempt.
                await connection.close(_VERSION_MISMATCH, "Version mismatch.")

        select_viser = settings["select_subprotocol"]

        def select(connection: Connection, offered: Sequence[str]) -> Any:
            own = SUBPROTOCOL in offered
            return SUBPROTOCOL if own else select_viser(connection, offered)

        settings["select_subprotocol"] = select
        settings["process_request"] = check
        settings["create_connection"] = partial(Connection, limiter)
        # Also for what is sent before the filter reads it.
        settings["max_size"] = largest_message
        if listening is not None:
            return original(handle, unix=True, sock=listening, **settings)
        return original(handle, *arguments, **settings)

    module.serve = serve  # type: ignore[assignment, misc]
    try:
        yield ready
    finally:
        module.serve = original  # type: ignore[assignment, misc]


def _context(request: Request, presenter: bool, copy: bool) -> ClientContext:
    """Return what a request says of its client."""
    query = parse_qs(request.path.partition("?")[2])
    ticket = query.get("ticket", [""])[-1]
    offered = ",".join(request.headers.get_all("Sec-WebSocket-Protocol"))
    channel = SUBPROTOCOL in map(str.strip, offered.split(","))
    known = ticket if _TICKET.fullmatch(ticket) else ""
    return ClientContext(presenter, copy, known, channel)


def _pages(connection: Connection) -> int:
    """Return how many pages are open: their channels are not counted."""
    open_now = cast("set[Connection]", connection.server.connections)
    return sum(not one.context.channel for one in open_now)


def _refusal(request: Request, options: Options) -> Response | None:
    """The answer to a request from where none may come."""
    headers = request.headers
    hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
    if len(hosts) != 1 or any(len(headers.get_all(name)) > 1 for name in _ONCE):
        return _plain(
            http.HTTPStatus.BAD_REQUEST, f"One Host; one {', '.join(_ONCE)} at most."
        )
    host, origin = hosts[0], origins[0] if origins else None
    any_name = options.token is not None
    if is_welcome(host, origin, options.host, options.allowed_origins, any_name):
        return None
    if is_welcome(host, None, options.host, options.allowed_origins, any_name):
        sentence = "A page of another address may not use this server"
    else:
        sentence = (
            "This server is not known by this name: open it by the address of its "
            "machine"
        )
    return _plain(
        http.HTTPStatus.FORBIDDEN,
        f"{sentence}, or start it with --allow-origin and the address that the browser "
        "shows, such as http://lab.example.org:8080.",
    )


def _folder(request: Request, base: str) -> str:
    """Where a page is that is asked for without the "/" at its end; "" for others.

    The page names its files relative to the folder it is in.
    """
    path, mark, query = request.path.partition("?")
    lacks_slash = path == base != "/" or without_base(path, base) == COPY
    if page_files.is_websocket(request) or not lacks_slash:
        return ""
    return f"./{path.rpartition('/')[2]}/{mark}{query}"


def _plain(status: http.HTTPStatus, sentence: str, location: str = "") -> Response:
    content = f"{sentence}\n".encode()
    headers = Headers(
        {
            "Content-Type": "text/plain; charset=utf-8",
            "Content-Length": str(len(content)),
        }
    )
    if location:
        headers["Location"] = location
    return Response(status, status.phrase, headers, content)
