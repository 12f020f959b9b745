"""A process that forks for each order: what a fork has, and how it ends."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from patience import patience, until

from sambot_viz.robot.child_process import ChildTimeoutError
from sambot_viz.robot.fork_server import CAN_FORK, ForkServer
from sambot_viz.robot.xacro.child import forks

pytestmark = pytest.mark.skipif(not CAN_FORK, reason="this system has no fork")
SCRIPT = f"""
import os, signal, sys, time
sys.path.insert(0, {str(Path(forks.__file__).parent)!r})
import forks

forks.serve(float(sys.argv[1]))
order = sys.stdin.buffer.read(int(sys.stdin.buffer.read(16))).decode()
if order == "wait":
    time.sleep(1000)
elif order == "end":
    os._exit(7)
elif order == "kill the server":
    os.kill(os.getppid(), signal.SIGKILL)
elif order == "what is open":
    order = " ".join(os.listdir("/proc/self/fd"))
print(order, end="", flush=True)
os._exit(0)
"""


@pytest.fixture
def script(tmp_path: Path) -> Path:
    file = tmp_path / "script.py"
    file.write_text(SCRIPT)
    return file


@pytest.fixture
def server(script: Path) -> Iterator[ForkServer]:
    server = ForkServer(script, ["1000"])
    yield server
    server.end()


def test_each_order_has_an_answer_and_a_status_of_its_own(server: ForkServer) -> None:
    orders = ["a", "end", "b" * 10**6, "c"]
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda o: server.ask(o.encode(), patience(30)), orders))
    assert found == [(b"a", 0), (b"", 7), (b"b" * 10**6, 0), (b"c", 0)]


def test_an_order_that_takes_too_long_disturbs_no_other(server: ForkServer) -> None:
    with ThreadPoolExecutor(2) as pool:
        waiting = pool.submit(server.ask, b"wait", 2.0)
        assert server.ask(b"x", patience(30)) == (b"x", 0)
        with pytest.raises(ChildTimeoutError, match="longer than 2 s"):
            waiting.result()
    assert server.ask(b"y", patience(30)) == (b"y", 0)


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_a_fork_has_nothing_open_of_what_runs_beside_it(server: ForkServer) -> None:
    server.ask(b"x", patience(30))
    before = set(os.listdir("/proc/self/fd"))
    with ThreadPoolExecutor(2) as pool:
        waiting = [pool.submit(server.ask, b"wait", 1.0) for _ in range(2)]
        until(lambda: len(os.listdir("/proc/self/fd")) > len(before))
        answer, _ = server.ask(b"what is open", patience(30))
        assert all(isinstance(one.exception(), ChildTimeoutError) for one in waiting)
    # The three streams, and the list itself.
    assert answer.split() == [b"0", b"1", b"2", b"3"]
    assert set(os.listdir("/proc/self/fd")) == before


def test_a_server_with_nothing_to_do_ends_and_is_started_again(script: Path) -> None:
    server = ForkServer(script, ["0"])
    for _ in range(5):
        # The next order comes while it ends, or later.
        assert server.ask(b"x", patience(30)) == (b"x", 0)
    server.end()


def test_a_server_that_is_killed_is_started_again(server: ForkServer) -> None:
    assert server.ask(b"kill the server", patience(30)) == (b"kill the server", None)
    assert server.ask(b"x", patience(30)) == (b"x", 0)
