"""Followers cost what a server costs, and the origin does not see how many look.

CPU time of the processes is compared, while a joint is moved thirty times a second. It
does not depend on what else the machine does; delays do, and are only printed.
"""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import pytest
from crowd import Crowd
from follower_site import RATE as ROBOT_RATE
from follower_site import Part, Site, delay
from live_peers import free_port
from program import running
from protocol_client import ProtocolClient
from reconnecting import Visitors
from steps import p95
from usage import family_usage
from zenoh_peer import ZenohPeer

JOINT = "j/drivewhl_l_joint"
VIEWERS, RATE, STEPS = 30, 30.0, 120
SECONDS = 8.0
"""How long the robot turns for one figure [s]."""
LONGEST = 300.0
"""How long a busy machine may take to open a thousand pages [s]."""
LOOKING = 30
"""So many of the pages look into what comes."""
UNLIMITED = """
import sys
from dataclasses import replace
from sambot_viz import limits
from sambot_viz.cli import main
limits.PAGES = replace(limits.PAGES, value=5000)
limits.CONNECTIONS = replace(limits.CONNECTIONS, value=10000)
sys.exit(main(sys.argv[1:]))
"""
"""The program with room for more pages than it takes."""
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


@dataclass
class Load:
    """What pages cost while the robot turns.

    Attributes:
        cpu: time of each part [s].
        memory: of each part [MB].
        frames: sent to each page in a second.
        rate: sent to each page in a second [kB].
        steps: of the robot that a page has seen, of those in that time.
        delay: until 95 % of them were in a page, in the middle one of the pages [s].
    """

    pages: int
    cpu: list[float]
    memory: list[float]
    frames: float
    rate: float
    steps: float
    delay: float

    @property
    def cost(self) -> float:
        """CPU time of all parts for each page and second [ms]."""
        return 1000 * sum(self.cpu) / SECONDS / self.pages

    def __str__(self) -> str:
        cpu = " + ".join(f"{100 * one / SECONDS:.0f}" for one in self.cpu)
        memory = " + ".join(f"{one:.0f}" for one in self.memory)
        return (
            f"{self.pages:5} pages: {cpu} % of a core, {self.cost:.2f} ms for each "
            f"page and second; {memory} MB; each page gets {self.frames:.0f} frames "
            f"and {self.rate:.1f} kB a second, {100 * self.steps:.0f} % of the steps; "
            f"95 % of them after {1000 * self.delay:.0f} ms"
        )


def loaded(robot: Part, port: int, path: str, pages: int, *parts: Part) -> Load:
    """Open pages while the robot stands, and measure what they cost once it turns."""
    looking = min(pages, LOOKING)
    robot.tell("stay 1.0")
    with ExitStack() as stack:
        groups = [stack.enter_context(Visitors(port, path, looking, looks=True))]
        if pages > looking:
            silent = Visitors(port, path, pages - looking, timeout=LONGEST)
            groups.append(stack.enter_context(silent))
        robot.tell("move")
        time.sleep(1.0)
        for group in groups:
            group.look()
        before = [family_usage(part.pid) for part in parts]
        time.sleep(SECONDS)
        after = [family_usage(part.pid) for part in parts]
        seen = [one for group in groups for one in group.look()]
        for one in seen:
            assert one.is_here and not one.gaps, "a page was lost"
        taken = [[delay(*pose) for pose in one.poses] for one in seen[:looking]]
        return Load(
            pages,
            [b.cpu - a.cpu for a, b in zip(before, after, strict=True)],
            [one.memory for one in after],
            sum(one.frames for one in seen) / pages / SECONDS,
            sum(one.bytes for one in seen) / pages / SECONDS / 1000,
            median(map(len, taken)) / SECONDS / ROBOT_RATE,
            median(map(p95, taken)),
        )


def test_three_hundred_behind_three_followers_cost_what_thirty_cost_a_server(
    tmp_path: Path,
) -> None:
    with Site(tmp_path) as site:
        thirty = loaded(site.robot, site.origin_port, "/", 30, site.origin)
        place = site.robot, site.port, site.path
        one = loaded(*place, 1, site.origin)
        many = loaded(*place, 300, *site.followers, site.nginx, site.origin)
    *followers, nginx, origin = many.cpu
    share = 1000 * sum(followers) / SECONDS / 300
    print(
        f"\n  one server: {thirty}\n  three followers, nginx, the origin: {many}"
        f"\n  a page costs its follower {share:.2f} ms a second, "
        f"{share / thirty.cost:.2f} of what each of thirty costs a server, and nginx "
        f"{1000 * nginx / SECONDS / 300:.2f} ms; delay {many.delay / thirty.delay:.2f}"
        f"\n  the origin: {100 * one.cpu[0] / SECONDS:.1f} % of a core with one page, "
        f"{100 * origin / SECONDS:.1f} % with 300"
    )
    # A frame that a busy machine has no time for costs nothing.
    assert share / many.frames <= 1.2 * thirty.cost / thirty.frames
    assert origin <= 1.5 * one.cpu[0]


def test_which_resource_of_one_server_ends_first(tmp_path: Path) -> None:
    model, port = tmp_path / "arm.urdf", free_port()
    with Site(tmp_path, followers=1) as site:
        site.origin.kill()
        source = ("--source", site.robot.first_line.strip(), "--port", str(port))
        words = (sys.executable, "-c", UNLIMITED, str(model), "--no-watch", *source)
        server = Part("server", words, site.log)
        server.start()
        try:
            found: list[Load] = []
            for pages in (1, 100, 300, 1000):
                found.append(loaded(site.robot, port, "/", pages, server))
                print(f"\n  one server: {found[-1]}", flush=True)
        finally:
            server.kill()
    few, most = found[1], found[-1]
    # Each page costs as much computing as before; the one core that Python uses ends.
    assert most.cost / most.frames <= 1.5 * few.cost / few.frames
    assert most.memory[0] - few.memory[0] < 900 * 1.5
