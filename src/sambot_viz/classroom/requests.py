"""Requests to the single port of a class, read without a server library.

Students' connections are relayed, byte by byte, to the servers of their seats. Those
servers check and parse them again.
"""

from __future__ import annotations

import asyncio
import http
from asyncio import StreamReader, StreamWriter
from collections.abc import Mapping
from contextlib import suppress
from types import MappingProxyType

from websockets.datastructures import Headers
from websockets.exceptions import InvalidHandshake, SecurityError
from websockets.http11 import Request, Response
from websockets.streams import StreamReader as Lines

from sambot_viz.errors import ServerError

HEAD_TIME = 10.0
"""A request must be complete after this time, or the connection ends [s]."""
_END = b"\r\n\r\n"
_BLOCK = 64 * 1024
NAME_HEADER = "X-Sambot-Name"
"""Names the user who opens a seat; only the program of the class can reach it."""
_PRIVATE = frozenset(
    {"authorization", "cookie", "connection", "upgrade", NAME_HEADER.lower()}
)
"""Headers that identify a user; all others are passed on unchanged."""


class BadRequestError(Exception):
    """A request that none of our pages makes."""


async def read_request(reader: StreamReader) -> Request:
    """Read the head of a request.

    Raises:
        BadRequestError: the request is malformed, too long, or late.
    """
    try:
        head = await asyncio.wait_for(reader.readuntil(_END), HEAD_TIME)
        lines = Lines()
        lines.feed_data(head)
        lines.feed_eof()
        next(Request.parse(lines.read_line))
    except StopIteration as end:
        request: Request = end.value
        return request
    except (
        asyncio.IncompleteReadError,
        asyncio.LimitOverrunError,
        asyncio.TimeoutError,
        EOFError,
        InvalidHandshake,
        NotImplementedError,
        OSError,
        SecurityError,
        ValueError,
    ) as error:
        raise BadRequestError from error
    raise BadRequestError


def on_behalf(request: Request, path: str, secret: str, name: str) -> bytes:
    """Return the head of a request as a seat receives it.

    Args:
        request: the original request.
        path: path below the address of the seat.
        secret: secret that opens the seat.
        name: name of the user, in letters of any script.
    """
    upgrade = request.headers.get("Upgrade", "")
    kept = (
        pair for pair in request.headers.raw_items() if pair[0].lower() not in _PRIVATE
    )
    lines = [f"{key}: {value}" for key, value in kept]
    lines += ["Connection: Upgrade", f"Upgrade: {upgrade}"] if upgrade else []
    lines += [f"Authorization: Bearer {secret}", f"{NAME_HEADER}: {name}"]
    head = "\r\n".join([f"GET {path} HTTP/1.1", *lines, "", ""])
    # Bytes that were not text in the request stay the same bytes.
    return head.encode(errors="surrogateescape")


async def pipe(
    reader: StreamReader, writer: StreamWriter, port: int, head: bytes
) -> None:
    """Connect a client with a server on this machine, until one of them ends.

    Raises:
        ServerError: the server has ended.
    """
    try:
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", port)
    except OSError as error:
        raise ServerError("it has just ended, and begins again") from error
    far_writer.write(head)
    ways = [
        asyncio.create_task(_copy(reader, far_writer)),
        asyncio.create_task(_copy(far_reader, writer)),
    ]
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for way in ways:
            way.cancel()
        await asyncio.gather(*ways, return_exceptions=True)
        far_writer.close()


async def _copy(reader: StreamReader, writer: StreamWriter) -> None:
    with suppress(OSError):
        while block := await reader.read(_BLOCK):
            writer.write(block)
            await writer.drain()


def answer(
    content: bytes,
    kind: str = "text/plain",
    status: http.HTTPStatus = http.HTTPStatus.OK,
    more: Mapping[str, str] = MappingProxyType({}),
) -> Response:
    """Return a response that browsers do not store.

    Args:
        content: content of the response.
        kind: its media type; texts are UTF-8.
        status: status of the response.
        more: further headers.
    """
    charset = "; charset=utf-8" if kind.startswith("text/") else ""
    headers = Headers({"Content-Type": f"{kind}{charset}"})
    headers["Content-Length"] = str(len(content))
    headers["Cache-Control"] = "no-store"
    headers["Referrer-Policy"] = "no-referrer"
    headers["X-Content-Type-Options"] = "nosniff"
    for name, value in more.items():
        headers[name] = value
    return Response(status, status.phrase, headers, content)
