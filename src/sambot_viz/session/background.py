"""Work of a session that must not hold its lock, in a thread of its own."""

from __future__ import annotations

import threading
from collections.abc import Callable

Work = Callable[[], object]


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
        self._waiting: dict[int, Work] = {}
        self._is_running = False

    def do(self, owner: object, work: Work) -> None:
        """Do something soon; returns at once."""
        with self._changed:
            self._waiting[id(owner)] = work
            if not self._is_running:
                self._is_running = True
                threading.Thread(target=self._run, name=self._name, daemon=True).start()

    def wait(self, timeout: float) -> bool:
        """Wait until there is no more work; False when that takes longer [s]."""
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
            owner = next(iter(self._waiting), None)
            if owner is None:
                self._stopped()
                return None
            return self._waiting.pop(owner)

    def _stopped(self) -> None:
        self._is_running = False
        self._changed.notify_all()
