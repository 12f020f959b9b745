"""Clients that are quicker than the program: they come while it starts."""

from __future__ import annotations

import logging
import socket
import struct
import threading
from collections.abc import Callable, Generator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any, cast

import msgspec.msgpack
import pytest
import viser
from patience import patience
from protocol_client import CAMERA, ProtocolClient
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from sambot_viz import limits
from sambot_viz.options import Options
from sambot_viz.server import listener
from sambot_viz.server.connections.client_writer import ClientWriter
from sambot_viz.server.outgoing import outbox
from sambot_viz.server.protection import inbound_filter

Early = Callable[[viser.ViserServer], object]


@contextmanager
def started(
    early: Early, monkeypatch: pytest.MonkeyPatch
) -> Generator[listener.Listener]:
    """A server, with something that happens when it listens but is not ready."""
    prepare = outbox.prepare

    def prepare_late(server: viser.ViserServer) -> None:
        early(server)
        prepare(server)

    monkeypatch.setattr(outbox, "prepare", prepare_late)
    with listener.listen(Options()) as made:
        yield made


def early_client(server: viser.ViserServer) -> ClientConnection:
    """A client whose connection is open, and in whose handler the server is."""
    client = connect(
        f"ws://127.0.0.1:{server.get_port()}",
        subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
        compression=None,
        max_size=None,
    )
    assert client.ping().wait(patience(10.0))
    return client


def reset(client: ClientConnection) -> None:
    """End a connection without a word, as a program that crashes does."""
    client.socket.setsockopt(
        socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0)
    )
    client.socket.shutdown(socket.SHUT_RD)
    client.socket.close()


def test_a_client_that_comes_and_goes_while_the_program_starts_does_not_end_it(
    monkeypatch: pytest.MonkeyPatch, protocol: Callable[..., ProtocolClient]
) -> None:
    live: list[int] = []

    def early(server: viser.ViserServer) -> None:
        client = early_client(server)
        live.extend(cast(Any, server)._websock_server._live_connections)
        reset(client)

    with started(early, monkeypatch) as made:
        assert live == [], "viser had a connection without the filter"
        assert protocol(made.viser.get_port()).replayed


def test_a_connection_that_is_closed_already_can_be_prepared() -> None:
    line = socket.socket()
    family = line.family
    line.close()
    closed = SimpleNamespace(family=family, setsockopt=line.setsockopt)
    transport = SimpleNamespace()
    transport.get_extra_info = {"socket": closed}.get
    connection = SimpleNamespace(transport=transport)
    ClientWriter(cast(Any, connection)).prepare()


def test_the_filter_sees_all_that_a_client_sends_while_the_program_starts(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    monkeypatch.setattr(inbound_filter, "_next_report", 0.0)
    clients: list[ClientConnection] = []
    taken = threading.Event()

    def early(server: viser.ViserServer) -> None:
        clients.append(early_client(server))
        share = {"type": "ShareUrlRequest"}
        camera = {"type": "ViewerCameraMessage", **CAMERA}
        for message in (share, camera):
            clients[0].send(msgspec.msgpack.encode(message))
        assert clients[0].ping().wait(patience(10.0))

    with started(early, monkeypatch) as made:
        number = made.viser.gui.add_number("number", 1.0)
        number.on_update(lambda _: taken.set())
        (uuid,) = cast(Any, made.viser.gui)._gui_input_handle_from_uuid
        update = {"type": "GuiUpdateMessage", "uuid": uuid, "updates": {"value": 2.0}}
        clients[0].send(msgspec.msgpack.encode(update))
        assert taken.wait(patience(10.0)), "the camera was not seen"
        dropped = [record.getMessage() for record in caplog.records]
        assert [m for m in dropped if "not one of the messages" in m], dropped
        clients[0].close()


def test_a_message_that_is_too_long_is_refused_also_while_the_program_starts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    codes: list[int] = []

    def early(server: viser.ViserServer) -> None:
        client = early_client(server)
        client.send(b"x" * (limits.PAGE_MESSAGE.value + 1))
        with pytest.raises(ConnectionClosed) as closed:
            client.recv(timeout=patience(10.0))
        assert closed.value.rcvd is not None
        codes.append(closed.value.rcvd.code)

    with started(early, monkeypatch):
        assert codes == [1009]
