"""Reading many small messages together, and large ones without a pause."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import pytest
from patience import patience
from websockets.asyncio.client import connect
from websockets.asyncio.server import ServerConnection, serve

from sambot_viz.sources.websocket import paced_connection
from sambot_viz.sources.websocket.paced_connection import PacedConnection

Talk = Callable[[ServerConnection], Awaitable[None]]


class Counted(PacedConnection):
    """Counts how often it reads, and how often it pauses after that."""

    reads = pauses = 0

    def data_received(self, data: bytes) -> None:
        self.reads += 1
        super().data_received(data)
        self.pauses += not self.transport.is_reading()


def read(talk: Talk, count: int) -> tuple[list[bytes], Counted]:
    """Return messages of a peer, and the connection."""

    async def run() -> tuple[list[bytes], Counted]:
        async with (
            serve(talk, "127.0.0.1", 0, compression=None) as server,
            connect(
                f"ws://127.0.0.1:{server.sockets[0].getsockname()[1]}",
                create_connection=Counted,
                compression=None,
                max_size=None,
            ) as client,
        ):
            assert isinstance(client, Counted)
            found = [await client.recv(decode=False) for _ in range(count)]
            return found, client

    return asyncio.run(asyncio.wait_for(run(), patience(30.0)))


def test_small_messages_are_read_together(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(paced_connection, "PACE", 0.1)

    async def talk(peer: ServerConnection) -> None:
        for number in range(400):
            await peer.send(number.to_bytes(2, "little"))
            # Both ends are in one loop: who reads may read each by itself.
            await asyncio.sleep(0)

    found, client = read(talk, 400)
    assert [int.from_bytes(one, "little") for one in found] == list(range(400))
    assert client.reads < 40


def test_a_large_message_is_read_without_a_pause() -> None:
    async def talk(peer: ServerConnection) -> None:
        await peer.send(bytes(20_000_000))

    (found,), client = read(talk, 1)
    assert len(found) == 20_000_000
    assert client.pauses < client.reads / 4


def test_a_peer_that_leaves_during_a_pause_harms_nobody() -> None:
    async def talk(peer: ServerConnection) -> None:
        await peer.send(b"last")

    found, _ = read(talk, 1)
    assert found == [b"last"]
