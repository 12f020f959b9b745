"""The clock of a live robot, and what a page is told of it."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

import pytest

from sambot_viz.session.data.live_clock import ClockState, LiveClock, wrong_clock
from sambot_viz.session.signals import Change, connect
from sambot_viz.session.worker import Worker

WALL = 1_750_000_000.0


class Clocks:
    """A source of which only the clock counts, and what a page is told of it."""

    has_clock = False

    def __init__(self, worker: Worker) -> None:
        self.now = self.wall = WALL
        self.told: list[ClockState] = []
        change = Change(worker, cast(Any, self))
        clock = self.clock = LiveClock(cast(Any, self), change, lambda: self.wall)
        connect([clock.state], lambda: self.told.append(clock.state.value))

    @contextmanager
    def atomic(self) -> Iterator[None]:
        yield

    def flush(self) -> None:
        """Send nothing."""

    def clock_ns(self) -> int:
        return round(self.now * 1e9)

    def look_after(self, seconds: float, of_robot: float) -> None:
        self.wall += seconds
        self.now += of_robot
        self.clock.look()


@pytest.fixture
def clocks() -> Iterator[Clocks]:
    loop = asyncio.new_event_loop()
    worker = Worker(loop)
    yield Clocks(worker)
    worker.close()
    loop.close()


def test_a_page_goes_on_by_itself_with_a_clock_like_its_own(clocks: Clocks) -> None:
    for _ in range(10):
        clocks.look_after(0.5, 0.5001)
    assert clocks.told == []
    clocks.look_after(0.5, 60.5)
    assert [state.simulated for state in clocks.told] == [False]
    assert clocks.told[0].time == pytest.approx(60.0, abs=0.01)
    assert clocks.clock.went_back() == 0.0


def test_a_simulated_time_has_its_rate_and_a_paused_one_is_silent(
    clocks: Clocks,
) -> None:
    clocks.has_clock, clocks.now = True, 10.0
    clocks.look_after(0.5, 0.0)
    clocks.look_after(0.5, 0.25)
    assert clocks.told[-1] == ClockState(True, 10.25, 0.5)
    clocks.look_after(0.5, 0.0)
    assert clocks.told[-1] == ClockState(True, 10.25, 0.0)
    told = len(clocks.told)
    for _ in range(10):
        clocks.look_after(0.5, 0.0)
    assert len(clocks.told) == told


def test_only_a_clock_that_is_told_goes_back(clocks: Clocks) -> None:
    clocks.clock.went_back()
    clocks.now -= 5.0
    assert clocks.clock.went_back() == 0.0
    clocks.has_clock, clocks.now = True, 10.0
    assert clocks.clock.went_back() == 0.0
    clocks.now = 4.0
    assert clocks.clock.went_back() == pytest.approx(6.0)
    assert clocks.clock.went_back() == 0.0
    # The connection is lost, and made again.
    clocks.has_clock, clocks.now = False, WALL
    assert clocks.clock.went_back() == 0.0
    clocks.has_clock, clocks.now = True, 1.0
    assert clocks.clock.went_back() == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("stamp", "clock", "has_topic", "is_told", "says"),
    [
        (
            12.3,
            WALL,
            False,
            False,
            "/tf is stamped 12.3 in simulation time, but no /clock comes: start the "
            "simulation, or set use_sim_time of the nodes to false",
        ),
        (
            12.3,
            WALL,
            True,
            False,
            "/tf is stamped 12.3 in simulation time, but no /clock comes: resume the "
            "simulation, or set use_sim_time of the nodes to false",
        ),
        (
            WALL,
            12.3,
            True,
            True,
            "/tf is stamped 1750000000.0, /clock says 12.3: one of the nodes has the "
            "wrong use_sim_time",
        ),
        (
            0.0,
            WALL,
            True,
            False,
            "no message of /clock has come: is the simulation paused? Until then the "
            "time is that of this computer",
        ),
        (
            WALL,
            WALL + 40_000.0,
            False,
            False,
            "/tf is stamped 1750000000.0, the robot's clock says 1750040000.0: "
            "playing a bag? Use ros2 bag play --clock",
        ),
        (WALL, WALL + 1.0, False, False, ""),
        (12.0, 12.3, True, True, ""),
    ],
)
def test_a_wrong_clock_is_said_with_the_remedy(
    stamp: float, clock: float, has_topic: bool, is_told: bool, says: str
) -> None:
    found = wrong_clock(stamp, clock, has_topic, is_told)
    assert ("" if found is None else found.text) == says
