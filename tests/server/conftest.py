"""A robot on the network."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from robot_peer import RobotPeer

from sambot_viz.sources.bag import open_recording


@pytest.fixture
def peer(repository: Path) -> Iterator[RobotPeer]:
    """Publishes what the recording of a driven square holds, when it is told to."""
    with open_recording(repository / "assets" / "square.mcap") as recording:
        peer = RobotPeer(recording)
        yield peer
        peer.stop()
