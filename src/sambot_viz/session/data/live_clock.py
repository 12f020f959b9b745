"""The clock of a live robot: its own time, or that of a simulation."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from sambot_viz.session.signals import Change, Signal
from sambot_viz.sources.source import Source
from sambot_viz.topics.reasons import TopicReason

SAME = 0.2
"""The robot's clock is heard through the network: smaller changes are no news [s]."""
_HOUR = 3600.0
_SIMULATED = 100_000_000.0
"""Simulations begin at 0: an earlier time is of none of today's clocks [s]."""


@dataclass(frozen=True, slots=True)
class ClockState:
    """The values from which a page computes the time of a robot.

    Attributes:
        simulated: whether the robot publishes its time, as a simulation does.
        time: that time [s]; else how far the robot's clock is ahead of this one [s].
        rate: speed of simulated time; 0 while it is paused.
    """

    simulated: bool = False
    time: float = 0.0
    rate: float = 1.0


class LiveClock:
    """Follows the clock of a source; not thread-safe.

    Args:
        source: the source with the clock.
        change: sends the state to pages.
        wall: returns the time of this computer [s].

    Attributes:
        state: the state for pages; changes only if they could not compute it.
    """

    def __init__(
        self, source: Source, change: Change, wall: Callable[[], float] = time.time
    ) -> None:
        self.state = Signal(change, ClockState())
        self._source = source
        self._change = change
        self._wall = wall
        self._newest = 0
        self._last: tuple[float, float] | None = None

    def went_back(self) -> float:
        """Return by how much a simulation went back since the last call [s], or 0."""
        if not self._source.has_clock:
            return 0.0
        before, self._newest = self._newest, self._source.clock_ns()
        return max(0, before - self._newest) * 1e-9

    def look(self) -> None:
        """Tell the time, if it is another one than a page thinks."""
        now, wall = self._source.clock_ns() * 1e-9, self._wall()
        state = self.state.value
        if not self._source.has_clock:
            self._last = None
            ahead = now - wall
            if state.simulated or abs(ahead - state.time) > SAME:
                self._tell(ClockState(time=round(ahead, 3)))
            return
        last, self._last = self._last, (now, wall)
        rate = 1.0 if last is None else (now - last[0]) / max(wall - last[1], 1e-3)
        told = ClockState(True, round(now, 3), round(max(0.0, rate), 2))
        # Of a paused simulation the rate is sent too, once.
        if told != state:
            self._tell(told)

    def _tell(self, state: ClockState) -> None:
        with self._change():
            self.state.set(state)


def wrong_clock(
    stamp: float, clock: float, has_topic: bool, is_told: bool
) -> TopicReason | None:
    """Say that the transforms are stamped by another clock than that of the robot.

    Args:
        stamp: the newest of /tf [s]; 0 without any.
        clock: the time of the robot [s].
        has_topic: whether /clock is published.
        is_told: whether its messages come.
    """
    if stamp and abs(stamp - clock) > _HOUR:
        if not is_told and stamp < _SIMULATED:
            text = f"/tf is stamped {stamp:.1f} in simulation time, but no /clock comes"
            why = "resume the simulation" if has_topic else "start the simulation"
            return TopicReason(
                "two-clocks",
                f"{text}: {why}, or set use_sim_time of the nodes to false",
            )
        if not is_told:
            return TopicReason(
                "two-clocks",
                f"/tf is stamped {stamp:.1f}, the robot's clock says {clock:.1f}: "
                "playing a bag? Use ros2 bag play --clock",
            )
        return TopicReason(
            "two-clocks",
            f"/tf is stamped {stamp:.1f}, /clock says {clock:.1f}: one of the nodes "
            "has the wrong use_sim_time",
        )
    if has_topic and not is_told:
        return TopicReason(
            "no-message",
            "no message of /clock has come: is the simulation paused? Until then the "
            "time is that of this computer",
        )
    return None
