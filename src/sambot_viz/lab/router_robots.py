"""The robots that broadcast over a router of zenoh: they come and go by themselves."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from urllib.parse import urlsplit

from sambot_viz import limits
from sambot_viz.lab.indexed_robot import IndexedRobot, RobotState
from sambot_viz.server.followers import link
from sambot_viz.server.followers.wire import OriginPage, page_of
from sambot_viz.server.protection.access import only_this_machine
from sambot_viz.sources.broadcast_place import (
    EVERY_ORIGIN,
    BroadcastPlace,
    name_of,
    origin_of,
)
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.zenoh.broadcast_session import BroadcastSession

_PATIENCE = 2.0
"""A router, or an origin, that does not answer within this time is away [s]."""


class RouterRobots:
    """Lists the robots of a router, with the states that their origins report.

    Call all methods on the event loop of the index.

    Args:
        address: address of the router.

    Attributes:
        trouble: reason why the list may be old; "" for none.
    """

    def __init__(self, address: Address) -> None:
        self._address = address
        self.trouble = f"Waiting for the zenoh router at {address.label}"
        self._session: BroadcastSession | None = None
        self._told = asyncio.Event()
        # By name; a robot that has ended stays in the list.
        self._origins: dict[str, set[str]] = {}
        self._known: dict[str, IndexedRobot] = {}

    async def run(self) -> None:
        """Stay connected to the router until cancelled."""
        await link.hold(self._address, self)

    def begin(self, session: BroadcastSession) -> None:
        """Watch who broadcasts."""
        self._session, self.trouble = session, ""
        session.watch(EVERY_ORIGIN, self._take, self._told.set)

    def cut(self, why: str) -> None:
        """Keep the names; their states are not known."""
        self._session, self.trouble = None, why
        self._told.clear()
        for origins in self._origins.values():
            origins.clear()

    def _take(self, token: str, is_there: bool) -> None:
        name, (origin, _) = name_of(token), origin_of(token)
        if name not in self._origins:
            if len(self._origins) >= limits.INDEXED_ROBOTS.value:
                most = limits.INDEXED_ROBOTS.value
                where = self._address.label
                self.trouble = f"{where} has more robots: the first {most:,} are listed"
                return
            self._origins[name] = set()
        if is_there:
            self._origins[name].add(origin)
        else:
            self._origins[name].discard(origin)

    async def get(self) -> Sequence[tuple[IndexedRobot, RobotState]]:
        """Return the robots by name, each with its state."""
        with suppress(asyncio.TimeoutError):
            await asyncio.wait_for(self._told.wait(), _PATIENCE)
        names = sorted(self._origins)
        states = await asyncio.gather(*map(self._state_of, names))
        robots = [self._known.get(name, IndexedRobot(name, "")) for name in names]
        return [*zip(robots, states, strict=True)]

    async def _state_of(self, name: str) -> RobotState:
        session = self._session
        if session is None or not self._origins[name]:
            return "away"
        found: asyncio.Future[OriginPage | None]
        found = asyncio.get_running_loop().create_future()

        def answered(content: bytes) -> None:
            if not found.done():
                found.set_result(page_of(content))

        def ended() -> None:
            if not found.done():
                found.set_result(None)

        place = BroadcastPlace(replace(self._address, name=name))
        session.ask(place.page, _PATIENCE, answered, ended)
        page = None
        with suppress(asyncio.TimeoutError):
            page = await asyncio.wait_for(found, 2 * _PATIENCE)
        if page is None:
            return "away"
        self._known[name] = _robot(name, page.url)
        return page.state


def _robot(name: str, url: str) -> IndexedRobot:
    """Return a robot by the address that its origin has told."""
    try:
        parts = urlsplit(url)
        host, port = parts.hostname or "", parts.port or 0
    except ValueError:
        return IndexedRobot(name, "")
    if parts.scheme not in ("http", "https") or not host:
        return IndexedRobot(name, "")
    if only_this_machine(host):
        return IndexedRobot(name, "", "", host, port, parts.path or "/")
    shown = f"{url.partition('?')[0].rstrip('/')}/"
    return IndexedRobot(name, "", shown)
