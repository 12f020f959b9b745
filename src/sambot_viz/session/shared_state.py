"""State with one lock and one audience: changed, sent and notified together."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from typing import Any, Literal, Protocol

import viser

from sambot_viz.session.worker import Worker

Event = Literal[
    "robot",
    "config",
    "frames",
    "joints",
    "motion",
    "status",
    "problems",
    "edits",
    "view",
    "tools",
    "people",
]
"""What has changed; "view" and "tools" are events of one browser, "motion" of how fast
the robot drives and what keeps turning, "people" of who is there and who drives."""
Listener = Callable[[Event], None]
"""Called after a change, with the lock held."""


class Audience(Protocol):
    """The browsers of a session: all of a viser server, or one viser client."""

    scene: viser.SceneApi
    gui: viser.GuiApi

    def flush(self) -> None:
        """Send waiting messages now."""

    def atomic(self) -> Any:
        """A context in which messages are held back and then sent together."""


class SharedState:
    """Base of `Session`: the lock, the listeners, and how a change is sent.

    Args:
        audience: who sees the state.
        worker: the thread that browsers, timers and files act in.

    Attributes:
        lock: the worker's; held while the state changes.
        listeners: called after each change.
    """

    def __init__(self, audience: Audience, worker: Worker) -> None:
        self.audience = audience
        self.worker = worker
        self.lock = worker.lock
        self.listeners: list[Listener] = []

    @contextmanager
    def change(self, *events: Event) -> Generator[None]:
        """Change state under the lock; send everything together; notify listeners."""
        with self.lock:
            with self.audience.atomic():
                yield
                self._before_sending()
                for event in events:
                    self.notify(event)
            self.audience.flush()

    def notify(self, event: Event) -> None:
        """Call the listeners; one that fails does not stop the others."""
        self.call(self.listeners, event)

    def call(self, listeners: Sequence[Listener], event: Event) -> None:
        """Call some listeners; one that fails does not stop the others."""
        for listener in tuple(listeners):
            try:
                listener(event)
            except Exception as error:
                self.worker.on_error(error)

    def _before_sending(self) -> None:
        """Finish a change; a subclass draws here what the change made outdated."""
