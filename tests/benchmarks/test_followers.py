"""Followers cost what a server costs, and the origin does not see how many look.

CPU time of the processes is compared, while a joint is moved thirty times a second.
"""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from crowd import Crowd
from program import running
from protocol_client import ProtocolClient
from zenoh_peer import ZenohPeer

JOINT = "j/drivewhl_l_joint"
VIEWERS, RATE, STEPS = 30, 30.0, 120
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")


class Program:
    """A server in a process of its own."""

    def __init__(self, stack: ExitStack, *words: str) -> None:
        words = (*words, "--port", "0", "--no-watch")
        process = stack.enter_context(running(*words))
        assert process.stdout is not None
        self.port = int(re.findall(r":(\d+)", process.stdout.readline())[-1])
        self._folder = Path("/proc", str(process.pid))

    def cpu(self) -> float:
        """CPU time so far [s]."""
        fields = (self._folder / "stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory(self) -> float:
        """What it has in memory [MB]."""
        pages = int((self._folder / "statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


@pytest.fixture
def place() -> Iterator[str]:
    peer = ZenohPeer(has_nodes=False)
    yield f"{peer.uri}/arm"
    peer.stop()


def moved(hand: ProtocolClient, *programs: Program) -> list[float]:
    """CPU time of programs while a joint moves as a robot's does [s]."""
    before = [program.cpu() for program in programs]
    begin = time.perf_counter()
    for number in range(STEPS):
        hand.edit(JOINT, number / STEPS)
        time.sleep(max(0.0, begin + (number + 1) / RATE - time.perf_counter()))
    return [p.cpu() - at for p, at in zip(programs, before, strict=True)]


def test_a_viewer_costs_a_follower_what_it_costs_a_server_and_the_origin_nothing(
    place: str, protocol: Callable[..., ProtocolClient]
) -> None:
    with ExitStack() as stack:
        server = Program(stack)
        origin = Program(stack, "--broadcast", place)
        followers = [Program(stack, "--follow", place) for _ in range(3)]
        at_server, at_origin = protocol(server.port), protocol(origin.port)
        watched = protocol(followers[0].port)
        watched.wait_until(lambda: JOINT in watched.rows, 30.0)
        memory = max(follower.memory() for follower in followers)
        [alone], [few] = moved(at_server, server), moved(at_origin, origin)
        with Crowd(server.port, VIEWERS, reads=False):
            [direct] = moved(at_server, server)
        with ExitStack() as crowds:
            for follower in followers:
                crowds.enter_context(
                    Crowd(follower.port, VIEWERS // 3, processes=1, reads=False)
                )
            many, *shares = moved(at_origin, origin, *followers)
        with Crowd(followers[0].port, VIEWERS, reads=False):
            _, one = moved(at_origin, origin, followers[0])
    ms = 1000 / VIEWERS / STEPS
    print(
        f"\n{VIEWERS} viewers on one server: {(direct - alone) * ms:.3f} ms a step and "
        f"viewer; on one follower, with all that it does: {one * ms:.3f} ms; on three: "
        f"{sum(shares) * ms:.3f} ms"
        f"\nthe origin: {few * 1000 / STEPS:.2f} ms a step with one viewer of a "
        f"follower, {many * 1000 / STEPS:.2f} ms with {VIEWERS + 1}; a server with one "
        f"page {alone * 1000 / STEPS:.2f} ms, with {VIEWERS + 1} pages "
        f"{direct * 1000 / STEPS:.2f} ms"
        f"\na follower takes {memory:.0f} MB"
    )
    # The follower has the work of a server: it unpacks and packs once for all viewers.
    assert one <= 1.5 * direct
    assert many <= 1.5 * few
