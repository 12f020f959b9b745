r"""Three followers behind nginx and 300 pages, while processes are killed at random.

    python -m pytest tests/benchmarks/test_followers_killed.py -s
    SAMBOT_VIZ_KILLS=600 python -m pytest tests/benchmarks/test_followers_killed.py -s \
        -o faulthandler_timeout=1200

The robot turns its joint thirty times a second. Followers, the router, nginx and the
origin are killed, one at a time, and started again. What is asserted does not depend on
how fast the machine is; how long pages were away is printed.
"""

from __future__ import annotations

import os
import random
import sys
import time
from collections import defaultdict
from pathlib import Path

import pytest
from follower_site import Part, Site
from patience import patience, until
from reconnecting import Visitors
from steps import p95
from usage import family, usage

SECONDS = float(os.environ.get("SAMBOT_VIZ_KILLS", "60"))
"""How long something is killed again and again [s]."""
PAGES, WATCHERS = 300, 6
LONGEST = 300.0
"""How long the page of a watcher may take until it moves again [s]."""
MORE = 60.0
"""What a process may take more than at its first look: 200 pages may come to a follower
that had a hundred, and Python keeps memory for later [MB]."""
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")


def moves_again(watchers: Visitors, since: float) -> float:
    """Wait until the robot moves in all watchers' pages; how long it took [s]."""
    moving = dict[int, float]()
    end = since + patience(LONGEST)
    while len(moving) < WATCHERS:
        time.sleep(0.1)
        seen = watchers.look()
        for number, one in enumerate(seen):
            later = [at for at, _ in one.poses if at > since]
            if later:
                moving.setdefault(number, later[0])
        still = [(n, one) for n, one in enumerate(seen) if n not in moving]
        assert time.perf_counter() < end, f"stand still: {still}"
    return max(moving.values()) - since


def kill_and_start(part: Part, watchers: Visitors, chance: random.Random) -> float:
    """Kill a part and start it again; how long the watchers' robots stood still [s]."""
    since = time.perf_counter()
    part.kill()
    if part.name.startswith("follower"):
        # The other followers take its pages.
        taken = moves_again(watchers, since)
        part.start()
        return taken
    time.sleep(chance.uniform(0.0, 3.0))
    part.start()
    return moves_again(watchers, time.perf_counter())


def test_a_thousand_pages_that_come_at_once_show_the_newest(tmp_path: Path) -> None:
    with Site(tmp_path, followers=6) as site:
        site.robot.tell("stay 1.0")
        with Visitors(site.port, site.path, 1000, 2, looks=True) as pages:
            pages.until_all_show(1.0)
            site.nginx.kill()
            site.robot.tell("stay 2.0")
            site.nginx.start()
            found = pages.until_all_here() + pages.until_all_show(2.0)
        gaps = sorted(gap for one in found for gap in one.gaps)
        print(
            "\n  1,000 pages that nginx has left: away for "
            f"{gaps[0]:.1f} to {gaps[-1]:.1f} s, half of them for less than "
            f"{gaps[len(gaps) // 2]:.1f} s; refused {sum(s.refused for s in found)} "
            "times"
        )


def lives(process: int) -> bool:
    """Return whether a process has not ended, whoever asks for its exit status."""
    try:
        stat = Path(f"/proc/{process}/stat").read_text("utf-8")
    except OSError:
        return False
    return stat.rpartition(")")[2].split()[0] != "Z"


def test_pages_come_back_whatever_is_killed(tmp_path: Path) -> None:
    seed = random.randrange(10**6)
    chance = random.Random(seed)
    print(f"\n  seed {seed}; {SECONDS:.0f} s of kills, {PAGES} pages")
    away = defaultdict[str, list[float]](list)
    gaps: list[float] = []
    memory = defaultdict[str, list[float]](list)
    refused = 0
    with (
        Site(tmp_path) as site,
        Visitors(site.port, site.path, PAGES - WATCHERS, processes=2) as pages,
        Visitors(site.port, site.path, WATCHERS, looks=True) as watchers,
        Visitors(site.origin_port, "/", 1, looks=True) as witness,
    ):
        weights = [3] * len(site.followers) + [3, 2, 2]
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            for part in site.parts:
                memory[part.name].append(usage(part.pid).memory)
            [part] = chance.choices(site.parts, weights)
            print(f"  {time.strftime('%H:%M:%S')} {part.name}", end=" ", flush=True)
            away[part.name].append(kill_and_start(part, watchers, chance))
            print(f"{away[part.name][-1]:.1f} s")
            time.sleep(chance.uniform(0.0, 3.0))
            found = pages.until_all_here()
            gaps += [gap for one in found for gap in one.gaps]
            refused += sum(one.refused for one in found)
        pages.look_into_frames()
        site.robot.tell("stay 1.5")
        for visitors in (pages, watchers, witness):
            last = visitors.until_all_show(1.5)
        origin_kills = len(away["origin"])
        processes = {part.name: [*family(part.pid)] for part in site.parts}
        for part in site.parts:
            memory[part.name].append(usage(part.pid).memory)
            first, now = memory[part.name][0], memory[part.name][-1]
            print(
                f"  {part.name}: killed {len(away[part.name])} times, robots move "
                f"again after {' '.join(f'{one:.1f}' for one in away[part.name])} s; "
                f"{first:.0f} MB at first, {now:.0f} MB at the end, "
                f"{max(memory[part.name]):.0f} MB at most"
            )
            assert max(memory[part.name]) - first < MORE
            assert len(processes[part.name]) == (2 if part.name == "nginx" else 1)
        print(
            f"  pages were away {len(gaps)} times: half of them for less than "
            f"{sorted(gaps)[len(gaps) // 2]:.1f} s, 95 % for {p95(gaps):.1f} s, the "
            f"longest for {max(gaps):.1f} s; refused {refused} times"
            if gaps
            else "  no page was away"
        )
        # What is killed elsewhere does not reach the origin.
        assert sum(len(one.gaps) for one in last) == origin_kills
    for name, numbers in processes.items():
        until(
            lambda numbers=numbers: not any(map(lives, numbers)), why=f"{name} is left"
        )
    assert "Traceback" not in site.log.read_text("utf-8")
