"""Work of a session that must not hold its lock, in its own thread."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import NamedTuple

Work = Callable[[], object]


class _WaitingWork(NamedTuple):
    due: float
    work: Work


class Background:
    """Does one piece of work after the other in a thread that lives while there is any.

    Of several that wait for one owner only the latest is done, so a client that asks
    often keeps one thread busy.

    Args:
        name: of the thread.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._changed = threading.Condition()
        self._waiting: dict[int, _WaitingWork] = {}
        self._is_running = False

    def do(self, owner: object, work: Work, *, after: float = 0.0) -> None:
        """Schedule work, and return at once.

        Args:
            owner: the object that the work is for; work that waits for it is replaced.
            work: the function to call.
            after: the shortest delay [s].
        """
        with self._changed:
            self._waiting[id(owner)] = _WaitingWork(time.monotonic() + after, work)
            self._changed.notify_all()
            if not self._is_running:
                self._is_running = True
                threading.Thread(target=self._run, name=self._name, daemon=True).start()

    def wait(self, timeout: float) -> bool:
        """Wait until all work is done; return False after the time limit [s]."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._is_running, timeout)

    def _run(self) -> None:
        while (work := self._next()) is not None:
            try:
                work()
            except BaseException:
                # After an internal error the next work starts another thread.
                with self._changed:
                    self._stopped()
                raise

    def _next(self) -> Work | None:
        with self._changed:
            while self._waiting:
                owner = min(self._waiting, key=self._due)
                left = self._due(owner) - time.monotonic()
                if left <= 0:
                    return self._waiting.pop(owner).work
                self._changed.wait(left)
            self._stopped()
            return None

    def _due(self, owner: int) -> float:
        return self._waiting[owner].due

    def _stopped(self) -> None:
        self._is_running = False
        self._changed.notify_all()
