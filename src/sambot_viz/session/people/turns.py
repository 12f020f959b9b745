"""Turns: viewers who request control have it one after the other, for a time each.

A turn ends with its time, when someone waits, or when its holder releases control,
leaves or is stopped. Presenters keep control, and can give it out of this order.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sambot_viz.session.people.roles import Roles
from sambot_viz.session.signals import connect
from sambot_viz.session.worker import Worker

PAUSE = 10.0
"""After a turn that was not handed over nobody has control for so long [s]: all see a
stop, and who loads the page again goes on."""
TOLD = 10.0
"""While someone waits, all are told at such intervals how long it takes [s]."""


class Waiting(NamedTuple):
    """A viewer in the queue: the place from 1, and the longest wait [s]."""

    place: int
    seconds: float


class Turns:
    """Gives control to those who request it, in their order.

    Args:
        roles: who is there, has control and requests it.
        slot: how long a turn is, while others wait [s].
        worker: its clock counts, and its thread ends turns.

    Attributes:
        slot: the same.
    """

    def __init__(self, roles: Roles, slot: float, worker: Worker) -> None:
        self.slot = slot
        self._roles, self._worker = roles, worker
        self._holder: int | None = None
        self._until = self._free_at = self._due = -math.inf
        self._told = -math.inf
        # The change that is told may still go on.
        connect([roles.changed], lambda: worker.post(self._look, latest_of=self))

    @property
    def left(self) -> float | None:
        """How long the turn may still last [s]; None when nobody has one."""
        if self._holder is None:
            return None
        return max(0.0, self._until - self._worker.clock.now())

    def waiting(self) -> dict[int, Waiting]:
        """Return the place of each client in the queue, and how long it takes."""
        now = self._worker.clock.now()
        begins = max(0.0, (self._until if self.left else self._free_at) - now)
        return {
            client_id: Waiting(place, begins + (place - 1) * self.slot)
            for place, client_id in enumerate(self._roles.queue(), 1)
        }

    def _look(self) -> None:
        """Pass control on when it is time; in the worker."""
        now, queue = self._worker.clock.now(), self._roles.queue()
        holder = self._roles.viewer_in_control()
        if holder != self._holder:
            self._free_at = now + PAUSE if holder is None else now
            self._holder, self._until = holder, now + self.slot
        is_over = now >= (self._free_at if holder is None else self._until)
        if queue and is_over:
            self._roles.pass_to(queue[0])
            return
        if not queue:
            return
        if now >= self._told + TOLD:
            self._told = now
            self._roles.changed.touch()
        ends = self._free_at if holder is None else self._until
        self._look_later(min(ends, now + TOLD))

    def _look_later(self, due: float) -> None:
        now = self._worker.clock.now()
        if now < self._due <= due:
            return
        self._due = due
        self._worker.post_later(due - now, self._look_in_time)

    def _look_in_time(self) -> None:
        self._due = -math.inf
        self._look()
