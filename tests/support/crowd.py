"""Many light browsers in processes of their own, which note when a joint has moved.

    with Crowd(port, 30) as crowd:             # all are connected and have the scene
        crowd.joined                           # how long each took until then [s]
        ...                                    # a user moves a joint
        for light in crowd.look(0.5):          # all have seen it there
            light.poses, light.bytes

They decode only what they must, so that they do not measure themselves. They note times
of `time.perf_counter`, which on Linux is the same clock in all processes.
"""

from __future__ import annotations

import asyncio
import math
import multiprocessing
import os
import secrets
import signal
import time
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from types import TracebackType
from typing import Any, cast

import msgspec.msgpack
import viser
import zstandard
from pose_tracks import PoseTracks
from protocol_client import CAMERA
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

from sambot_viz.server.channel import SUBPROTOCOL

LONGEST = 60.0
"""How long a crowd may take for anything [s]."""


class _Head(msgspec.Struct):
    """What is read of every message."""

    type: str
    name: str = ""
    wxyz: Any = None
    position: Any = None
    number: int | None = None


class _Frame(msgspec.Struct):
    messages: list[_Head]


_POSES = ("SetOrientationMessage", "SetPositionMessage")
_DECODER = msgspec.msgpack.Decoder(_Frame)


Pose = tuple[float, float]
"""When a node was turned to which angle [s, rad]."""


@dataclass
class Light:
    """What one light browser has seen.

    Attributes:
        joined: how long it took until it had the whole scene [s].
        bytes: how much it was sent since it was last asked.
        poses: of nodes that were turned, since it was last asked.
        frames: how many batches of messages it was sent, since it was last asked.
        nodes: how many scene nodes it was sent.
        closed: whether its connection has ended.
    """

    joined: float = math.nan
    bytes: int = 0
    poses: list[Pose] = field(default_factory=list[Pose])
    frames: int = 0
    nodes: int = 0
    closed: bool = False


class Crowd:
    """Light browsers that join at the same time, when the block begins.

    Args:
        port: of the server.
        count: how many.
        processes: so many processes share them.
        meshes: one has joined when it was sent so many meshes.
        says: what each says on the page's own channel.
        reads: they look into what comes after they have joined.
    """

    def __init__(
        self,
        port: int,
        count: int,
        processes: int = 2,
        meshes: int = 0,
        says: Sequence[str] = (),
        reads: bool = True,
    ) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipes: list[Connection] = []
        self._processes: list[Any] = []
        for number in range(processes):
            ours, theirs = context.Pipe()
            share = count // processes + (number < count % processes)
            process = context.Process(
                target=_crowd,
                args=(theirs, port, share, meshes, tuple(says), reads),
                daemon=True,
            )
            process.start()
            self._pipes.append(ours)
            self._processes.append(process)
        self.joined: list[float] = []
        self._ask("ready")

    def __enter__(self) -> Crowd:
        with self.joining():
            return self

    @contextmanager
    def joining(self) -> Generator[None]:
        """Join while a block runs."""
        self._tell("join")
        yield
        self.joined = [light.joined for light in self._answers()]

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def sleep(self) -> None:
        """Do nothing from now on, like a laptop that is closed."""
        for process in self._processes:
            os.kill(process.pid, signal.SIGSTOP)

    def wake(self) -> None:
        """Go on, and find out which connections are left."""
        for process in self._processes:
            os.kill(process.pid, signal.SIGCONT)

    def close(self) -> None:
        """End all connections."""
        for process in self._processes:
            process.terminate()
            process.join(LONGEST)

    def look(self, angle: float = -math.inf) -> list[Light]:
        """What each has seen since the last look.

        Args:
            angle: wait until every browser that is connected has seen a node at it,
                or beyond [rad].
        """
        return self._ask("look", angle)

    def _ask(self, *words: object) -> list[Light]:
        self._tell(*words)
        return self._answers(words)

    def _tell(self, *words: object) -> None:
        for pipe in self._pipes:
            pipe.send(words)

    def _answers(self, words: object = "join") -> list[Light]:
        found: list[Light] = []
        for pipe in self._pipes:
            assert pipe.poll(LONGEST), f"no answer to {words}"
            answer = pipe.recv()
            assert isinstance(answer, list), answer
            found += cast(list[Light], answer)
        return found


