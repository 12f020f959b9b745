"""Readers and writers of DDS, and the QoS that they ask for or offer."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Any

from sambot_viz.sources.dds import raw
from sambot_viz.sources.qos import Qos

_LONGEST_WRITE = 10_000_000
"""A writer whose readers are slow waits this long, with all threads of Python [ns]."""
DEPTH = 10
"""Number of messages kept for a reader that is slow, or not found yet."""
_LOOK = 0.02
"""Between two looks whether a reader is found [s]."""
SETTLED = 0.1
"""The other side finds this one as late after it was found [s]."""
_PATIENCE = 3.0
"""Time that the first messages of a new writer wait for a reader [s]."""


class DdsReader:
    """A reader of a topic, until it is closed."""

    def __init__(self, reader: Any, on_closed: Callable[[], object]) -> None:
        self._reader: Any = reader
        self._on_closed = on_closed

    @property
    def is_matched(self) -> bool:
        """Whether a writer is connected to it."""
        return bool(self._reader.get_matched_publications())

    def close(self) -> None:
        """Subscribe no longer."""
        self._on_closed()
        self._reader = None


class DdsPublisher:
    """A writer of a topic, until it is closed.

    DDS drops messages that are written before both sides have discovered each other, so
    the first ones wait a moment.

    Attributes:
        id: identifies the writer to all participants.
    """

    def __init__(self, writer: Any, on_closed: Callable[[bytes], object]) -> None:
        self._writer: Any = writer
        self._on_closed = on_closed
        self.id: bytes = writer.guid.bytes
        self._waiting: deque[bytes] | None = deque(maxlen=DEPTH)
        self._loop = asyncio.get_running_loop()
        self._look(self._loop.time() + _PATIENCE)

    def put(self, message: bytes) -> None:
        """Publish CDR with its header."""
        if self._waiting is None:
            raw.write(self._writer, message)
        else:
            self._waiting.append(message)

    def close(self) -> None:
        """Publish nothing more."""
        self._on_closed(self.id)
        self._writer = None

    def _look(self, due: float) -> None:
        if self._writer is None:
            return
        if self._loop.time() > due:
            self._begin()
        elif self._writer.get_matched_subscriptions():
            self._loop.call_later(SETTLED, self._begin)
        else:
            self._loop.call_later(_LOOK, self._look, due)

    def _begin(self) -> None:
        waiting, self._waiting = self._waiting or (), None
        for message in waiting:
            if self._writer is not None:
                raw.write(self._writer, message)


def policies(qos: Qos, depth: int, said: str = "") -> Any:
    """Return a QoS for cyclonedds.

    Args:
        qos: the QoS in ROS's terms.
        depth: depth of the history.
        said: user data that is announced with it.
    """
    import cyclonedds.qos

    library: Any = cyclonedds.qos
    policy = library.Policy
    is_safe = qos.reliability != "best_effort"
    is_kept = qos.durability == "transient_local"
    made = [
        policy.Reliability.Reliable(_LONGEST_WRITE)
        if is_safe
        else policy.Reliability.BestEffort,
        policy.Durability.TransientLocal if is_kept else policy.Durability.Volatile,
        policy.History.KeepLast(depth),
        # Ignore our own messages.
        policy.IgnoreLocal.Participant,
    ]
    if said:
        made.append(policy.Userdata(said.encode()))
    return library.Qos(*made)
