"""Messages of a live robot, waiting until the session's worker takes them."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable

from sambot_viz import limits
from sambot_viz.session.worker import Worker
from sambot_viz.sources.message import Recorded

SLICE = 2**18
"""Messages that are taken in one step, so that clients get their turn [bytes]."""


class Inbox:
    """Takes messages in any thread, and hands them on at the Frame Rate.

    Args:
        worker: in it they are handed on.
        look: called before what waits is taken.
        take: gets one message after the other.
        draw: called at the end, when enough time has passed.

    Attributes:
        lost: how many messages had to be dropped.
        period: the time between two drawings [s].
    """

    def __init__(
        self,
        worker: Worker,
        look: Callable[[], object],
        take: Callable[[Recorded], object],
        draw: Callable[[], object],
    ) -> None:
        self.lost = 0
        self.period = 1 / 30
        self._worker = worker
        self._look = look
        self._take_one = take
        self._draw = draw
        self._waiting: deque[Recorded] = deque()
        self._size = 0
        # The thread of the source adds, the worker takes.
        self._lock = threading.Lock()
        self._is_asked = False
        self._drawn = float("-inf")
        self._took = 0.0
        self._goes_on = False

    def put(self, message: Recorded) -> None:
        """Keep a message for the worker; runs in the thread of the source."""
        with self._lock:
            self._waiting.append(message)
            self._size += len(message.payload)
            while len(self._waiting) > limits.SESSION_WAITING.value or (
                self._size > limits.WAITING_BYTES.value and len(self._waiting) > 1
            ):
                self._size -= len(self._waiting.popleft().payload)
                self.lost += 1
        self.wake()

    def wake(self) -> None:
        """Let the worker take what has come, at the Frame Rate; runs in any thread."""
        with self._lock:
            if self._is_asked:
                return
            self._is_asked = True
        left = self._drawn + self._pause - self._worker.clock.now()
        if left > 0:
            self._worker.post_later(left, self._take)
        else:
            self._worker.post(self._take)

    def _take(self) -> None:
        """Take some of what waits, and draw at the end; runs in the worker.

        However much waits, clients get their turn after a slice of it.
        """
        with self._lock:
            self._is_asked = False
        # What waits may be of the time after it.
        self._look()
        left = SLICE
        while left > 0 and (message := self._next_waiting()) is not None:
            left -= len(message.payload)
            self._take_one(message)
        if self._waiting and not self._goes_on:
            self._goes_on = True
            self._worker.post(self._go_on)
        begin = self._worker.clock.now()
        if begin - self._drawn < self._pause:
            self.wake()
            return
        self._drawn = begin
        self._draw()
        self._took = self._worker.clock.now() - begin

    def _go_on(self) -> None:
        self._goes_on = False
        self._take()

    @property
    def _pause(self) -> float:
        """The time from one drawing to the next [s].

        Nothing goes out while it is drawn: as long again is for those who wait for it.
        """
        return max(self.period, 2 * self._took)

    def _next_waiting(self) -> Recorded | None:
        with self._lock:
            if not self._waiting:
                return None
            message = self._waiting.popleft()
            self._size -= len(message.payload)
            return message
