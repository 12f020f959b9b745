"""Messages that wait in zenoh until the loop takes them.

A thread of zenoh that hands each message to Python waits for Python's lock each time:
with a thousand in a second that costs more than the messages do.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from sambot_viz import limits

_TOGETHER = 0.008
"""Messages that come within this time are taken together [s]."""
_LONGEST_PAUSE = 0.04
"""Between two looks where nothing comes [s]."""
_GROWTH = 1.1
"""Each such pause is longer than the last one: what comes ten times a second and more
has none."""
_MOST_WAITING = 4000
"""Messages of a subscriber until they are taken: far more than can be handed on, which
counts those that it drops. The oldest give way."""

OnSample = Callable[[str, bytes, bytes], object]
"""Called with the key, the payload and the attachment."""


@dataclass(frozen=True, slots=True, eq=False)
class ZenohReading:
    """A subscriber of zenoh, and the receiver of its messages."""

    subscriber: Any
    take: OnSample
    on_large: Callable[[int], object]
    ended: Callable[[ZenohReading], object]

    def undeclare(self) -> None:
        """Read no longer."""
        self.ended(self)
        self.subscriber.undeclare()


class ZenohReadings:
    """Takes what has come of all subscribers, in the loop in which they are added."""

    def __init__(self) -> None:
        # In the order in which they were added.
        self._readings: dict[ZenohReading, None] = {}
        self._pause = _TOGETHER
        self._is_looking = False

    def add(
        self, subscriber: Any, take: OnSample, on_large: Callable[[int], object]
    ) -> ZenohReading:
        """Read from now on.

        Args:
            subscriber: of zenoh; its messages wait in a `waiting_room`.
            take: gets them.
            on_large: gets the size of those that are too large [bytes].
        """
        reading = ZenohReading(subscriber, take, on_large, self._discard)
        self._readings[reading] = None
        self._pause = _TOGETHER
        if not self._is_looking:
            self._is_looking = True
            self._plan()
        return reading

    def clear(self) -> None:
        """Stop reading for good."""
        self._readings.clear()

    def _discard(self, reading: ZenohReading) -> None:
        self._readings.pop(reading, None)

    def _plan(self) -> None:
        asyncio.get_running_loop().call_later(self._pause, self._look)

    def _look(self) -> None:
        if not self._readings:
            self._is_looking = False
            return
        found = [(one, self._taken(one)) for one in self._readings]
        has_come = any(samples for _, samples in found)
        longer = min(self._pause * _GROWTH, _LONGEST_PAUSE)
        self._pause = _TOGETHER if has_come else longer
        self._plan()
        for reading, samples in found:
            for sample in samples:
                self._hand_on(reading, sample)

    @staticmethod
    def _taken(reading: ZenohReading) -> list[Any]:
        found: list[Any] = []
        # No more than wait there: they may come faster than they are taken.
        for _ in range(_MOST_WAITING):
            if (sample := reading.subscriber.try_recv()) is None:
                break
            found.append(sample)
        return found

    @staticmethod
    def _hand_on(reading: ZenohReading, sample: Any) -> None:
        size = len(sample.payload)
        if size > limits.MESSAGE.value:
            reading.on_large(size)
        else:
            reading.take(*content_of(sample))


def waiting_room(most: int = _MOST_WAITING) -> Any:
    """Return where the messages of a subscriber wait, at most so many."""
    import zenoh

    library: Any = zenoh
    return library.handlers.RingChannel(most)


def content_of(sample: Any) -> tuple[str, bytes, bytes]:
    """Return the key of a message, its payload and its attachment."""
    attached = sample.attachment
    return (
        str(sample.key_expr),
        bytes(sample.payload),
        b"" if attached is None else bytes(attached),
    )


def at_once(callback: Callable[[Any], object]) -> Any:
    """Return a handler that is called without a Python thread of its own."""
    import zenoh

    library: Any = zenoh
    return library.handlers.Callback(callback, indirect=False)


def in_a_thread(
    ended: Callable[[], object], answered: Callable[[Any], object] = lambda _: None
) -> Any:
    """Return a handler that calls back, in a thread, also when nothing more comes.

    At its end zenoh holds a lock, for which `is_closed` waits with that of Python.
    """
    import zenoh

    library: Any = zenoh
    return library.handlers.Callback(answered, ended, indirect=True)
