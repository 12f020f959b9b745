"""Hand messages to callbacks in a thread that never makes the reader wait.

A reader that waits fills the buffers of the bridge on the robot, and some of them grow
without limit. So everything is read at once, and what callbacks are too slow for is
dropped here: the oldest messages of the same topic, and they are counted.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from sambot_viz import limits
from sambot_viz.outlet import logger
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.source import OnMessage

LONGEST_STOP = 5.0
"""`stop` waits this long for the callback that is running [s]."""

_log = logger(__name__)


@dataclass(slots=True)
class _Waiting:
    """Messages of one topic that wait for delivery.

    `tickets` counts their places in the queue of all topics. A dropped message leaves
    its place to the next one of the topic, so that dropping costs no search.
    """

    messages: deque[Recorded] = field(default_factory=deque[Recorded])
    tickets: int = 0


@dataclass(slots=True)
class _Kept:
    """The messages of a topic for late subscribers; of one connection only."""

    connection: int
    messages: deque[Recorded]


class Delivery:
    """Calls the callbacks of topics, in the order in which messages came.

    Args:
        name: the name of the thread.

    Attributes:
        received: number of received messages of subscribed topics.
        dropped: number of those that were dropped because callbacks were too slow.
    """

    def __init__(self, name: str) -> None:
        self.received = self.dropped = 0
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._changed = threading.Condition()
        self._queue: deque[str | Callable[[], object]] = deque()
        self._waiting: dict[str, _Waiting] = {}
        self._size = 0
        # `_wanted` is what was asked for; `_callbacks` follows in the thread, so that
        # kept messages come before new ones.
        self._wanted: dict[str, tuple[OnMessage, ...]] = {}
        self._callbacks: dict[str, tuple[OnMessage, ...]] = {}
        self._kept: dict[str, _Kept] = {}
        self._connection = 0
        self._pending: set[Callable[[], object]] = set()
        self._failed: set[OnMessage] = set()
        self._is_stopped = False

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """Drop what waits and end the thread; may be called by a callback."""
        with self._changed:
            self._is_stopped = True
            self._queue.clear()
            self._waiting.clear()
            self._changed.notify()
        if self._thread.is_alive() and threading.current_thread() is not self._thread:
            self._thread.join(LONGEST_STOP)

    def wanted(self) -> frozenset[str]:
        """Return the subscribed topics."""
        with self._changed:
            return frozenset(self._wanted)

    def subscribe(
        self, topic: str, callback: OnMessage, on_kept: OnMessage | None = None
    ) -> None:
        """Add a callback, once; it gets the kept messages of the topic first."""
        with self._changed:
            present = self._wanted.get(topic, ())
            if callback not in present:
                self._wanted[topic] = (*present, callback)
                self._post(lambda: self._attach(topic, callback, on_kept or callback))

    def unsubscribe(self, topic: str, callback: OnMessage) -> None:
        """Remove a callback; the last one takes what waits and is kept along."""
        with self._changed:
            for table in (self._wanted, self._callbacks):
                left = tuple(one for one in table.get(topic, ()) if one != callback)
                table[topic] = left
                if not left:
                    del table[topic]
            if topic not in self._wanted:
                self._kept.pop(topic, None)
                if waiting := self._waiting.get(topic):
                    self._size -= sum(len(one.payload) for one in waiting.messages)
                    waiting.messages.clear()

    def forget(self) -> None:
        """Begin a new connection: its messages replace the kept ones."""
        with self._changed:
            self._connection += 1

    def put(self, message: Recorded) -> None:
        """Queue a message for the callbacks of its topic; returns at once."""
        with self._changed:
            if message.topic not in self._wanted or self._is_stopped:
                return
            self.received += 1
            waiting = self._waiting.setdefault(message.topic, _Waiting())
            waiting.messages.append(message)
            self._size += len(message.payload)
            while len(waiting.messages) > limits.WAITING.value or (
                self._size > limits.WAITING_BYTES.value and len(waiting.messages) > 1
            ):
                self._size -= len(waiting.messages.popleft().payload)
                self.dropped += 1
            if waiting.tickets < len(waiting.messages):
                waiting.tickets += 1
                self._queue.append(message.topic)
                self._changed.notify()

    def post(self, action: Callable[[], object]) -> None:
        """Run an action in the thread, after what came before; once if it waits."""
        with self._changed:
            if action not in self._pending:
                self._pending.add(action)
                self._post(action)

    def _post(self, action: Callable[[], object]) -> None:
        if not self._is_stopped:
            self._queue.append(action)
            self._changed.notify()

    def _run(self) -> None:
        while True:
            with self._changed:
                while not self._queue and not self._is_stopped:
                    self._changed.wait()
                if self._is_stopped:
                    return
                first = self._queue.popleft()
                if isinstance(first, str):
                    message, callbacks = self._take(first)
                else:
                    self._pending.discard(first)
                    message, callbacks = None, ()
            # No lock is held here: a callback may subscribe, or take its own lock
            # that another thread holds while it subscribes.
            if message is not None:
                for callback in callbacks:
                    self._call(callback, message)
            elif callable(first):
                self._act(first)

    def _take(self, topic: str) -> tuple[Recorded | None, tuple[OnMessage, ...]]:
        waiting = self._waiting[topic]
        waiting.tickets -= 1
        if not waiting.messages:
            return None, ()
        message = waiting.messages.popleft()
        self._size -= len(message.payload)
        kept = self._kept.get(topic)
        if kept is None or kept.connection != self._connection:
            limit = limits.LATCHED_KEPT.value if message.channel.is_latched else 1
            kept = _Kept(self._connection, deque(maxlen=limit))
            self._kept[topic] = kept
        kept.messages.append(message)
        return message, self._callbacks.get(topic, ())

    def _attach(self, topic: str, callback: OnMessage, on_kept: OnMessage) -> None:
        with self._changed:
            present = self._callbacks.get(topic, ())
            if callback not in self._wanted.get(topic, ()) or callback in present:
                return
            self._callbacks[topic] = (*present, callback)
            kept = self._kept.get(topic)
            messages = tuple(kept.messages) if kept else ()
        for message in messages:
            self._call(on_kept, message)

    def _call(self, callback: OnMessage, message: Recorded) -> None:
        try:
            callback(message)
        except Exception as error:
            # The others still get the message; a stream does not fill the log.
            if callback not in self._failed:
                self._failed.add(callback)
                _log.error("a message of %s: %s", message.topic, error, exc_info=error)

    def _act(self, action: Callable[[], object]) -> None:
        try:
            action()
        except Exception as error:
            _log.error("internal error: %s", error, exc_info=error)
