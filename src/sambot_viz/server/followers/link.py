"""Keep one end of a broadcast connected to the router."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Protocol

from sambot_viz.errors import SourceError
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.websocket.trouble import explain
from sambot_viz.sources.zenoh.broadcast_session import BroadcastSession
from sambot_viz.sources.zenoh.session import LONGEST_OPENING, open_session

AGAIN = 0.5, 1.5
"""Shortest and longest pause before the next attempt [s]; a random pause keeps ends
from connecting all at once."""

END_TIME = 1.0
"""Longest wait, at the end, for a connection that is opening [s]."""


class End(Protocol):
    """One end of a broadcast; call all methods on the event loop."""

    def begin(self, session: BroadcastSession) -> None:
        """Continue with a new connection."""
        ...

    def cut(self, why: str) -> None:
        """Handle the loss of the connection, and its reason."""
        ...


async def hold(address: Address, end: End) -> None:
    """Keep one end connected until cancelled."""
    while True:
        why = f"The zenoh router at {address.label} has ended"
        try:
            await _hold_once(address, end)
        except SourceError as error:
            why = str(error)
        except (OSError, asyncio.TimeoutError) as error:
            why = explain(error, address)
        end.cut(why)
        await asyncio.sleep(random.uniform(*AGAIN))


async def _hold_once(address: Address, end: End) -> None:
    # zenoh reports the same message for all causes of an unreachable place.
    opening = asyncio.open_connection(address.host, address.port)
    _, writer = await asyncio.wait_for(opening, LONGEST_OPENING)
    writer.close()
    loop, lost = asyncio.get_running_loop(), asyncio.Event()

    def post(action: Callable[[], object]) -> None:
        # A loop that has ended needs no result.
        with suppress(RuntimeError):
            loop.call_soon_threadsafe(action)

    start = partial(open_session, address, post, lost.set, BroadcastSession)
    task = asyncio.ensure_future(asyncio.to_thread(start))
    try:
        session = await asyncio.shield(task)
        if session.router:
            end.begin(session)
            await lost.wait()
    finally:
        # A session that is abandoned while it opens is closed once it is open.
        await asyncio.wait([task], timeout=END_TIME)
        _close(task) if task.done() else task.add_done_callback(_close)


def _close(opened: asyncio.Future[BroadcastSession]) -> None:
    if not opened.cancelled() and opened.exception() is None:
        opened.result().close()
