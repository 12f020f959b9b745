"""Wake the clients of a buffer of messages, once for all messages that go together.

viser wakes each client for each message and each request to send at once, and lets it
wait for more by itself: two switches between threads and a dozen of timers and tasks
for every picture. Here the buffer waits once, for all its clients.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from sambot_viz import viser_private


class News:
    """Say how many messages of a buffer may go out, and wake those who wait for more.

    What is changed together, and what is flushed, goes out at once; other messages are
    collected for viser's window first.

    Args:
        buffer: is watched from now on.

    Attributes:
        buffer: as given.
        end: number of the last message that may go out.
    """

    def __init__(self, buffer: viser_private.MessageBuffer) -> None:
        self.buffer = buffer
        self.end = -1
        self._loop = buffer.event_loop
        self._waiting: list[asyncio.Future[None]] = []
        self._timer: asyncio.TimerHandle | None = None
        # A flush right after a change that was sent at once asks for nothing more.
        self._asked = -1
        # Somebody is behind `end`, because a change was being made.
        self._is_held_up = False
        buffer.message_event = LoopEvent(self, self._loop, self._soon)
        buffer.flush_event = LoopEvent(self, self._loop, self._now)
        viser_private.replace_flush(buffer, self._change_ended, self._flush)

    @staticmethod
    def of(buffer: viser_private.MessageBuffer) -> News:
        """Return the one that watches a buffer."""
        event = buffer.message_event
        return event.news if isinstance(event, LoopEvent) else News(buffer)

    def join(self) -> None:
        """Take part from now on, in the loop: somebody reads what goes out."""
        if self.buffer.atomic_counter == 0:
            self.end = max(self.end, self.buffer.message_counter - 1)

    async def wait(self) -> None:
        """Wait until more may go out, or the buffer has ended."""
        waiting = self._loop.create_future()
        self._waiting.append(waiting)
        await waiting

    def may_go_on(self, is_behind: bool) -> bool:
        """Whether a client that was given nothing may ask again, without waiting.

        Args:
            is_behind: whether there was something that was held back.
        """
        if not is_behind:
            return self.buffer.done
        # In this order: the end of the change, in another thread, looks at this.
        self._is_held_up = True
        return self.buffer.atomic_counter == 0

    # In any thread

    def _change_ended(self) -> None:
        if self.buffer.message_counter - 1 > self.end or self._is_held_up:
            self._ask()

    def _flush(self) -> None:
        newest = self.buffer.message_counter - 1
        if newest > self.end and newest > self._asked:
            self._ask()

    def _ask(self) -> None:
        if not self.buffer.generator_cursors:
            # Whoever comes is counted there first, and then looks by `join`.
            return
        self._asked = self.buffer.message_counter - 1
        # A loop that has stopped already has no clients.
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._now)

    # On the loop

    def _soon(self) -> None:
        if self._timer is None and self.buffer.message_counter - 1 > self.end:
            window = self.buffer.window_duration_sec
            self._timer = self._loop.call_later(window, self._now)

    def _now(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        if self.buffer.atomic_counter and not self.buffer.done:
            # The end of that change asks again.
            return
        self.end = self.buffer.message_counter - 1
        self._is_held_up = False
        waiting, self._waiting = self._waiting, []
        for one in waiting:
            if not one.done():
                one.set_result(None)


class LoopEvent(asyncio.Event):
    """Event that acts on the event loop only.

    viser sets it in the thread that adds a message, and on the loop after that.

    Args:
        news: whose event it is.
        loop: the event loop.
        act: what to do.

    Attributes:
        news: as given.
    """

    def __init__(
        self, news: News, loop: asyncio.AbstractEventLoop, act: Callable[[], None]
    ) -> None:
        super().__init__()
        self.news = news
        self._home = loop
        self._act = act

    def set(self) -> None:
        """Act; in another thread that does nothing."""
        try:
            here = asyncio.get_running_loop()
        except RuntimeError:
            return
        if here is self._home:
            self._act()
