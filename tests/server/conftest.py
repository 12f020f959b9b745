"""A robot on the network."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from robot_peer import RobotPeer, square_peer


@pytest.fixture
def peer(repository: Path) -> Iterator[RobotPeer]:
    """Publishes what the recording of a driven square holds, when it is told to."""
    with square_peer(repository, RobotPeer) as peer:
        yield peer
