"""The handshake of each connection: check it, answer with a file, or give it a context.

viser's server passes every request through this module before it reads it.
"""

from __future__ import annotations

import asyncio
import contextlib
import http
import re
import socket
from collections.abc import Awaitable, Callable, Generator, Sequence
from functools import partial
from typing import Any, cast
from urllib.parse import parse_qs

import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response
from websockets.protocol import State

from sambot_viz.errors import UsageError
from sambot_viz.options import Options
from sambot_viz.server.channel import SUBPROTOCOL
from sambot_viz.server.connections import page_files
from sambot_viz.server.connections.connection import ClientContext, Connection
from sambot_viz.server.connections.connection_limit import ConnectionLimiter
from sambot_viz.server.connections.traffic import Traffic
from sambot_viz.server.protection import access
from sambot_viz.server.protection.token_check import Knows, TokenCheck
from sambot_viz.server.readiness import ServerState, readiness, stopping
from sambot_viz.server.tickets import Channels

_VERSION_MISMATCH = 1002
COPY = "/copy"
"""Below this path, a page shows a private copy of the shared robot."""
HELP = "/help"
"""Below this path are the explanations of problem codes, as in docs/problems.md."""
METRICS = "/metrics"
"""Path from which a monitoring program reads the counts of this server."""
AnswerMetrics = Callable[[Request], Awaitable[Response]]
_TICKET = re.compile(r"[A-Za-z0-9_-]{16,64}")


def without_base(path: str, base: str) -> str:
    """Return the path of a request below the base path.

    Some proxies remove the base path, and some do not.

    Args:
        path: path with its query: "/robot/?dark".
        base: "/robot", or "/".
    """
    rest = path.removeprefix(base)
    if base == "/" or rest == path or rest[:1] not in ("", "/", "?"):
        return path
    return rest if rest.startswith("/") else f"/{rest}"


def without_copy(path: str) -> tuple[str, bool]:
    """Return the path of a request without `COPY`, and whether it contained `COPY`."""
    where, mark, query = path.partition("?")
    if where != COPY and not where.startswith(f"{COPY}/"):
        return path, False
    return f"{where[len(COPY) :] or '/'}{mark}{query}", True


class Answers:
    """Answers to requests for anything but the page, and the counts of all traffic.

    Attributes:
        metrics: answers a request for the counts; None where they are not enabled or
            there is nothing to count.
        state: returns the state of the server; called on the event loop per request.
        traffic: counts of outgoing messages.
    """

    def __init__(self) -> None:
        self.metrics: AnswerMetrics | None = None
        self.state: Callable[[], ServerState] = lambda: "waiting"
        self.traffic = Traffic()

    def of(self, request: Request) -> Awaitable[Response] | None:
        """Return the answer to a request; None for requests for the page."""
        path = without_copy(request.path)[0].partition("?")[0]
        if path.startswith(f"{HELP}/"):
            return _help(path.removeprefix(f"{HELP}/"))
        if self.metrics is None or path != METRICS:
            return None
        return self.metrics(request)


async def _help(code: str) -> Response:
    """Return the page of a code, or the index of all codes for ""."""
    # Imported late: no page needs it before a user asks.
    from sambot_viz.explanations import as_html, index_html

    try:
        return page_files.reading_page(as_html(code) if code else index_html())
    except UsageError as error:
        return access.plain(http.HTTPStatus.NOT_FOUND, f"{error}.")


