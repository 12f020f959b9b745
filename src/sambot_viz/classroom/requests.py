"""Requests to the one port of a class, read without a library's server.

The connections of students go on, byte by byte, to the servers of their seats: those
check them again, and take them apart.
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
"""A request is there after so long, or the connection ends [s]."""
_END = b"\r\n\r\n"
_BLOCK = 64 * 1024
NAME_HEADER = "X-Sambot-Name"
"""Tells a seat who opens a page; only the program of the class reaches it."""
_PRIVATE = frozenset(
    {"authorization", "cookie", "connection", "upgrade", NAME_HEADER.lower()}
)
"""Headers that say who somebody is; the rest goes on as it came."""


class BadRequestError(Exception):
    """What has come is no request that a page of ours makes."""


async def read_request(reader: StreamReader) -> Request:
    """Read the head of a request.

    Raises:
        BadRequestError: it is none, too long, or does not come in time.
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
    """Return the head of a request as it goes on to a seat.

    Args:
        request: as it came.
        path: below the address of the seat.
        secret: lets it in there.
        name: who it is, in letters of any script.
    """
    upgrade = request.headers.get("Upgrade", "")
    kept = (
        pair for pair in request.headers.raw_items() if pair[0].lower() not in _PRIVATE
    )
    lines = [f"{key}: {value}" for key, value in kept]
    lines += ["Connection: Upgrade", f"Upgrade: {upgrade}"] if upgrade else []
    lines += [f"Authorization: Bearer {secret}", f"{NAME_HEADER}: {name}"]
    head = "\r\n".join([f"GET {path} HTTP/1.1", *lines, "", ""])
    # What was no text in the request is the same bytes again.
    return head.encode(errors="surrogateescape")


async def pipe(
    reader: StreamReader, writer: StreamWriter, port: int, head: bytes
) -> None:
    """Join a connection with a server of this machine, until one of them ends.

    Raises:
        ServerError: that server has ended.
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
    """Return a response that no browser keeps.

    Args:
        content: of the answer.
        kind: its type; texts are UTF-8.
        status: of the answer.
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
