"""Private by default: which web pages may talk to this server.

viser takes every connection, so any page that a user visits could open
``ws://localhost:8080``, see the robot and move it (spec/viser.md §4). Here a browser
is only let in from the page that this server itself sent, or from an origin that was
named: a page of another origin is refused, and so is one that reached a server on
this machine under a foreign name (DNS rebinding). Programs send no Origin and pass.
"""

from __future__ import annotations

import contextlib
import http
import ipaddress
from collections.abc import Callable, Generator, Sequence
from typing import Any
from urllib.parse import urlsplit

import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response


def only_this_machine(host: str) -> bool:
    """Whether an address or name can only be reached from this machine."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def is_welcome(
    host: str, origin: str | None, listening_on: str, allowed: Sequence[str] = ()
) -> bool:
    """Whether a request may be answered.

    Args:
        host: its Host header, such as "127.0.0.1:8080".
        origin: its Origin header, or None (programs, and pages by themselves).
        listening_on: the address the server listens on.
        allowed: origins that were named, such as "https://lab.example.org".
    """
    named = {urlsplit(entry).netloc for entry in allowed}
    if origin is not None and origin in allowed:
        return True
    private = only_this_machine(listening_on) and host not in named
    if private and not only_this_machine(_hostname(host)):
        return False
    return origin is None or urlsplit(origin).netloc == host


def _hostname(netloc: str) -> str:
    try:
        return urlsplit(f"//{netloc}").hostname or ""
    except ValueError:
        return ""


@contextlib.contextmanager
def checked(listening_on: str, allowed: Sequence[str] = ()) -> Generator[None]:
    """Servers that are started in here check who asks, before viser answers.

    viser gives no way to look at a request, so the function with which it starts its
    server is wrapped for the moment of the start.
    """
    module = websockets.asyncio.server
    original: Callable[..., Any] = module.serve

    def serve(handler: Any, *arguments: Any, **options: Any) -> Any:
        answer = options.get("process_request")

        def check(connection: ServerConnection, request: Request) -> Any:
            host = request.headers.get("Host", "")
            origin = request.headers.get("Origin")
            if not is_welcome(host, origin, listening_on, allowed):
                text = b"This page may not use this server; see --allow-origin.\n"
                headers = Headers({"Content-Length": str(len(text))})
                return Response(http.HTTPStatus.FORBIDDEN, "Forbidden", headers, text)
            return answer(connection, request) if answer else None

        options["process_request"] = check
        return original(handler, *arguments, **options)

    module.serve = serve  # type: ignore[assignment, misc]
    try:
        yield
    finally:
        module.serve = original  # type: ignore[assignment, misc]