def _crowd(pipe: Connection, port: int, count: int, *options: Any) -> None:
    asyncio.run(_serve(pipe, port, count, *options))


async def _serve(pipe: Connection, port: int, count: int, *options: Any) -> None:
    loop = asyncio.get_running_loop()
    lights = [Light() for _ in range(count)]
    tasks: list[asyncio.Task[None]] = []
    while True:
        word, *details = await loop.run_in_executor(None, pipe.recv)
        try:
            if word == "join":
                joins = [asyncio.Event() for _ in lights]
                tasks += [
                    asyncio.create_task(_browse(port, light, joined, *options))
                    for light, joined in zip(lights, joins, strict=True)
                ]
                waiting = asyncio.gather(*(joined.wait() for joined in joins))
                await asyncio.wait_for(waiting, LONGEST)
                assert not any(task.done() for task in tasks), "a connection ended"
            elif word == "look":
                await asyncio.wait_for(_until_seen(lights, *details), LONGEST)
        except Exception as error:
            pipe.send(repr(error))
        else:
            pipe.send(lights)
        for light in lights:
            light.poses, light.bytes, light.frames = [], 0, 0


async def _until_seen(lights: Sequence[Light], angle: float) -> None:
    def has(light: Light) -> bool:
        return light.closed or any(seen >= angle for _, seen in light.poses)

    while angle > -math.inf and not all(map(has, lights)):
        await asyncio.sleep(0.02)


async def _browse(
    port: int,
    light: Light,
    joined: asyncio.Event,
    meshes: int,
    says: Sequence[str],
    reads: bool,
) -> None:
    start = time.perf_counter()
    ticket = secrets.token_urlsafe(16)

    def open_socket(subprotocol: str) -> connect:
        return connect(
            f"ws://127.0.0.1:{port}/?ticket={ticket}",
            subprotocols=[Subprotocol(subprotocol)],
            max_size=None,
            compression=None,
            ping_interval=None,
        )

    try:
        async with (
            open_socket(f"viser-v{viser.__version__}") as socket,
            open_socket(SUBPROTOCOL) as channel,
        ):
            rows = asyncio.create_task(_count(channel, light, says))
            camera = {"type": "ViewerCameraMessage", **CAMERA}
            await socket.send(msgspec.msgpack.encode(camera))
            await _read(socket, light, joined, meshes, start, reads)
            await rows
    finally:
        light.closed = True
        joined.set()


async def _count(channel: ClientConnection, light: Light, says: Sequence[str]) -> None:
    """Count what the channel brings; say what is to be said once the page is there."""
    async for data in channel:
        for words in says:
            await channel.send(words)
        says = ()
        light.bytes += len(data)
        # Pictures are the only binary frames.
        light.frames += isinstance(data, bytes)


async def _read(
    socket: ClientConnection,
    light: Light,
    joined: asyncio.Event,
    meshes: int,
    start: float,
    reads: bool,
) -> None:
    unpacker = zstandard.ZstdDecompressor()
    replayed, had, tracks = False, 0, PoseTracks()
    async for data in socket:
        assert isinstance(data, bytes)
        now = time.perf_counter()
        light.bytes += len(data)
        light.frames += 1
        if joined.is_set() and not reads:
            continue
        size, packed = (int.from_bytes(data[i : i + 8], "little") for i in (0, 8))
        content = unpacker.decompress(data[16 : 16 + packed], max_output_size=size)
        for message in _DECODER.decode(content).messages:
            if message.type in _POSES:
                fields = {k: getattr(message, k) for k in _Head.__struct_fields__}
                for one in tracks.unpacked(message.type, fields):
                    if one.get("wxyz"):
                        angle = 2.0 * math.acos(max(-1.0, min(1.0, one["wxyz"][0])))
                        light.poses.append((now, angle))
            had += message.type in ("GlbMessage", "MeshMessage")
            replayed = replayed or message.type == "ReplayDoneMessage"
        if replayed and had >= meshes and not joined.is_set():
            light.joined, light.nodes = time.perf_counter() - start, had
            joined.set()
