"""Fixtures that every room's tests may use."""

from __future__ import annotations

import gc
import os
import secrets
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from hand_clock import HandClock
    from navigator_peer import NavigatorPeer
    from protocol_client import ProtocolClient

    from sambot_viz import Robot, Visualizer
    from sambot_viz.export.chromium import Chromium
    from sambot_viz.session import Session

ROOT = Path(__file__).resolve().parents[1]
NEEDS_SHARED = "needs the collection ../shared, which is not beside this checkout"
PAGES = ("tests/browser/", "tests/golden/", "tests/jupyter/")
"""What the names of tests begin with that open pages: they compute, and they wait."""
TOGETHER = ("tests/browser/tasks/", "tests/golden/", "tests/jupyter/")
"""Folders whose tests share servers and pages."""
EARLY = ("tests/browser/test_moving_target.py", "tests/browser/test_export.py")
"""Files of few tests that take long: no worker begins with one when others end."""
TASK_SEED = "SAMBOT_VIZ_TASK_SEED"
"""The environment variable with the order of the browser tasks."""


def pytest_configure() -> None:
    """Choose the order of the tasks, before workers start that all must have it."""
    os.environ.setdefault(TASK_SEED, str(secrets.randbelow(10**6)))


def pytest_collection_finish() -> None:
    """Leave tests and modules, which live to the end, out of garbage collections.

    These come seldom: at Python's own pace they take a tenth of the time of all tests.
    """
    gc.freeze()
    gc.set_threshold(30_000, 20, 20)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Start two workers for each core: a test of a page waits half of its time."""
    cores = len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count()
    return (cores or 1) * 2


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Let one worker of pytest-xdist run a file, or a folder that shares pages."""
    # Marks do not: xdist 3.8 adds them to an attribute that pytest 9.2 does not have.
    from xdist.scheduler import LoadScopeScheduling

    class ByPages(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            fitting = (start for start in TOGETHER if nodeid.startswith(start))
            return next(fitting, nodeid.partition("::")[0])

        def _assign_work_unit(self, node: Any) -> None:
            # One worker computes while others wait for their pages; all end with
            # what is left.
            pages = node is not self.nodes[0]
            fitting = [s for s in self.workqueue if s.startswith(PAGES) == pages]
            for first in sorted(fitting, key=lambda scope: scope not in EARLY)[:1]:
                self.workqueue.move_to_end(first, last=False)
            super()._assign_work_unit(node)

        def remove_node(self, node: Any) -> str | None:
            # xdist gives the test in which a worker ended to the next one, and so on.
            crashed = super().remove_node(node)
            if crashed is not None:
                self.workqueue[self._split_scope(crashed)][crashed] = True
            return crashed

    return ByPages(config, log)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Write how many tests need the collection, and how to have the same order again.

    With workers only this process writes, and it knows no conftest.py but this one.
    """
    reports = (one for some in terminalreporter.stats.values() for one in some)
    if any("browser/tasks" in getattr(report, "nodeid", "") for report in reports):
        seed = os.environ[TASK_SEED]
        terminalreporter.write_line(f"order of the tasks: {TASK_SEED}={seed}")
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


@pytest.fixture(scope="session")
def chromium() -> Iterator[Chromium]:
    """The browser, one for all tests of a worker; pages have storage of their own."""
    from a_chromium import a_chromium
    from patience import patience

    with a_chromium(timeout=patience(60.0)) as browser:
        yield browser


@pytest.fixture(scope="session")
def sam_bot() -> Robot:
    """The bundled robot, loaded once: a xacro file takes most of a server's start."""
    from sambot_viz import bundled, load_robot

    return load_robot(bundled.model_path())


@pytest.fixture
def hand_clock(monkeypatch: pytest.MonkeyPatch) -> HandClock:
    """The clock of the sessions that begin from now on; it is named before `viz`."""
    from hand_clock import HandClock

    from sambot_viz.session import worker

    clock = HandClock()
    monkeypatch.setattr(worker, "WallClock", lambda: clock)
    return clock


@pytest.fixture
def navigator() -> Iterator[Callable[..., NavigatorPeer]]:
    """Start robots that take goals: ``navigator(1, 2, 4)`` says these of each."""
    from navigator_peer import NavigatorPeer

    made: list[NavigatorPeer] = []

    def make(*statuses: int, **options: Any) -> NavigatorPeer:
        made.append(NavigatorPeer(statuses or (1, 2, 4), **options))
        return made[-1]

    yield make
    for one in made:
        one.stop()


@pytest.fixture
def make_viz(sam_bot: Robot) -> Iterator[Callable[..., Visualizer]]:
    """Show the loaded sam_bot: ``make_viz(presenter="word", config=path)``.

    What is saved is not followed. Each is stopped at the end of the test.
    """
    from sambot_viz import Visualizer

    made: list[Visualizer] = []

    def make(**options: Any) -> Visualizer:
        made.append(Visualizer(sam_bot, port=0, **options))
        return made[-1]

    yield make
    for viz in made:
        viz.stop()


@pytest.fixture
def viz(make_viz: Callable[..., Visualizer]) -> Visualizer:
    """A server that shows sam_bot with the bundled config."""
    return make_viz()


@pytest.fixture
def session(viz: Visualizer) -> Session:
    """What all its browsers share."""
    from inside import session_of

    return session_of(viz)


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
        port: int,
        host: str = "127.0.0.1",
        *,
        camera: bool = True,
        path: str = "",
        ticket: str = "",
    ):
        made = ProtocolClient(port, host, camera=camera, path=path, ticket=ticket)
        clients.append(made)
        return clients[-1]

    yield connect
    for client in clients:
        client.close()
