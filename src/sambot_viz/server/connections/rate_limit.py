"""Limits for the messages of one client: a rate, and a number in flight."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from contextlib import suppress

WINDOW = 30
"""A session queues at most twice this number of messages per client. A user's hand
sends these in a third of a second; of the values of one drag, only the last waits."""

Behind = Callable[[Callable[[], None]], None]
"""Runs an action, in any thread, after all effects of a client so far."""


class TokenBucket:
    """Let a number of events pass per second, after a burst, and hold back the rest.

    Args:
        per_second: long-term rate [1/s].
        burst: number of events that may come at once.
    """

    def __init__(self, per_second: float, burst: float) -> None:
        self._per_second = per_second
        self._burst = self._left = burst
        self._at = time.monotonic()

    def take(self) -> float:
        """Count one event, and return how long it must wait [s]."""
        now = time.monotonic()
        self._left += (now - self._at) * self._per_second
        self._left = min(self._left, self._burst) - 1.0
        self._at = now
        return max(0.0, -self._left / self._per_second)


class InFlightLimit:
    """Hold back a client that sends faster than its messages are handled.

    A session handles clients' messages in one thread, in order. A client's surplus
    messages wait in its own connection, not in the session's queue, so other clients
    wait for only a few of them.

    Args:
        behind: runs an action after the effects of the client's messages.
    """

    def __init__(self, behind: Behind) -> None:
        self._behind = behind
        self._count = 0
        self._earlier: asyncio.Event | None = None

    async def wait(self) -> None:
        """Count one message, and return when it may be read."""
        self._count += 1
        if self._count % WINDOW == 0:
            # The session may lag by one window: if this message waited for its own
            # mark, the session would run idle while the next message is read.
            earlier, self._earlier = self._earlier, self._mark()
            if earlier is not None:
                await earlier.wait()

    def _mark(self) -> asyncio.Event:
        """Return an event that the session sets after all work so far."""
        loop, done = asyncio.get_running_loop(), asyncio.Event()

        def set_it() -> None:
            # The session's thread calls this: only the loop may set its events, and a
            # loop that has ended has no clients.
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(done.set)

        self._behind(set_it)
        return done
