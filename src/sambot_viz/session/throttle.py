"""At once for a single event, at a steady rate for a stream: the latest wins."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from sambot_viz.session.worker import Worker


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
            left = self._last + self.period - time.monotonic()
            if left > 0:
                self._waiting = True
                self._worker.post_later(left, self._late)
                return
            self._last = time.monotonic()
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
            self._last = time.monotonic()
        self._action()
