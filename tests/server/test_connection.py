"""Connections that flood the server with what is not a message."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import viser
from patience import patience
from websockets.exceptions import ConnectionClosed
from websockets.frames import Close, Frame, Opcode
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from sambot_viz.options import Options
from sambot_viz.server.connections.connection import SMALL_FRAMES_AT_ONCE
from sambot_viz.server.listener import listen
from sambot_viz.server.protection import inbound_filter


@pytest.fixture
def client(monkeypatch: pytest.MonkeyPatch) -> Iterator[ClientConnection]:
    monkeypatch.setattr(inbound_filter, "CLOSE_TIME", 0.1)
    protocol = Subprotocol(f"viser-v{viser.__version__}")
    with (
        listen(Options()) as listener,
        connect(
            f"ws://127.0.0.1:{listener.viser.get_port()}",
            subprotocols=[protocol],
            compression=None,
            max_size=None,
        ) as client,
    ):
        yield client


FLOODS = {
    "pings": Frame(Opcode.PING, b"x" * 125),
    "pongs": Frame(Opcode.PONG, b""),
    "parts": Frame(Opcode.CONT, b"", fin=False),
}


@pytest.mark.parametrize("name", FLOODS)
def test_a_flood_of_small_frames_ends_its_connection(
    client: ClientConnection, name: str
) -> None:
    first, part = Frame(Opcode.BINARY, b"", fin=False), FLOODS[name]
    frames = [first, *[part] * (2 * int(SMALL_FRAMES_AT_ONCE))]
    data = b"".join(frame.serialize(mask=True) for frame in frames)
    client.socket.sendall(data)
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            client.recv(timeout=patience(10.0))
    assert closed.value.rcvd == Close(1002, "too many small frames")


def test_who_does_not_stop_sending_is_disconnected(client: ClientConnection) -> None:
    with pytest.raises(OSError):
        for _ in range(100_000):
            client.socket.sendall(Frame(Opcode.PONG, b"").serialize(mask=True) * 1000)


def test_a_message_in_large_parts_and_a_few_pings_are_taken(
    client: ClientConnection,
) -> None:
    assert client.ping().wait(patience(10.0))
    client.send([b"x" * 2000] * 20)
    for _ in range(20):
        assert client.ping().wait(patience(10.0))
