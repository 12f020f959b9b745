"""The states of the robots in the index of a lab, as their servers report them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence

from sambot_viz.classroom.asking import ask
from sambot_viz.lab.indexed_robot import IndexedRobot, RobotState
from sambot_viz.lab.router_robots import RouterRobots
from sambot_viz.server.readiness import READY

_PATIENCE = 2.0
"""A server that does not answer within this time is away [s]."""
_FRESH = 3.0
"""Shortest time between two questions for the states, however many users ask [s]."""
_AT_ONCE = 16
_LONGEST = 64
"""Longest part of an answer that is read [bytes]."""


def state_of(robot: IndexedRobot) -> RobotState:
    """Ask a robot's server for its state; takes two seconds at most."""
    try:
        status, content = ask(f"{robot.asked}{READY}", _PATIENCE, _LONGEST)
    except (OSError, ValueError):
        return "away"
    word = content.decode(errors="replace").strip()
    if status == 200 and word == "ready":
        return "ready"
    if status == 503 and word in ("waiting", "stopping"):
        return word
    return "locked" if status in (301, 302, 303, 307, 308, 401, 403) else "other"


class RobotStates:
    """The states of all robots, requested when a user opens the index.

    Args:
        robots: robots of the index.
        routers: routers with more robots, which come and go.
    """

    def __init__(
        self, robots: Sequence[IndexedRobot], routers: Sequence[RouterRobots] = ()
    ) -> None:
        self._robots, self._routers = robots, routers
        self._asked, self._lock = float("-inf"), asyncio.Lock()
        self._known: list[tuple[IndexedRobot, RobotState]] = []

    async def get(self) -> Sequence[tuple[IndexedRobot, RobotState]]:
        """Return each robot with its state, at most a few seconds old."""
        async with self._lock:
            if time.monotonic() - self._asked >= _FRESH:
                free = asyncio.Semaphore(_AT_ONCE)

                async def ask(robot: IndexedRobot) -> RobotState:
                    async with free:
                        return await asyncio.to_thread(state_of, robot)

                states = await asyncio.gather(*map(ask, self._robots))
                self._known = [*zip(self._robots, states, strict=True)]
                for seen in await asyncio.gather(*(r.get() for r in self._routers)):
                    self._known += seen
                self._asked = time.monotonic()
        return self._known
