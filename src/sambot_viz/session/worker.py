"""The thread of a session, the pace of its streams, and its clock.

viser calls back on its event loop, which serves every browser and must never wait. So
a callback only posts an action here. The worker runs the actions one by one and holds
the session's lock meanwhile, so that a program's own threads, which take the same lock,
never see a half-changed session. Clients take turns, so that a busy one does not hold
up others; while clients with and without control wait, every other action is from one
in control.

A throttle runs an action at once for a single event, and at a steady rate for a
stream. All parts of a session measure time with the worker's clock, which also decides
when a delayed action is due. It is the computer's; tests move their own by hand.
"""

from __future__ import annotations

import asyncio
import heapq
import threading
import time
from collections import deque
from collections.abc import Callable, Coroutine
from functools import partial
from typing import Any, Protocol

from sambot_viz.outlet import logger

Action = Callable[[], object]
OnError = Callable[[Exception, int | None], None]

LONGEST_STOP = 5.0
"""`close` waits this long for the action that is running [s]."""
_LOCK_POLL = 0.05
"""The worker looks this often whether it was closed while it waits for the lock [s]."""


class Worker(threading.Thread):
    """Runs posted actions one at a time; started by the first of them.

    Args:
        loop: viser's event loop, for `run_on_loop`.
        clock: the time of the session; the computer's by default.

    Attributes:
        clock: the same.
        lock: held while an action runs; threads of the program may take it too.
        in_control: whether a client has control; asked in any thread, takes no lock.
        on_error: called with an exception that an action raised, and the client that
            has caused it; logs it by default.
    """

    def __init__(
        self, loop: asyncio.AbstractEventLoop, clock: Clock | None = None
    ) -> None:
        super().__init__(name="sambot-viz-session", daemon=True)
        self.clock = clock or WallClock()
        self.lock = threading.RLock()
        self.in_control: Callable[[int], bool] = lambda client: True
        self.on_error: OnError = lambda error, client: log_error(error)
        self._loop = loop
        self._changed = threading.Condition()
        # By client, who comes next first; None is the program itself.
        self._inbox: dict[int | None, deque[tuple[object, Action]]] = {}
        self._was_in_control = False
        self._acting: int | None = None
        self._timers: list[tuple[float, int, Action]] = []
        self._count = 0
        self._closed = False

    def post(
        self, action: Action, latest_of: object = None, *, client: int | None = None
    ) -> None:
        """Queue an action after the earlier ones of its client, and return at once.

        Args:
            action: the function to run.
            latest_of: a key; of a client's queued actions with the same key only the
                last one runs, unless one without a key was posted in between: a flood
                of slider values costs one step.
            client: the client that caused it; None for the program itself.
        """
        with self._changed:
            if self._closed:
                return
            waiting = self._inbox.setdefault(client, deque())
            if latest_of is not None:
                _forget_earlier(waiting, latest_of)
            waiting.append((latest_of, action))
            self._wake()

    def post_later(self, delay: float, action: Action) -> None:
        """Run an action after a delay [s]; returns at once."""
        with self._changed:
            if self._closed:
                return
            self._count += 1
            due = self.clock.now() + delay
            heapq.heappush(self._timers, (due, self._count, action))
            self._wake()

    def run_on_loop(self, task: Coroutine[Any, Any, None], client: int) -> None:
        """Run something on viser's event loop that waits for a client there."""

        async def reported() -> None:
            try:
                await task
            except Exception as error:
                # The loop serves every client and waits for no lock.
                self.post(partial(self.on_error, error, client), client=client)

        asyncio.run_coroutine_threadsafe(reported(), self._loop)

    def close(self) -> None:
        """Drop what was posted, and wait for the action that is running.

        It may be called from anywhere: by the action that is running, or by a thread
        that holds the lock.
        """
        with self._changed:
            self._closed = True
            self._inbox.clear()
            self._timers.clear()
            self._changed.notify_all()
        if self.is_alive() and threading.current_thread() is not self:
            self.join(LONGEST_STOP)

    def run(self) -> None:
        """Run the actions until `close`; the thread's own method."""
        while (turn := self._next()) is not None:
            if not self._take_lock():
                return
            self._acting, action = turn
            try:
                action()
            except Exception as error:
                self.report(error)
            finally:
                self._acting = None
                self.lock.release()

    def report(self, error: Exception) -> None:
        """Report an exception as one of the action that runs, if one does."""
        own = threading.current_thread() is self
        self.on_error(error, self._acting if own else None)

    def _next(self) -> tuple[int | None, Action] | None:
        """Wait for the next action, and whose it is; None after `close`."""
        with self._changed:
            while not self._closed:
                self._take_due()
                if self._inbox:
                    return self._next_turn()
                due = self._timers[0][0] if self._timers else None
                self.clock.wait(self._changed, due)
            return None

    def _take_due(self) -> None:
        """Queue the due actions with all others.

        A stream that takes longer than its period is always due: opening a page must
        not wait until it ends.
        """
        while self._timers and self._timers[0][0] <= self.clock.now():
            action = heapq.heappop(self._timers)[2]
            self._inbox.setdefault(None, deque()).append((None, action))

    def _next_turn(self) -> tuple[int | None, Action]:
        """Take the oldest action of the one whose turn it is."""
        wanted = not self._was_in_control
        turns = {one: one is None or self.in_control(one) for one in self._inbox}
        turn = next((one for one in turns if turns[one] is wanted), next(iter(turns)))
        self._was_in_control = turns[turn]
        waiting = self._inbox.pop(turn)
        _, action = waiting.popleft()
        if waiting:
            # Last in the queue.
            self._inbox[turn] = waiting
        return turn, action

    def _take_lock(self) -> bool:
        """Take the lock; False when the worker was closed before it was free."""
        while not self.lock.acquire(timeout=_LOCK_POLL):
            if self._closed:
                return False
        return True

    def _wake(self) -> None:
        if self.ident is None:
            self.start()
        self._changed.notify()


