"""Values with listeners, and changes that are sent before their listeners are called.

A part of a session reports its changes through signals. A panel listens only to the
signals of the facts that it shows, so the listeners tell the cost of a step.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager
from typing import Any, Generic, Protocol, TypeVar

import viser

from sambot_viz.session.worker import Worker

T = TypeVar("T")
Listener = Callable[[], object]
"""Called after a change was sent, with the session locked."""


class Audience(Protocol):
    """The clients that see a session: all of a viser server, or one viser client."""

    scene: viser.SceneApi
    gui: viser.GuiApi

    def flush(self) -> None:
        """Send waiting messages now."""

    def atomic(self) -> Any:
        """A context in which messages are held back and then sent together."""


class Change:
    """Changes the state of a session: under one lock, sent together, then emitted.

    ::

        with change(displays.listed, scene.statuses):
            ...

    Args:
        worker: its lock is held meanwhile; it reports errors of listeners.
        audience: the viser clients that get the changes.

    Attributes:
        lock: the worker's; held while the state changes.
        finish: called before a change is sent, to redraw outdated parts.
    """

    def __init__(self, worker: Worker, audience: Audience) -> None:
        self.lock = worker.lock
        self.finish: Callable[[], None] = _nothing
        self._worker = worker
        self._audience = audience
        self._depth = 0
        # In the order in which they were marked; each is emitted once.
        self._marked: dict[Signal[Any], None] = {}

    @contextmanager
    def __call__(self, *signals: Signal[Any]) -> Generator[None]:
        """Change state in the block; a nested change is sent with the outer one.

        Args:
            signals: emitted at the end, unless the change fails.
        """
        with self.lock:
            self._depth += 1
            try:
                with self._audience.atomic():
                    yield
                    self.mark(*signals)
                    if self._depth == 1:
                        self.finish()
            finally:
                self._depth -= 1
                if self._depth == 0:
                    self._audience.flush()
                    self._tell()

    def mark(self, *signals: Signal[Any]) -> None:
        """Tell of some signals after the present change, or now when there is none."""
        with self.lock:
            self._marked.update(dict.fromkeys(signals))
            if self._depth == 0:
                self._tell()

    def _tell(self) -> None:
        # A listener may change something itself: its signals are told in between.
        marked, self._marked = self._marked, {}
        first = [one for signal in marked for one in signal.listeners]
        last = [one for signal in marked for one in signal.senders]
        for listener in dict.fromkeys(first + last):
            try:
                listener()
            except Exception as error:
                # A failing listener does not stop the others.
                self._worker.report(error)


class Signal(Generic[T]):
    """A value with listeners.

    A listener of several signals that one change has marked is called once.

    Args:
        change: sends a change of the value, before the listeners are told.
        value: the first one.

    Attributes:
        listeners: called after a change.
        senders: called after all listeners, to send what those have noted.
    """

    def __init__(self, change: Change, value: T) -> None:
        self.listeners: list[Listener] = []
        self.senders: list[Listener] = []
        self._change = change
        self._value = value

    @property
    def value(self) -> T:
        """The value as it is now."""
        return self._value

    def set(self, value: T) -> None:
        """Set the value; setting the same one calls no listener."""
        if value != self._value:
            self._value = value
            self._change.mark(self)

    def touch(self) -> None:
        """Tell that something in the value has changed."""
        self._change.mark(self)


def connect(
    signals: Iterable[Signal[Any]], listener: Listener, *, sends: bool = False
) -> Callable[[], None]:
    """Call a listener after a change of any of these.

    Args:
        signals: what it shows.
        listener: called once for a change of several.
        sends: whether it is called after those that do not send.

    Returns:
        What ends that.
    """
    lists = [signal.senders if sends else signal.listeners for signal in signals]
    for listeners in lists:
        listeners.append(listener)

    def disconnect() -> None:
        for listeners in lists:
            listeners.remove(listener)

    return disconnect


class Listening:
    """Listens to the signals of a set that changes, and to no others.

    Args:
        listener: called after a change of any of them.
        sends: as for `connect`.
    """

    def __init__(self, listener: Listener, *, sends: bool = False) -> None:
        self._listener = listener
        self._sends = sends
        self._signals: tuple[Signal[Any], ...] = ()
        self._disconnect: Callable[[], None] = _nothing

    def to(self, *signals: Signal[Any]) -> None:
        """Listen to these instead of those before."""
        if signals != self._signals:
            self._disconnect()
            self._signals = signals
            self._disconnect = connect(signals, self._listener, sends=self._sends)


def _nothing() -> None:
    pass
