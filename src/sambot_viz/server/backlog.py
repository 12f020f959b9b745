"""Holds back a browser whose messages take longer than it takes to send them.

A session does what browsers send in one thread, in order. What a browser sends faster
than that waits in its own connection, not in the queue of the session, so that the
others wait for a few of its messages only.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

WINDOW = 30
"""At most two times so many messages of a browser wait in a session. A hand sends these
in a third of a second; of the values of one drag only the last one waits."""

Behind = Callable[[Callable[[], None]], None]
"""Runs an action, in any thread, behind all that a browser has caused so far."""


class Backlog:
    """Counts the messages of one browser.

    Args:
        behind: runs an action behind what these have caused.
    """

    def __init__(self, behind: Behind) -> None:
        self._behind = behind
        self._count = 0
        self._earlier: asyncio.Event | None = None

    async def wait(self) -> None:
        """Count one message, and return when it may be read."""
        self._count += 1
        if self._count % WINDOW == 0:
            earlier, self._earlier = self._earlier, self._mark()
            if earlier is not None:
                await earlier.wait()

    def _mark(self) -> asyncio.Event:
        """An event that is set when everything so far is done."""
        loop, done = asyncio.get_running_loop(), asyncio.Event()

        def set_it() -> None:
            # A loop that has ended already has no browsers.
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(done.set)

        self._behind(set_it)
        return done
