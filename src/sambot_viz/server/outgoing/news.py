"""Wake the clients of a buffer once for all messages that belong together.

viser wakes each client at each message and each flush, and lets each wait for more by
itself: two thread switches and a dozen timers and tasks for every picture. Here the
buffer waits once, for all its clients.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from sambot_viz import viser_private


class News:
    """Announce how many messages of a buffer may go out, and wake waiting clients.

    Changes made together, and flushed messages, go out at once. For other messages,
    the buffer first waits as long as viser collects messages.

    Args:
        buffer: buffer to watch from now on.

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
        # A flush right after a change that went out at once has no effect.
        self._asked = -1
        # A client lags behind `end`, because a change was in progress.
        self._is_held_up = False
        buffer.message_event = LoopEvent(self, self._loop, self._soon)
        buffer.flush_event = LoopEvent(self, self._loop, self._now)
        viser_private.replace_flush(buffer, self._change_ended, self._flush)

    @staticmethod
    def of(buffer: viser_private.MessageBuffer) -> News:
        """Return the instance that watches a buffer."""
        event = buffer.message_event
        return event.news if isinstance(event, LoopEvent) else News(buffer)

    def join(self) -> None:
        """Register a reader of the outgoing messages; call it on the loop."""
        if self.buffer.atomic_counter == 0:
            self.end = max(self.end, self.buffer.message_counter - 1)

    async def wait(self) -> None:
        """Wait until more messages may go out, or the buffer has ended."""
        waiting = self._loop.create_future()
        self._waiting.append(waiting)
        await waiting

    def may_go_on(self, is_behind: bool) -> bool:
        """Return whether a client without a batch may ask again, without waiting.

        Args:
            is_behind: whether messages for it were held back.
        """
        if not is_behind:
            return self.buffer.done
        # The order matters: the end of the change, in another thread, reads this flag.
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
            # A newcomer is counted there first, and then looks in `join`.
            return
        self._asked = self.buffer.message_counter - 1
        # A loop that has stopped has no clients.
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

    viser sets it in the thread that adds a message, and then on the loop.

    Args:
        news: owner of the event.
        loop: the event loop.
        act: action of the event.

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
        """Act on the event loop; in another thread, do nothing."""
        try:
            here = asyncio.get_running_loop()
        except RuntimeError:
            return
        if here is self._home:
            self._act()