@contextlib.contextmanager
def checked(
    options: Options,
    listening: socket.socket | None,
    largest_message: int,
    channels: Channels,
    answers: Answers,
    knows: Knows | None = None,
) -> Generator[asyncio.Event]:
    """Check every request to servers started in this context, before viser does.

    viser has no hook for requests, so this context replaces the function that starts
    viser's server. The port listens before the start is complete, but messages that
    clients send until then stay unread.

    Args:
        options: address to listen on, and who may connect.
        listening: a file-system socket that listens in place of a port, or None.
        largest_message: longest message; a longer one closes the connection [bytes].
        channels: serves the channels of the pages.
        answers: answers requests for anything but the page.
        knows: as for `TokenCheck`.

    Yields:
        An event that releases clients to viser; set it on the server's event loop
        once the inbound filter is in place.
    """
    ready = asyncio.Event()
    module = websockets.asyncio.server
    original: Callable[..., Any] = module.serve
    secrets = (options.token, options.presenter, options.base_path)
    check_token = TokenCheck(*secrets, knows)
    page_files.prepare(options.panels, options.look)
    limiter = ConnectionLimiter()

    def serve(handler: Any, *arguments: Any, **settings: Any) -> Any:
        answer = settings.get("process_request")
        channels.serve_viser = handler

        def check(
            connection: Connection, request: Request
        ) -> Response | Awaitable[Response | None] | None:
            state = answers.state()
            path = without_base(request.path, options.base_path)
            if (answered := readiness(request, path, state)) is not None:
                return answered
            if not limiter.may_stay(connection):
                return limiter.surplus()
            refused = access.refusal(request, options) or check_token.refusal(request)
            if refused:
                return refused
            if folder := _folder(request, options.base_path):
                return access.plain(http.HTTPStatus.SEE_OTHER, "See there.", folder)
            request.path = path
            if state == "stopping":
                return stopping()
            if not page_files.is_websocket(request):
                if (answer_beside := answers.of(request)) is not None:
                    return answer_beside
            request.path, copy = without_copy(request.path)
            presenter = check_token.is_presenter(request)
            connection.context = _context(request, presenter, copy, options)
            is_page = page_files.is_page(request) and not connection.context.channel
            if is_page and not presenter and limiter.is_full(_pages(connection)):
                return limiter.refusal()
            try:
                response = page_files.answer(request, options.panels, options.look)
                if response is None and answer:
                    response = answer(connection, request)
            except (OSError, ValueError):
                # The file name is too long for the system, or contains NUL.
                return access.plain(http.HTTPStatus.NOT_FOUND, "No such page.")
            if page_files.is_websocket(request):
                return response or channels.claim(connection)
            if response is not None:
                response.headers["Content-Security-Policy"] = access.content_policy(
                    request.headers["Host"], options.host, options.allowed_origins
                )
                response.headers["Referrer-Policy"] = "no-referrer"
            return response

        async def handle(connection: ServerConnection) -> None:
            if connection.subprotocol == SUBPROTOCOL:
                await channels.serve(cast(Connection, connection))
            elif connection.subprotocol == page_files.VISER_PROTOCOL:
                await ready.wait()
                # A connection that has closed meanwhile cannot be prepared.
                if connection.state is State.OPEN:
                    await handler(connection)
            else:
                # viser would print a line on the terminal for each attempt.
                await connection.close(_VERSION_MISMATCH, "Version mismatch.")

        select_viser = settings["select_subprotocol"]

        def select(connection: Connection, offered: Sequence[str]) -> Any:
            own = SUBPROTOCOL in offered
            return SUBPROTOCOL if own else select_viser(connection, offered)

        settings["select_subprotocol"] = select
        settings["process_request"] = check
        settings["create_connection"] = partial(Connection, limiter, answers.traffic)
        # This limit also applies to messages that come before the filter reads.
        settings["max_size"] = largest_message
        if listening is not None:
            return original(handle, unix=True, sock=listening, **settings)
        return original(handle, *arguments, **settings)

    module.serve = serve  # type: ignore[assignment, misc]
    try:
        yield ready
    finally:
        module.serve = original  # type: ignore[assignment, misc]


def _context(
    request: Request, presenter: bool, copy: bool, options: Options
) -> ClientContext:
    """Read the context of a client from its request."""
    query = parse_qs(request.path.partition("?")[2])
    ticket = query.get("ticket", [""])[-1]
    offered = ",".join(request.headers.get_all("Sec-WebSocket-Protocol"))
    channel = SUBPROTOCOL in map(str.strip, offered.split(","))
    known = ticket if _TICKET.fullmatch(ticket) else ""
    logins: list[str] = []
    if options.trust_user_header is not None:
        logins = request.headers.get_all(options.trust_user_header)
    # With two headers, one may come from the client itself.
    login = logins[0].strip() if len(logins) == 1 else ""
    # Headers carry letters of all scripts as UTF-8.
    login = login.encode(errors="surrogateescape").decode(errors="replace")
    return ClientContext(presenter, copy, known, channel, login)


def _pages(connection: Connection) -> int:
    """Return the number of open pages, without their channels."""
    open_now = cast("set[Connection]", connection.server.connections)
    return sum(not one.context.channel for one in open_now)


def _folder(request: Request, base: str) -> str:
    """Return the address of a page requested without its final "/"; "" for others.

    The page names its files relative to its folder.
    """
    path, mark, query = request.path.partition("?")
    lacks_slash = path == base != "/" or without_base(path, base) == COPY
    if page_files.is_websocket(request) or not lacks_slash:
        return ""
    return f"./{path.rpartition('/')[2]}/{mark}{query}"
