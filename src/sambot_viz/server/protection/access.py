"""Decide which web pages may use this server: by default only its own.

viser accepts every connection, so any page that a user visits could open
``ws://localhost:8080``, see the robot and move it. This module admits a browser only
from the page that this server itself sent, or from an origin that was allowed by name.
It refuses pages of other origins, and pages that reached the server under a foreign
name (DNS rebinding). Other pages cannot show this one in a frame. Programs send no
Origin and may connect.

With a token (`server.token_check`), every client needs the token, and the name does not
count: a page under a foreign name has neither the token nor the cookie. So the token
admits the proxy of Jupyter, which shows the page under names that this server cannot
know. That proxy adds the token to all requests that Jupyter admits. Jupyter itself
refuses the websockets of pages of other origins, and its proxy passes Host and Origin
on unchanged, so this module compares them too.

A server that listens on a network accepts its addresses, its host name, and names that
are not for sale: the attack needs a name in the public DNS. Any other name needs an
allowed origin.

One weakness remains: without a token, everyone who can reach the port can use the page.
Passwords of users and TLS are the job of a proxy.
"""

from __future__ import annotations

import http
import ipaddress
import re
import socket
from collections.abc import Sequence
from urllib.parse import urlsplit

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz.options import Options

_HOST = re.compile(r"([A-Za-z0-9._-]+|\[[0-9A-Fa-f:.]+\])(:[0-9]+)?")
"""A Host header; it becomes part of the page's policy."""
_NOT_FOR_SALE = (".local", ".lan", ".internal", ".home.arpa")
"""Ends of names that exist in one network only."""
_ONCE = ("Origin", "Upgrade", "If-None-Match", "Accept-Encoding")
"""Headers that the server reads, and that a request may therefore contain only once."""


def only_this_machine(host: str) -> bool:
    """Return whether only this machine can reach an address or name."""
    address = _address(host)
    return host == "localhost" if address is None else address.is_loopback


def is_welcome(
    host: str,
    origin: str | None,
    listening_on: str,
    allowed: Sequence[str] = (),
    any_name: bool = False,
) -> bool:
    """Return whether a request may be answered.

    Args:
        host: its Host header, such as "127.0.0.1:8080".
        origin: its Origin header, or None (programs, and pages opened directly).
        listening_on: address that the server listens on.
        allowed: allowed origins, such as "https://lab.example.org".
        any_name: whether users may reach the server by a name that it does not know,
            because it requires a token.
    """
    if origin is not None and origin in allowed:
        return True
    name = hostname(host)
    named = (any_name and name != "") or host in map(_netloc, allowed)
    if not named and not _is_own_name(name, listening_on):
        return False
    return origin is None or _netloc(origin) == host


def content_policy(host: str, listening_on: str, allowed: Sequence[str] = ()) -> str:
    """Return the Content-Security-Policy: requests of the page, and who may frame it.

    viser's page would load a robot, and with it scripts, from any server in its address
    (``?websocket=``, ``?playbackPath=``); the policy limits it to its own server.
    Notebooks on this machine may show the page of a server for this machine.

    Args:
        host: the Host header of the request for the page.
        listening_on: as for `is_welcome`.
        allowed: as for `is_welcome`.
    """
    local = ("http://localhost:*", "http://127.0.0.1:*")
    pages = ("'self'", *(local if only_this_machine(listening_on) else ()), *allowed)
    # Some browsers do not apply 'self' to websockets.
    own = f"'self' ws://{host} wss://{host} data: blob:"
    return f"connect-src {own}; frame-ancestors {' '.join(pages)}"


def _address(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        return ipaddress.ip_address(host)
    except ValueError:
        return None


def _is_own_name(name: str, listening_on: str) -> bool:
    """Return whether no foreign page can have been loaded under this name."""
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


def hostname(host: str) -> str:
    """Return the name in a Host header, without its port; "" for an invalid name."""
    match = _HOST.fullmatch(host)
    return "" if match is None else match[1].strip("[]").lower()


def refusal(request: Request, options: Options) -> Response | None:
    """Return the answer to a request from a forbidden origin; None for others."""
    headers = request.headers
    hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
    if len(hosts) != 1 or any(len(headers.get_all(name)) > 1 for name in _ONCE):
        return plain(
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
    return plain(
        http.HTTPStatus.FORBIDDEN,
        f"{sentence}, or start it with --allow-origin and the address that the browser "
        "shows, such as http://lab.example.org:8080.",
    )


def plain(status: http.HTTPStatus, sentence: str, location: str = "") -> Response:
    """Return a response that is one sentence of text."""
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
