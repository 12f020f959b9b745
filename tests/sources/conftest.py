"""Sources and their peers, closed when the test ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from dds_peer import DdsPeer
from live_peers import FoxglovePeer, Inbox, LivePeer
from parted_recording import PartedRecording
from rosbridge_peer import RosbridgePeer
from zenoh_peer import ZenohPeer

from sambot_viz.sources.registry import open_source
from sambot_viz.sources.source import Source

PEERS: dict[str, Callable[[], LivePeer]] = {
    "foxglove": FoxglovePeer,
    "rosbridge": RosbridgePeer,
    "zenoh": ZenohPeer,
    "dds": DdsPeer,
}


@pytest.fixture(params=PEERS)
def peer(request: pytest.FixtureRequest) -> Iterator[LivePeer]:
    """A robot with each of the transports."""
    peer = PEERS[request.param]()
    yield peer
    peer.stop()


@pytest.fixture
def opened() -> Iterator[Callable[[str], Source]]:
    """Opens sources, without waiting for a connection."""
    with ExitStack() as stack:

        def open_one(uri: str) -> Source:
            source = open_source(uri)
            stack.callback(source.close)
            source.open()
            return source

        yield open_one


@pytest.fixture
def parted() -> Iterator[Callable[..., PartedRecording]]:
    """Begins recordings in several files."""
    with ExitStack() as stack:

        def begin(folder: Path, start_ns: int = 10**18) -> PartedRecording:
            made = PartedRecording(folder, start_ns)
            stack.callback(made.kill)
            return made

        yield begin


@pytest.fixture
def inbox() -> Inbox:
    return Inbox()
