"""Raw websocket clients in a process of their own; they note when frames arrive.

They read no message, so what they measure is the server, and not themselves::

    with watching(urls, 30) as watchers:
        watchers.seen()        # [[(when, bytes), …] of each client] since the last time
"""

from __future__ import annotations

import asyncio
import json
import secrets
import sys
import time
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from subprocess import PIPE, Popen

from websockets.asyncio.client import connect
from websockets.typing import Subprotocol

Frame = tuple[float, int]
"""When it came (`time.perf_counter`) [s], and how large it was [bytes]."""
QUIET = 1.0
"""All have what there is when nothing has come for so long [s]."""
LONGEST = 60.0


class Watchers:
    """Clients that are connected, and have been sent the scene."""

    def __init__(self, process: Popen[str]) -> None:
        self._process = process
        self.seen()

    def seen(self) -> list[list[Frame]]:
        """What each was sent since the last time, once nothing more comes."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write("seen\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        assert line, "the clients have ended"
        return [[(at, size) for at, size in one] for one in json.loads(line)]


@contextmanager
def watching(
    address: str, protocols: Sequence[str | None], count: int
) -> Generator[Watchers]:
    """Connect clients to a server until the block ends.

    Args:
        address: of the websocket.
        protocols: a client opens one connection for each; the frames of the first are
            those that `Watchers.seen` gives a time, those of others are only counted.
        count: how many clients.
    """
    words = [sys.executable, __file__, address, str(count), json.dumps(protocols)]
    process = Popen(words, stdin=PIPE, stdout=PIPE, text=True)
    try:
        yield Watchers(process)
    finally:
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                stream.close()
        process.terminate()
        process.wait(10.0)


async def _watch(address: str, count: int, protocols: list[str | None]) -> None:
    frames: list[list[Frame]] = [[] for _ in range(count)]
    last = [time.perf_counter()]

    async def read(client: int, protocol: str | None, ticket: str) -> None:
        wanted = None if protocol is None else [Subprotocol(protocol)]
        mark = "&" if "?" in address else "?"
        place = address if protocol is None else f"{address}{mark}ticket={ticket}"
        async with connect(
            place,
            subprotocols=wanted,
            max_size=None,
            compression=None,
            ping_interval=None,
        ) as socket:
            async for data in socket:
                now = time.perf_counter()
                # Bytes of a second connection have no time of their own.
                frames[client].append(
                    (now if protocol == protocols[0] else 0.0, len(data))
                )
                last[0] = now

    tasks = [
        asyncio.create_task(read(client, protocol, ticket))
        for client in range(count)
        for ticket in [secrets.token_urlsafe(16)]
        for protocol in protocols
    ]
    loop = asyncio.get_running_loop()
    while await loop.run_in_executor(None, sys.stdin.readline):
        end = time.perf_counter() + LONGEST
        while time.perf_counter() < min(end, max(last[0], 0.0) + QUIET):
            await asyncio.sleep(0.05)
        assert not any(task.done() for task in tasks), "a connection has ended"
        print(json.dumps(frames), flush=True)
        for one in frames:
            one.clear()
    for task in tasks:
        task.cancel()


if __name__ == "__main__":
    asyncio.run(_watch(sys.argv[1], int(sys.argv[2]), json.loads(sys.argv[3])))
