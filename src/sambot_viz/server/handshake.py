"""The handshake of each connection: checked, answered with a file, or given a context.

viser's server passes every request through here before it looks at it.
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
"""Below this path is what the codes of problems mean, as in docs/problems.md."""
METRICS = "/metrics"
"""Where a program that watches many servers asks this one for its counts."""
AnswerMetrics = Callable[[Request], Awaitable[Response]]
_TICKET = re.compile(r"[A-Za-z0-9_-]{16,64}")


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


class Answers:
    """What is answered beside the page, and what is counted of all that goes out.

    Attributes:
        metrics: answers a request for the counts; None while there is nothing to
            count, or nobody asked for it.
        state: of the server; called on the event loop for each request.
        traffic: what goes out.
    """

    def __init__(self) -> None:
        self.metrics: AnswerMetrics | None = None
        self.state: Callable[[], ServerState] = lambda: "waiting"
        self.traffic = Traffic()

    def of(self, request: Request) -> Awaitable[Response] | None:
        """Return the answer to a request; None for all that ask for the page."""
        path = without_copy(request.path)[0].partition("?")[0]
        if path.startswith(f"{HELP}/"):
            return _help(path.removeprefix(f"{HELP}/"))
        if self.metrics is None or path != METRICS:
            return None
        return self.metrics(request)


async def _help(code: str) -> Response:
    """Return the page of a code, or that of all codes for ""."""
    # No page needs it before a user asks.
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
    """Check every request to a server that is started in here before viser does.

    viser gives no way to look at a request, so the function with which it starts its
    server is replaced for the moment of the start. The port listens before that start
    is over: what clients send meanwhile is not read.

    Args:
        options: where the server listens, and for whom.
        listening: a socket of the file system that listens in place of a port, or None.
        largest_message: a connection that sends a longer one is closed [bytes].
        channels: serves the channels of the pages.
        answers: to requests for something else than the page.
        knows: as for `TokenCheck`.

    Yields:
        The event after which clients are given to viser, to be set on the event loop
        of the server when the inbound filter is there.
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
                # The file name is too long for the system, or contains a NUL.
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
        settings["create_connection"] = partial(Connection, limiter, answers.traffic)
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


def _context(
    request: Request, presenter: bool, copy: bool, options: Options
) -> ClientContext:
    """Return what a request says of its client."""
    query = parse_qs(request.path.partition("?")[2])
    ticket = query.get("ticket", [""])[-1]
    offered = ",".join(request.headers.get_all("Sec-WebSocket-Protocol"))
    channel = SUBPROTOCOL in map(str.strip, offered.split(","))
    known = ticket if _TICKET.fullmatch(ticket) else ""
    logins: list[str] = []
    if options.trust_user_header is not None:
        logins = request.headers.get_all(options.trust_user_header)
    # Of two, one may be the client's own.
    login = logins[0].strip() if len(logins) == 1 else ""
    # Letters of all scripts are UTF-8 in a header.
    login = login.encode(errors="surrogateescape").decode(errors="replace")
    return ClientContext(presenter, copy, known, channel, login)


def _pages(connection: Connection) -> int:
    """Return how many pages are open: their channels are not counted."""
    open_now = cast("set[Connection]", connection.server.connections)
    return sum(not one.context.channel for one in open_now)


def _folder(request: Request, base: str) -> str:
    """Where a page is that is asked for without the "/" at its end; "" for others.

    The page names its files relative to the folder it is in.
    """
    path, mark, query = request.path.partition("?")
    lacks_slash = path == base != "/" or without_base(path, base) == COPY
    if page_files.is_websocket(request) or not lacks_slash:
        return ""
    return f"./{path.rpartition('/')[2]}/{mark}{query}"
