"""Plays a recording in a session, and is its clock meanwhile."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Worker
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.subscriber import Subscriber, jump

if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

LONGEST_STEP = 0.25
"""A busy machine makes the recording slower than real time, not jump [s]."""
SLOWEST, FASTEST = 0.01, 100.0
"""Rates of the player."""


@dataclass(frozen=True, slots=True)
class Playback:
    """What a player does.

    Attributes:
        playing: whether the time goes on.
        rate: how much faster than it was recorded.
        loop: whether it begins again at the end.
        time_ns: log time of the picture [ns]; while it plays, when it began to.
    """

    playing: bool = False
    rate: float = 1.0
    loop: bool = False
    time_ns: int = 0


class Player:
    """Gives the messages of a recording to subscribers as time goes on.

    A jump shows what the recording had at that time, also while paused. A paused player
    does nothing.

    Args:
        recording: its messages.
        subscribers: take them.
        draw: shows what subscribers have taken; told whether the time has jumped.
        change: tells what the player does.
        worker: takes the steps.
        at_ns: the log time to begin with; the first one by default [ns].

    Attributes:
        playback: what it does; told when that changes, not at every step.
        stepped: told at every step while it plays.
        period: the time between two steps [s].
        start_ns: the log time of the first message [ns].
        end_ns: the log time of the last message [ns].
        time_ns: the log time up to which messages were taken [ns].
    """

    def __init__(
        self,
        recording: Bag,
        subscribers: Sequence[Subscriber],
        draw: Callable[[bool], None],
        change: Change,
        worker: Worker,
        at_ns: int | None = None,
    ) -> None:
        self.recording = recording
        # Asked at every step; a recording looks through all its parts for them.
        self.start_ns = recording.start_ns or 0
        self.end_ns = recording.end_ns or 0
        self.time_ns = self.start_ns if at_ns is None else at_ns
        self.playback = Signal(change, Playback(time_ns=self.time_ns))
        self.stepped = Signal(change, None)
        self.period = 1 / 30
        self._subscribers = tuple(subscribers)
        self._draw = draw
        self._change = change
        self._worker = worker
        self._coming: Iterator[Recorded] | None = None
        self._next: Recorded | None = None
        self._last = 0.0
        self._ticking = False
        self._closed = False
        # Whoever asks for a time wants to see that.
        self._begun = at_ns is not None

    def play(self) -> None:
        """Let the time go on; at the end, begin again."""
        with self._change.lock:
            self._begun = True
            if self.time_ns >= self.end_ns:
                self.jump(self.start_ns)
            self._tell(playing=True)
            if not self._ticking and not self._closed:
                self._ticking = True
                self._last = self._worker.clock.now()
                self._worker.post_later(self.period, self._step)

    def begin(self) -> None:
        """Play when the first page is there, unless somebody has stopped it before."""
        if not self._begun:
            self.play()

    def pause(self) -> None:
        """Stop the time."""
        with self._change.lock:
            self._begun = True
            self._tell(playing=False)

    def set_rate(self, rate: float) -> None:
        """Play faster or slower than it was recorded."""
        with self._change.lock:
            self._tell(rate=min(max(rate, SLOWEST), FASTEST))

    def set_loop(self, loop: bool) -> None:
        """Begin again at the end, or not."""
        with self._change.lock:
            self._tell(loop=loop)

    def jump(self, time_ns: int) -> None:
        """Show the time of the recording nearest to a log time [ns]."""
        with self._change.lock, self._change():
            time_ns = min(max(time_ns, self.start_ns), self.end_ns)
            self._coming = self._next = None
            jump(self.recording, time_ns, self._subscribers)
            self.time_ns = time_ns
            self._draw(True)
            self._tell()

    def step(self, topic: str | None, *, back: bool = False) -> None:
        """Pause, and show the next or the last message of a topic.

        Args:
            topic: its name; None for any that is shown.
            back: to the one before.
        """
        with self._change.lock:
            self._tell(playing=False)
            wanted = self._wanted() if topic is None else (topic,)
            find = self.recording.previous if back else self.recording.next
            found = [m for m in (find(name, self.time_ns) for name in wanted) if m]
            if found:
                times = [message.log_ns for message in found]
                self.jump(max(times) if back else min(times))

    def add(self, subscriber: Subscriber) -> None:
        """Give one more the messages, and at once those of the present time."""
        with self._change.lock:
            self._subscribers = (*self._subscribers, subscriber)
            self._coming = self._next = None
            jump(self.recording, self.time_ns, (subscriber,))

    def remove(self, subscriber: Subscriber) -> None:
        """Give one that was added no more messages."""
        with self._change.lock:
            kept = (one for one in self._subscribers if one is not subscriber)
            self._subscribers = tuple(kept)
            self._coming = self._next = None

    def close(self) -> None:
        """Play nothing any more."""
        self._closed = True

    def resume(self) -> None:
        """Show the present time again, after another robot is shown."""
        self.jump(self.time_ns)

    def advance(self, seconds: float) -> None:
        """Let the time go on [s, of the recording]; this happens at every step."""
        with self._change.lock, self._change():
            until = min(self.time_ns + round(seconds * 1e9), self.end_ns)
            while (message := self._peek()) is not None and message.log_ns <= until:
                self._next = None
                for one in self._subscribers:
                    if message.topic in one.topics:
                        one.take(message)
            self.time_ns = until
            self._draw(False)
            self.stepped.touch()
            if until >= self.end_ns:
                if self.playback.value.loop:
                    self.jump(self.start_ns)
                else:
                    self._tell(playing=False)

    def _peek(self) -> Recorded | None:
        if self._coming is None:
            self._coming = self.recording.messages(
                self.time_ns + 1, None, self._wanted()
            )
        if self._next is None:
            self._next = next(self._coming, None)
        return self._next

    def _wanted(self) -> tuple[str, ...]:
        names = [topic for one in self._subscribers for topic in one.topics]
        return tuple(dict.fromkeys(n for n in names if n in self.recording.topics))

    def _step(self) -> None:
        now = self._worker.clock.now()
        passed, self._last = min(now - self._last, LONGEST_STEP), now
        self._ticking = False
        playback = self.playback.value
        if self._closed or not playback.playing:
            return
        try:
            self.advance(passed * playback.rate)
        except Exception:
            self._tell(playing=False)
            raise
        if self.playback.value.playing:
            self._ticking = True
            self._worker.post_later(self.period, self._step)

    def _tell(self, **changes: object) -> None:
        self.playback.set(replace(self.playback.value, time_ns=self.time_ns, **changes))
