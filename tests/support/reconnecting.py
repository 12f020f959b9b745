"""Very light pages that come again by themselves, in processes of their own.

    with Visitors(port, "/robot", 300) as visitors:    # all are connected
        ...                                            # what they show ends and starts
        visitors.until_all_show(1.5)                   # a node is turned so far [rad]
        for one in visitors.look():
            one.bytes, one.gaps

They speak the two websockets of a page, come again as the page of a follower does, at
different moments, and look into frames only when asked to, because hundreds of them
share the machine with what is measured.
"""

from __future__ import annotations

import asyncio
import base64
import math
import multiprocessing
import os
import random
import secrets
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from types import TracebackType
from typing import Any, cast

import msgspec.msgpack
import viser
from crowd import Pose
from patience import patience
from protocol_client import CAMERA

from sambot_viz.server.channel import SUBPROTOCOL
from sambot_viz.viser_private.followed_scene import unpacked_frame, unpacked_poses
from sambot_viz.viser_private.moving_poses import FRAME

WAITS = (0.1, 1.0, 2.0, 5.0)
"""As in retries.js, where a page waits longer after some minutes [s]."""
SPREAD = 0.9
"""As in connection.js, for pages of followers [s]."""
_OPENING = 120.0
"""A browser gives up no connection that opens [s]."""
_BINARY, _END, _PING, _PONG = 2, 8, 9, 10
KINDS = (f"viser-v{viser.__version__}", SUBPROTOCOL)
"""The two connections of a page: its scene, and what is ours."""


@dataclass
class Seen:
    """What one page has seen since the last look.

    Attributes:
        bytes: sent to it.
        frames: sent to it.
        gaps: how long it was without a connection, each time [s].
        refused: how often a server was there and refused it.
        poses: of nodes that were turned; by `time.perf_counter`.
        is_here: whether it is connected now.
    """

    bytes: int = 0
    frames: int = 0
    gaps: list[float] = field(default_factory=list[float])
    refused: int = 0
    poses: list[Pose] = field(default_factory=list[Pose])
    is_here: bool = False


class _Socket(asyncio.Protocol):
    """One websocket; what comes is passed on, pings are answered."""

    def __init__(self, take: Callable[[bytes], None]) -> None:
        self._take, self._data, self._open = take, bytearray(), False
        self._parts: list[bytes] = []
        self.closed, self.first = asyncio.Event(), asyncio.Event()
        self.was_refused = False
        self.transport: asyncio.Transport | None = None

    def ask(self, path: str, port: int, subprotocol: str) -> None:
        """Ask for the websocket."""
        assert self.transport is not None
        key = base64.b64encode(os.urandom(16)).decode()
        request = (
            f"GET {path} HTTP/1.1\r\nHost: localhost:{port}\r\n"
            "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Key: {key}\r\n"
            f"Sec-WebSocket-Protocol: {subprotocol}\r\n\r\n"
        )
        self.transport.write(request.encode())

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast(asyncio.Transport, transport)

    def connection_lost(self, exc: Exception | None) -> None:
        self.closed.set()
        self.first.set()

    def data_received(self, data: bytes) -> None:
        self._data += data
        if not self._open and not self._opened():
            return
        at, size = 0, len(self._data)
        while at + 2 <= size:
            length, head = self._data[at + 1] & 127, 2
            if length > 125:
                head = 4 if length == 126 else 10
                if at + head > size:
                    break
                length = int.from_bytes(self._data[at + 2 : at + head], "big")
            if at + head + length > size:
                break
            first = self._data[at]
            self._frame(first, bytes(self._data[at + head : at + head + length]))
            at += head + length
        del self._data[:at]

    def _opened(self) -> bool:
        head, end, rest = bytes(self._data).partition(b"\r\n\r\n")
        if end and head.split(b" ", 2)[1] == b"101":
            self._data, self._open = bytearray(rest), True
        elif end:
            self.was_refused = True
            self.close()
        return self._open

    def _frame(self, first: int, content: bytes) -> None:
        kind = first & 15
        if kind == _PING:
            self.send(_PONG, content)
        elif kind == _END:
            self.close()
        else:
            self._parts.append(content)
            if first & 128:
                whole, self._parts = b"".join(self._parts), []
                self.first.set()
                self._take(whole)

    def send(self, kind: int, content: bytes) -> None:
        """Send a frame, with a mask of zeros."""
        size = len(content)
        assert size < 65536 and self.transport is not None
        length = (
            bytes([128 | size]) if size < 126 else b"\xfe" + size.to_bytes(2, "big")
        )
        self.transport.write(bytes([128 | kind]) + length + bytes(4) + content)

    def close(self) -> None:
        if self.transport is not None:
            self.transport.abort()


