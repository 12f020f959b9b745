"""Keep one end of a broadcast connected to the router."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Callable, Coroutine
from concurrent.futures import TimeoutError as FutureTimeoutError
from contextlib import suppress
from functools import partial
from typing import Any, Protocol

from sambot_viz.errors import SourceError
from sambot_viz.outlet import logger
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.websocket.trouble import explain
from sambot_viz.sources.zenoh.broadcast_session import BroadcastSession
from sambot_viz.sources.zenoh.session import LONGEST_OPENING, open_session

AGAIN = 0.5, 1.5
"""Shortest and longest pause before the next attempt [s]; a random pause keeps ends
from connecting all at once."""

END_TIME = 1.0
"""Longest wait, at the end, for a connection that is opening [s]."""
_LONGEST_END = 2.0
"""Longest wait for the end of a task on an event loop [s]."""
_log = logger(__name__)


class End(Protocol):
    """One end of a broadcast; call all methods on the event loop."""

    def begin(self, session: BroadcastSession) -> None:
        """Continue with a new connection."""
        ...

    def cut(self, why: str) -> None:
        """Handle the loss of the connection, and its reason."""
        ...


class Trouble:
    """Log what keeps one end from working when it changes, and when it is over.

    Args:
        over: what to log when there is no trouble after some.

    Attributes:
        words: the trouble; "" for none.
    """

    def __init__(self, over: str) -> None:
        self.words = ""
        self._over = over

    def set(self, words: str) -> None:
        """Replace the trouble; "" for none."""
        if words != self.words:
            _log.warning(words or self._over)
        self.words = words


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


def run(
    loop: asyncio.AbstractEventLoop, main: Callable[[], Coroutine[Any, Any, None]]
) -> Callable[[], None]:
    """Start a task on the event loop of a server; return a function that ends it."""
    tasks: list[asyncio.Task[None]] = []

    def begin() -> None:
        tasks.append(loop.create_task(main()))

    async def end() -> None:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def stop() -> None:
        if not loop.is_closed():
            with suppress(FutureTimeoutError):
                asyncio.run_coroutine_threadsafe(end(), loop).result(_LONGEST_END)

    loop.call_soon_threadsafe(begin)
    return stop
