"""Which web pages may use this server: by default only its own.

viser accepts every connection, so any page that a user visits could open
``ws://localhost:8080``, see the robot and move it. Here a browser is only let in from
the page that this server itself sent, or from an origin that was allowed by name: a
page of another origin is refused, and so is one that reached the server under a foreign
name (DNS rebinding). Other pages cannot show this one in a frame. Programs send no
Origin and are let in.

What stays weak: a server that listens on a network, and has no allowed origins, cannot
know its own names, so it takes any name that a browser reached it by, also a foreign
one. Whoever can reach the port can use the page; passwords and TLS are the job of a
proxy.
"""

from __future__ import annotations

import contextlib
import http
import ipaddress
import socket
from collections.abc import Callable, Generator, Sequence
from typing import Any
from urllib.parse import urlsplit

import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz.server import page_files

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


def framing_policy(listening_on: str, allowed: Sequence[str] = ()) -> str:
    """The Content-Security-Policy: which pages may show this one in a frame.

    Notebooks on this machine may, when the server is for this machine.
    """
    local = ("http://localhost:*", "http://127.0.0.1:*")
    pages = ("'self'", *(local if only_this_machine(listening_on) else ()), *allowed)
    return f"frame-ancestors {' '.join(pages)}"


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
def checked(
    listening_on: str, allowed: Sequence[str] = (), panels: bool = True
) -> Generator[None]:
    """Servers that are started in here check every request before viser answers it.

    viser gives no way to look at a request, so the function with which it starts its
    server is replaced for the moment of the start.
    """
    module = websockets.asyncio.server
    original: Callable[..., Any] = module.serve
    policy = framing_policy(listening_on, allowed)
    page_files.prepare(panels)

    def serve(handler: Any, *arguments: Any, **options: Any) -> Any:
        answer = options.get("process_request")

        def check(connection: ServerConnection, request: Request) -> Any:
            hosts = request.headers.get_all("Host")
            origins = request.headers.get_all("Origin")
            if len(hosts) != 1 or len(origins) > 1:
                return _refusal(http.HTTPStatus.BAD_REQUEST, "One Host, one Origin.")
            origin = origins[0] if origins else None
            if not is_welcome(hosts[0], origin, listening_on, allowed):
                sentence = "This page may not use this server; see --allow-origin."
                return _refusal(http.HTTPStatus.FORBIDDEN, sentence)
            try:
                response = page_files.answer(request, panels)
                if response is None and answer:
                    response = answer(connection, request)
            except (OSError, ValueError):
                # The file name is too long for the system, or contains a NUL.
                return _refusal(http.HTTPStatus.NOT_FOUND, "No such page.")
            if response is not None:
                response.headers["Content-Security-Policy"] = policy
            return response

        async def handle(connection: ServerConnection) -> None:
            if connection.subprotocol == _PROTOCOL:
                await handler(connection)
            else:
                # viser would write a line on the terminal for every attempt.
                await connection.close(_VERSION_MISMATCH, "Version mismatch.")

        options["process_request"] = check
        return original(handle, *arguments, **options)

    module.serve = serve  # type: ignore[assignment, misc]
    try:
        yield
    finally:
        module.serve = original  # type: ignore[assignment, misc]


def _refusal(status: http.HTTPStatus, sentence: str) -> Response:
    content = f"{sentence}\n".encode()
    headers = Headers({"Content-Length": str(len(content))})
    return Response(status, status.phrase, headers, content)