def _forget_earlier(waiting: deque[tuple[object, Action]], latest_of: object) -> None:
    for index in reversed(range(len(waiting))):
        if waiting[index][0] is None:
            # It may need what was set before.
            return
        if waiting[index][0] == latest_of:
            del waiting[index]
            return


class Throttle:
    """Runs an action at most once per period, and never later than one period.

    The first request after a pause runs at once, in the caller's thread. Requests
    that come sooner are folded into one run at the end of the period, in the session's
    worker; nothing runs when nothing was requested.

    Args:
        worker: where late runs happen.
        period: shortest time between two runs [s].
        action: what to run; it takes its own lock.
    """

    def __init__(
        self, worker: Worker, period: float, action: Callable[[], object]
    ) -> None:
        self.period = period
        self._worker = worker
        self._action = action
        self._lock = threading.Lock()
        self._last = float("-inf")
        self._waiting = False
        self._closed = False

    def request(self) -> None:
        """Run the action now or at the end of the present period."""
        with self._lock:
            if self._waiting or self._closed:
                return
            left = self._last + self.period - self._worker.clock.now()
            if left > 0:
                self._waiting = True
                self._worker.post_later(left, self._late)
                return
            self._last = self._worker.clock.now()
        self._action()

    def close(self) -> None:
        """Run nothing any more."""
        with self._lock:
            self._closed = True

    def _late(self) -> None:
        with self._lock:
            self._waiting = False
            if self._closed:
                return
            self._last = self._worker.clock.now()
        self._action()


class Clock(Protocol):
    """Gives the time to all parts of a session that ask for it."""

    def now(self) -> float:
        """Return the time [s]; differences count, the start may be anything."""
        ...

    def wait(self, changed: threading.Condition, until: float | None) -> None:
        """Wait in a condition, whose lock is held, until a time [s] at the latest."""
        ...


class WallClock:
    """The time of the computer, which never goes back."""

    def now(self) -> float:
        """Return the time since some start [s]."""
        return time.monotonic()

    def wait(self, changed: threading.Condition, until: float | None) -> None:
        """Wait in a condition, until a time [s] at the latest."""
        changed.wait(None if until is None else until - self.now())


def log_error(error: Exception) -> None:
    """Log an unexpected exception, with its traceback."""
    logger("sambot_viz").error("internal error: %s", error, exc_info=error)
