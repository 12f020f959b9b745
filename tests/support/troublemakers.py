"""Browsers that misbehave, in a process of their own.

    with troublemakers(port): ...

One reads nothing, one sends a thousand messages of garbage in a second, and one comes
and goes every second.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import random
from collections.abc import Generator
from contextlib import contextmanager, suppress

import msgspec.msgpack
import viser
from protocol_client import CAMERA, decode_frame
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

FIRST = msgspec.msgpack.encode({"type": "ViewerCameraMessage", **CAMERA})
GARBAGE_PER_SECOND = 1000.0


@contextmanager
def troublemakers(port: int) -> Generator[None]:
    """Have all of them at a server for a while."""
    process = multiprocessing.get_context("spawn").Process(
        target=_run, args=(port,), daemon=True
    )
    process.start()
    try:
        yield
        assert process.is_alive(), "the troublemakers have ended"
    finally:
        process.terminate()
        process.join(10.0)


def garbage_edit(chance: random.Random) -> object:
    """What the page never sends through its channel, or only nearly."""
    value = chance.choice([None, -1, 2**63, float("nan"), "x" * 2000, [], {"a": [1]}])
    row = chance.choice(["j/drivewhl_l_joint", "joints/reset/x", "d/0/Alpha", ""])
    return chance.choice([row, [row], [row, value], [row, value, value], value])


def garbage(chance: random.Random) -> bytes:
    """A message that is wrong in some way, or only nearly right."""
    value = chance.choice([None, -1, 2**63, float("nan"), "x" * 2000, [], {"a": [1]}])
    names = ["ViewerCameraMessage", "GuiUpdateMessage", "ScenePointerMessage"]
    names += ["GetRenderResponseMessage", "FileTransferPart", "Shutdown", ""]
    row = chance.choice(["j/drivewhl_l_joint", "joints/reset/x", "d/0/Alpha", ""])
    message: object = chance.choice(
        [
            {"type": chance.choice(names), "uuid": row, "updates": value},
            {"type": "ViewerCameraMessage", **CAMERA, "fov": value},
            {
                "type": "GuiUpdateMessage",
                "uuid": "sambot-viz",
                "updates": {"value": garbage_edit(chance)},
            },
            value,
        ]
    )
    whole = msgspec.msgpack.encode(message)
    return chance.choice(
        [whole, whole[: chance.randrange(len(whole))], chance.randbytes(50)]
    )


def _run(port: int) -> None:
    async def all_of_them() -> None:
        await asyncio.gather(_read_nothing(port), _rave(port), _come_and_go(port))

    asyncio.run(all_of_them())


def _connect(port: int, most: int | None = 16) -> connect:
    return connect(
        f"ws://127.0.0.1:{port}",
        subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
        max_size=None,
        max_queue=most,
        compression=None,
        ping_interval=None,
        close_timeout=0.1,
    )


async def silent_browser(port: int) -> ClientConnection:
    """A browser that reads nothing."""
    socket = await _connect(port, most=1)
    await socket.send(FIRST)
    return socket


async def load_once(port: int) -> tuple[float, int]:
    """Load a page's scene; returns how long it took [s], and its length [bytes]."""
    loop = asyncio.get_running_loop()
    start, size = loop.time(), 0
    async with _connect(port) as socket:
        await socket.send(FIRST)
        async for data in socket:
            size += len(data)
            heads = decode_frame(data) if isinstance(data, bytes) else []
            if any(message.type == "ReplayDoneMessage" for message in heads):
                break
    return loop.time() - start, size


async def _read_nothing(port: int) -> None:
    socket = await silent_browser(port)
    await socket.wait_closed()


async def _rave(port: int) -> None:
    chance = random.Random(0)
    while True:
        # websockets aborts a transport that has lost its loop with an AttributeError.
        with suppress(ConnectionClosed, AttributeError):
            async with _connect(port) as socket:
                await socket.send(FIRST)
                reading = asyncio.create_task(_read(socket))
                try:
                    while not reading.done():
                        for _ in range(10):
                            await socket.send(garbage(chance))
                        await asyncio.sleep(10 / GARBAGE_PER_SECOND)
                finally:
                    reading.cancel()


async def _come_and_go(port: int) -> None:
    while True:
        async with _connect(port) as socket:
            await socket.send(FIRST)
            with suppress(ConnectionClosed, asyncio.TimeoutError):
                await asyncio.wait_for(_read(socket), 1.0)


async def _read(socket: ClientConnection) -> None:
    with suppress(ConnectionClosed):
        async for _ in socket:
            pass