class _Page:
    """One page that comes again for ever."""

    def __init__(self, port: int, path: str) -> None:
        self._port, self._path = port, path
        self.seen, self.looks, self.angle = Seen(), False, math.nan
        self.here = asyncio.Event()

    async def run(self) -> None:
        tries, lost = 0, 0.0
        while True:
            sockets = await self._open()
            if sockets is not None:
                if lost:
                    self.seen.gaps.append(time.monotonic() - lost)
                self.seen.is_here = True
                self.here.set()
                ends = [asyncio.ensure_future(one.closed.wait()) for one in sockets]
                await asyncio.wait(ends, return_when=asyncio.FIRST_COMPLETED)
                for one in sockets:
                    one.close()
                tries, lost = 0, time.monotonic()
                self.seen.is_here = False
                self.here.clear()
            wait = WAITS[min(tries, len(WAITS) - 1)] + SPREAD * random.random()
            tries += 1
            await asyncio.sleep(wait)

    async def _open(self) -> list[_Socket] | None:
        """Open both websockets, and wait until each has brought something."""
        made: list[_Socket] = []
        try:
            await asyncio.wait_for(self._connect(made), _OPENING)
        except (OSError, asyncio.TimeoutError):
            # Nothing listens there, or it took too long.
            pass
        if len(made) == len(KINDS) and not any(one.closed.is_set() for one in made):
            return made
        self.seen.refused += any(one.was_refused for one in made)
        for one in made:
            one.close()
        return None

    async def _connect(self, made: list[_Socket]) -> None:
        loop, ticket = asyncio.get_running_loop(), secrets.token_urlsafe(16)
        for subprotocol in KINDS:
            is_scene = subprotocol != SUBPROTOCOL
            one = _Socket(self._take if is_scene else self._count)
            await loop.create_connection(lambda one=one: one, "127.0.0.1", self._port)
            made.append(one)
            one.ask(f"{self._path}?ticket={ticket}", self._port, subprotocol)
            await one.first.wait()
            if is_scene and not one.closed.is_set():
                # The page has its place before its rows come.
                camera = {"type": "ViewerCameraMessage", **CAMERA}
                one.send(_BINARY, msgspec.msgpack.encode(camera))

    def _count(self, content: bytes) -> None:
        self.seen.bytes += len(content)
        self.seen.frames += 1

    def _take(self, content: bytes) -> None:
        self._count(content)
        if self.looks:
            now = time.perf_counter()
            for angle in _angles(content):
                self.angle = angle
                self.seen.poses.append((now, angle))


def _angles(frame: bytes) -> list[float]:
    """How far the nodes of a frame are turned, each that is turned at all [rad]."""
    turned: list[Sequence[float]] = []
    for message in unpacked_frame(frame):
        if message.get("name") == FRAME:
            turned += [value for _, value in unpacked_poses(message["position"])]
        elif message["type"] == "SetOrientationMessage":
            turned.append(message["wxyz"])
    found = (2.0 * math.acos(max(-1.0, min(1.0, q[0]))) for q in turned if len(q) == 4)
    return [angle for angle in found if angle > 1e-6]


class Visitors:
    """Pages that are open, and come again, as long as the block lasts.

    Args:
        port: of a server, or of a balancer.
        path: of the page.
        count: how many.
        processes: so many processes share them.
        looks: they look into what comes, from the beginning.
        timeout: how long all may take for anything [s].
    """

    def __init__(
        self,
        port: int,
        path: str,
        count: int,
        processes: int = 1,
        looks: bool = False,
        timeout: float = 120.0,
    ) -> None:
        context = multiprocessing.get_context("spawn")
        self._timeout = patience(timeout)
        self._pipes: list[Connection] = []
        self._processes: list[Any] = []
        for number in range(processes):
            ours, theirs = context.Pipe()
            share = count // processes + (number < count % processes)
            process = context.Process(
                target=_visit,
                args=(theirs, port, path, share, looks, self._timeout),
                daemon=True,
            )
            process.start()
            self._pipes.append(ours)
            self._processes.append(process)

    def __enter__(self) -> Visitors:
        self.until_all_here()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for process in self._processes:
            process.terminate()
            process.join(self._timeout)

    def until_all_here(self) -> list[Seen]:
        """Wait until all are connected."""
        return self._ask("here")

    def until_all_show(self, angle: float) -> list[Seen]:
        """Wait until the last node that each has seen turned is turned so far [rad]."""
        return self._ask("show", angle)

    def look(self) -> list[Seen]:
        """What each has seen since the last look."""
        return self._ask("look")

    def look_into_frames(self) -> list[Seen]:
        """Look into what comes from now on."""
        return self._ask("decode")

    def _ask(self, *words: object) -> list[Seen]:
        for pipe in self._pipes:
            pipe.send(words)
        found: list[Seen] = []
        for pipe in self._pipes:
            assert pipe.poll(self._timeout + 10.0), f"no answer to {words}"
            answer = pipe.recv()
            assert isinstance(answer, list), answer
            found += cast("list[Seen]", answer)
        return found


def _visit(pipe: Connection, *options: Any) -> None:
    asyncio.run(_serve(pipe, *options))


async def _serve(
    pipe: Connection, port: int, path: str, count: int, looks: bool, timeout: float
) -> None:
    loop = asyncio.get_running_loop()
    pages = [_Page(port, path) for _ in range(count)]
    for page in pages:
        page.looks = looks
    tasks = [loop.create_task(page.run()) for page in pages]
    while True:
        word, *details = await loop.run_in_executor(None, pipe.recv)
        try:
            await asyncio.wait_for(_obey(pages, word, *details), timeout)
            assert not any(task.done() for task in tasks), "a page has ended"
        except (asyncio.TimeoutError, AssertionError) as error:
            away = sum(not page.seen.is_here for page in pages)
            angles = {round(page.angle, 3) for page in pages}
            pipe.send(f"{error!r}: {away} of {count} are away; angles {angles}")
            continue
        pipe.send([page.seen for page in pages])
        for page in pages:
            page.seen = Seen(is_here=page.seen.is_here)


async def _obey(pages: Sequence[_Page], word: str, angle: float = 0.0) -> None:
    if word == "here":
        for page in pages:
            await page.here.wait()
    elif word == "show":
        while not all(abs(page.angle - angle) < 1e-3 for page in pages):
            await asyncio.sleep(0.05)
    elif word == "decode":
        for page in pages:
            page.looks = True
