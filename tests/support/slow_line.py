"""A line that takes only so many bytes in a second, as that of a phone.

async with slow_line(port, 830_000) as port_of_the_line: ...
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager, suppress

_STEP = 16 * 1024


@asynccontextmanager
async def slow_line(port: int, bytes_per_second: float) -> AsyncGenerator[int]:
    """Lead connections to a server over a line that is slow on the way from it.

    Args:
        port: of the server.
        bytes_per_second: what it takes.
    """

    writers: list[asyncio.StreamWriter] = []

    async def pump(
        reader: asyncio.StreamReader, writer: asyncio.StreamWriter, rate: float
    ) -> None:
        loop = asyncio.get_running_loop()
        start, passed = loop.time(), 0
        with suppress(OSError):
            while data := await reader.read(_STEP):
                writer.write(data)
                await writer.drain()
                passed += len(data)
                await asyncio.sleep(max(0.0, start + passed / rate - loop.time()))
        writer.transport.abort()

    async def lead(near: asyncio.StreamReader, back: asyncio.StreamWriter) -> None:
        line = socket.socket()
        # The system would take megabytes before the line has any.
        line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 * _STEP)
        line.setblocking(False)
        await asyncio.get_running_loop().sock_connect(line, ("127.0.0.1", port))
        far, out = await asyncio.open_connection(sock=line, limit=4 * _STEP)
        writers.extend((back, out))
        await asyncio.gather(
            pump(near, out, float("inf")), pump(far, back, bytes_per_second)
        )

    server = await asyncio.start_server(lead, "127.0.0.1", 0)
    try:
        yield int(server.sockets[0].getsockname()[1])
    finally:
        server.close()
        for writer in writers:
            writer.transport.abort()
        # Both ends see it, and the pumps end.
        await asyncio.sleep(0.1)
