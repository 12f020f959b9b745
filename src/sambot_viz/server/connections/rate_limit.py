"""Limits of how much one client may send: a rate, and how far it may be ahead."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from contextlib import suppress

WINDOW = 30
"""At most two times so many messages of a client wait in a session. A hand sends these
in a third of a second; of the values of one drag only the last one waits."""

Behind = Callable[[Callable[[], None]], None]
"""Runs an action, in any thread, behind all that a client has caused so far."""


class TokenBucket:
    """Let so many events pass in a second, after a burst, and hold back the rest.

    Args:
        per_second: events in the long run [1/s].
        burst: events that may come at once.
    """

    def __init__(self, per_second: float, burst: float) -> None:
        self._per_second = per_second
        self._burst = self._left = burst
        self._at = time.monotonic()

    def take(self) -> float:
        """Count one event; returns how long it has to wait [s]."""
        now = time.monotonic()
        self._left += (now - self._at) * self._per_second
        self._left = min(self._left, self._burst) - 1.0
        self._at = now
        return max(0.0, -self._left / self._per_second)


class InFlightLimit:
    """Hold back a client whose messages take longer than it takes to send them.

    A session does what clients send in one thread, in order. What a client sends faster
    than that waits in its own connection, not in the queue of the session, so that the
    others wait for a few of its messages only.

    Args:
        behind: runs an action behind what the client's messages have caused.
    """

    def __init__(self, behind: Behind) -> None:
        self._behind = behind
        self._count = 0
        self._earlier: asyncio.Event | None = None

    async def wait(self) -> None:
        """Count one message, and return when it may be read."""
        self._count += 1
        if self._count % WINDOW == 0:
            # The session may be one window behind: waiting for this one's own mark
            # would let it run idle while the next message is read.
            earlier, self._earlier = self._earlier, self._mark()
            if earlier is not None:
                await earlier.wait()

    def _mark(self) -> asyncio.Event:
        """Return an event that is set when everything so far is done."""
        loop, done = asyncio.get_running_loop(), asyncio.Event()

        def set_it() -> None:
            # Called in the session's thread: only the loop may set its events, and a
            # loop that has ended already has no clients.
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(done.set)

        self._behind(set_it)
        return done
