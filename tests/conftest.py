"""Fixtures that every room's tests may use."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from protocol_client import ProtocolClient

ROOT = Path(__file__).resolve().parents[1]
NEEDS_SHARED = "needs the collection ../shared, which is not beside this checkout"


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Write in one line how many tests were skipped without the collection."""
    skipped = terminalreporter.stats.get("skipped", [])
    count = sum(NEEDS_SHARED in str(report.longrepr) for report in skipped)
    if count:
        terminalreporter.write_line(f"{count} tests were skipped: each {NEEDS_SHARED}")


@pytest.fixture(scope="session")
def repository() -> Path:
    """The folder of this checkout."""
    return ROOT


@pytest.fixture(scope="session")
def shared() -> Path:
    """The project's collection of specs and recordings, beside the checkout."""
    folder = ROOT.parent / "shared"
    if not folder.is_dir():
        pytest.skip(NEEDS_SHARED)
    return folder


@pytest.fixture
def protocol() -> Iterator[Callable[..., ProtocolClient]]:
    """Connect recording clients to a viser server: ``protocol(port)``.

    What such a client can do is written in tests/support/protocol_client.py. The
    clients are closed at the end of the test.
    """
    # Tests of the pure rooms use this file too and must not pay for viser.
    from protocol_client import ProtocolClient

    clients: list[ProtocolClient] = []

    def connect(
        port: int, host: str = "127.0.0.1", *, camera: bool = True, path: str = ""
    ):
        clients.append(ProtocolClient(port, host, camera=camera, path=path))
        return clients[-1]

    yield connect
    for client in clients:
        client.close()
