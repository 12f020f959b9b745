"""A robot in the index of a lab, and the state that its server reports."""

from __future__ import annotations

import asyncio
import time
import urllib.error
import urllib.request
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

from sambot_viz.server.protection.access import only_this_machine
from sambot_viz.server.readiness import READY

RobotState = Literal["ready", "waiting", "stopping", "locked", "other", "away"]
"""The state that a server reports; "locked" for a server that requires a login,
"other" for another program, and "away" for a server that does not answer."""
_PATIENCE = 2.0
"""A server that does not answer within this time is away [s]."""
_FRESH = 3.0
"""Shortest time between two questions for the states, however many users ask [s]."""
_AT_ONCE = 16
_LONGEST = 64
"""Longest part of an answer that is read [bytes]."""


@dataclass(frozen=True, slots=True)
class IndexedRobot:
    """A robot of the index.

    Attributes:
        name: name that users read.
        asked: address that reports its state, without a slash at the end.
        shown: address that browsers open; "" for a port of this machine.
        host: address its server listens on, for a port of this machine.
        port: port of that server.
        base_path: base path of that server.
    """

    name: str
    asked: str
    shown: str = ""
    host: str = "127.0.0.1"
    port: int = 0
    base_path: str = "/"

    def link(self, opened_at: str) -> str:
        """Return the address of the page; "" where the user cannot open it.

        Args:
            opened_at: name or address under which the browser opened the index.
        """
        if self.shown:
            return self.shown
        if only_this_machine(self.host) and not only_this_machine(opened_at):
            return ""
        name = f"[{opened_at}]" if ":" in opened_at else opened_at
        return f"http://{name}:{self.port}{self.base_path.rstrip('/')}/"


class _NoRedirects(urllib.request.HTTPRedirectHandler):
    """Do not follow redirects: they lead to a login."""

    def redirect_request(
        self, req: Any, fp: Any, code: Any, msg: Any, headers: Any, newurl: Any
    ) -> None:
        return None


_OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}), _NoRedirects())
"""Asks a server directly: robots are in this network, not beyond a proxy."""


def state_of(robot: IndexedRobot) -> RobotState:
    """Ask a robot's server for its state; takes two seconds at most."""
    try:
        with _OPENER.open(f"{robot.asked}{READY}", timeout=_PATIENCE) as answer:
            status, content = answer.status, answer.read(_LONGEST)
    except urllib.error.HTTPError as error:
        with error:
            status, content = error.code, error.read(_LONGEST)
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
    """

    def __init__(self, robots: Sequence[IndexedRobot]) -> None:
        self._robots = robots
        self._asked, self._lock = float("-inf"), asyncio.Lock()
        self._known: list[RobotState] = []

    async def get(self) -> Sequence[RobotState]:
        """Return the state of each robot, at most a few seconds old."""
        async with self._lock:
            if time.monotonic() - self._asked >= _FRESH:
                free = asyncio.Semaphore(_AT_ONCE)

                async def ask(robot: IndexedRobot) -> RobotState:
                    async with free:
                        return await asyncio.to_thread(state_of, robot)

                self._known = await asyncio.gather(*map(ask, self._robots))
                self._asked = time.monotonic()
        return self._known
