"""Plays a recording in a session, and is its clock meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Worker
from sambot_viz.sources.source import Playback
from sambot_viz.sources.subscriber import Subscriber

if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

LONGEST_STEP = 0.25
"""A busy machine makes the recording slower than real time, not jump [s]."""
SLOWEST, FASTEST = 0.01, 100.0
"""Rates of the player."""


@dataclass(frozen=True, slots=True)
class PlayerState:
    """The state of a player.

    Attributes:
        playing: whether the time goes on.
        rate: speed, relative to the recorded one.
        loop: whether it begins again at the end.
        time_ns: log time of the picture [ns]; while it plays, the time of its start.
    """

    playing: bool = False
    rate: float = 1.0
    loop: bool = False
    time_ns: int = 0


class Player:
    """Moves the time of a recording, and with it gives its messages to subscribers.

    A jump shows the recording at that time, also while paused. A paused player
    does nothing.

    Args:
        source: the recording, with a time of this session.
        draw: draws the messages that subscribers took; given whether the time jumped.
        change: sends the state of the player.
        worker: takes the steps.
        is_begun: whether a time was requested, which is shown until a user plays.

    Attributes:
        playback: the state; emitted when it changes, not at every step.
        stepped: emitted at every step while it plays.
        period: the time between two steps [s].
    """

    def __init__(
        self,
        source: Playback,
        draw: Callable[[bool], None],
        change: Change,
        worker: Worker,
        is_begun: bool = False,
    ) -> None:
        self.source = source
        self.playback = Signal(change, PlayerState(time_ns=self.time_ns))
        self.stepped = Signal(change, None)
        self.period = 1 / 30
        self._draw = draw
        self._change = change
        self._worker = worker
        self._last = 0.0
        self._ticking = False
        self._closed = False
        self._begun = is_begun

    @property
    def recording(self) -> Bag:
        """The messages."""
        return self.source.recording

    @property
    def start_ns(self) -> int:
        """The log time of the first message [ns]."""
        return self.source.start_ns

    @property
    def end_ns(self) -> int:
        """The log time of the last message [ns]."""
        return self.source.end_ns

    @property
    def time_ns(self) -> int:
        """The log time up to which messages were taken [ns]."""
        return self.source.time_ns

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
        """Play when the first page has opened, unless it was paused before."""
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
            self.source.seek(time_ns)
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
            time_ns = self.source.neighbour(topic, back=back)
            if time_ns is not None:
                self.jump(time_ns)

    def add(self, subscriber: Subscriber) -> None:
        """Give one more the messages, and at once those of the present time."""
        with self._change.lock:
            self.source.add(subscriber)

    def remove(self, subscriber: Subscriber) -> None:
        """Remove a subscriber."""
        with self._change.lock:
            self.source.remove(subscriber)

    def close(self) -> None:
        """Stop playing for good."""
        self._closed = True

    def resume(self) -> None:
        """Show the present time again, after another robot is shown."""
        self.jump(self.time_ns)

    def advance(self, seconds: float) -> None:
        """Let the time go on [s, of the recording]; this happens at every step."""
        with self._change.lock, self._change():
            self.source.advance(self.time_ns + round(seconds * 1e9))
            self._draw(False)
            self.stepped.touch()
            if self.time_ns >= self.end_ns:
                if self.playback.value.loop:
                    self.jump(self.start_ns)
                else:
                    self._tell(playing=False)

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
