"""Clouds, maps, markers, paths and images, beside viser alone with the same data.

    python -m pytest tests/benchmarks/test_data_displays.py -s
    SAMBOT_VIZ_SOAK=600 python -m pytest tests/benchmarks/test_data_displays.py -s

Here a robot on the network sends messages, which are received, decoded, transformed and
drawn as RViz does; the shortest script for viser has the same numbers at hand. Server,
robot and light browsers have processes of their own on one machine.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import data_loads
import pytest
from crowd import Crowd
from patience import until
from protocol_client import ProtocolClient
from usage import usage

Join = Callable[[int], ProtocolClient]
SECONDS = 6.0
BROWSERS, MANY = 3, 30
SOAK = float(os.environ.get("SAMBOT_VIZ_SOAK", "0"))
"""How long everything is shown at once [s]."""
LIMITS = {"cloud": 6.0, "markers": 1.0, "path": 6.0, "image": 3.0}
"""Our computing divided by that of viser alone, at most."""


class Told:
    """A process that does what each line says, and prints what it has done."""

    def __init__(self, words: Sequence[str]) -> None:
        self.process = subprocess.Popen(
            [sys.executable, *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            bufsize=1,
        )
        self.first = self.read()

    @property
    def port(self) -> int:
        return int(self.first.rstrip("/").rpartition(":")[2])

    def read(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline().strip()

    def tell(self, line: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(f"{line}\n")


@contextmanager
def told(*words: str) -> Iterator[Told]:
    one = Told(words)
    try:
        yield one
    finally:
        one.process.terminate()
        one.process.communicate(timeout=60.0)


@dataclass(frozen=True)
class Cost:
    """What some seconds have cost.

    Attributes:
        share: of a core.
        rate: to each browser [MB/s].
        frames: batches to each browser in a second.
        memory: of the server after that [MB].
    """

    share: float
    rate: float
    frames: float
    memory: float

    def __str__(self) -> str:
        return (
            f"{self.share:6.1%} of a core, {self.rate:6.2f} MB/s and "
            f"{self.frames:4.1f} batches a second to each, {self.memory:.0f} MB"
        )


def measured(
    crowd: Crowd, server: int, talker: Told, words: str, seconds: float = SECONDS
) -> Cost:
    """What it costs while a process does what a line says."""
    talker.tell(words)
    assert talker.read() == "begins"
    crowd.look()
    before = usage(server)
    assert talker.read() == "said"
    after = usage(server)
    lights = crowd.look()
    assert not any(light.closed for light in lights)
    return Cost(
        after.share_since(before),
        statistics.mean(light.bytes for light in lights) / seconds / 1e6,
        statistics.mean(light.frames for light in lights) / seconds,
        after.memory,
    )


@contextmanager
def shown(names: Sequence[str], folder: Path) -> Iterator[tuple[Told, Told]]:
    """A robot that sends loads, and this program that shows them."""
    config = folder / "loads.rviz"
    config.write_text(data_loads.config_of(names), "utf-8")
    with told(data_loads.__file__, "robot") as robot:
        words = ["-m", "sambot_viz", "--port", "0", "-d", str(config)]
        with told(*words, "--source", robot.first) as ours:
            yield robot, ours


def pictures_asked(user: ProtocolClient) -> list[str]:
    """What a page says that shows all images."""

    def asked() -> list[str]:
        rows = [name for name in user.rows if name.startswith("images/")]
        keys = [name.removeprefix("images/") for name in rows]
        return [json.dumps(["images/show", [key, True]]) for key in keys]

    return until(asked, 30.0, not_yet=())


def ours_costs(name: str, protocol: Join, folder: Path) -> Cost:
    with shown([name], folder) as (robot, ours):
        user = protocol(ours.port)
        says = pictures_asked(user) if name == "image" else []
        user.close()
        with Crowd(ours.port, BROWSERS, 1, says=says, reads=False) as crowd:
            measured(crowd, ours.process.pid, robot, f"1 {name}", 1.0)
            return measured(crowd, ours.process.pid, robot, f"{SECONDS} {name}")


def alone_costs(name: str) -> Cost:
    with told(data_loads.__file__, "viser", name) as alone:
        with Crowd(alone.port, BROWSERS, 1, reads=False) as crowd:
            measured(crowd, alone.process.pid, alone, "1", 1.0)
            return measured(crowd, alone.process.pid, alone, f"{SECONDS}")


@pytest.mark.parametrize("name", ["cloud", "markers", "path", "image"])
def test_data_at_their_rate(name: str, protocol: Join, tmp_path: Path) -> None:
    load = data_loads.LOADS[name]
    theirs, ours = alone_costs(name), ours_costs(name, protocol, tmp_path)
    ratio = ours.share / theirs.share
    print(f"\n{name} at {load.rate} Hz, {BROWSERS} browsers: ratio {ratio:.2f}")
    print(f"  sambot-viz:  {ours}\n  viser alone: {theirs}")
    assert ours.frames > 0.7 * load.rate
    assert ratio < LIMITS[name]


def test_a_map_is_sent_once_and_an_update_only_its_part(
    protocol: Join, tmp_path: Path
) -> None:
    with shown(["map"], tmp_path) as (robot, ours):
        with Crowd(ours.port, BROWSERS, 1, reads=False) as crowd:
            first = measured(crowd, ours.process.pid, robot, "3 map", 1.0)
            update = measured(crowd, ours.process.pid, robot, f"{SECONDS} map_updates")
            still = measured(crowd, ours.process.pid, robot, f"{SECONDS}")
    with told(data_loads.__file__, "viser", "map_updates") as alone:
        with Crowd(alone.port, BROWSERS, 1, reads=False) as crowd:
            theirs = measured(crowd, alone.process.pid, alone, f"{SECONDS}")
    cells = data_loads.CELLS
    print(f"\na map of {cells}², {BROWSERS} browsers: {first.rate:.2f} MB at first")
    print(f"  updates of {data_loads.PATCH}² twice a second: {update}")
    print(f"  viser alone, the whole map each time: {theirs}")
    print(f"  nothing new: {still}")
    # Half a second of updates is two squares of 512 cells and a few bytes of rows.
    assert update.rate < 0.3 * first.rate
    assert update.rate < 0.3 * theirs.rate
    assert still.rate < 0.001 and still.share < 0.05


def test_all_at_once_with_thirty_browsers(protocol: Join, tmp_path: Path) -> None:
    """Nobody is disconnected, and memory stays as it is."""
    names = list(data_loads.LOADS)
    with shown(names, tmp_path) as (robot, ours):
        user = protocol(ours.port)
        says = pictures_asked(user)
        user.close()
        with Crowd(ours.port, MANY, 1, says=says, reads=False) as crowd:
            words = " ".join(names)
            measured(crowd, ours.process.pid, robot, f"5 {words}", 5.0)
            rounds = [
                measured(crowd, ours.process.pid, robot, f"{part} {words}", part)
                for part in [max(SECONDS, SOAK / 5)] * 5
            ]
    print(f"\nall at once, {MANY} browsers")
    for cost in rounds:
        print(f"  {cost}")
    assert rounds[-1].memory - rounds[1].memory < 30.0
