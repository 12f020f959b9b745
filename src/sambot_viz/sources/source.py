"""What every live source is: one connection to a robot, for all browsers.

A source hands on messages as bytes; it neither decodes nor draws. Its callbacks run in
one thread of the source, one after the other, and must only post.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Protocol

from sambot_viz.messages import Schema
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.qos import Qos

OnMessage = Callable[[Recorded], object]


@dataclass(frozen=True, slots=True)
class SourceTopic:
    """A topic of a recording or of a live robot.

    Attributes:
        name: as the file or the peer writes it.
        schema: the definition of its messages, that of the first channel when several
            differ; its name may be empty.
        message_encoding: "cdr", "ros1", "json", … or ""; of the first channel.
        qos: what its publishers offer, None when that is not said.
        is_latched: late subscribers get its messages, as far as that can be known; in
            a recording they hold at any time, see `bag/latched.py`.
        publishers: their names, how many they are, or None when that is not said.
        reason: why it cannot be read, with the remedy; None if it may be read.
        count: how many messages a recording has that can be read; None while that is
            not known, and of a live robot.
        left_out: what of a recording cannot be read, and why; empty for nothing.
    """

    name: str
    schema: Schema
    message_encoding: str
    qos: Qos | None = None
    is_latched: bool = False
    publishers: tuple[str, ...] | int | None = None
    reason: str | None = None
    count: int | None = None
    left_out: str = ""


@dataclass(frozen=True, slots=True)
class SourceStatus:
    """How a source is.

    Attributes:
        is_connected: messages can come.
        sentence: for the page: what is, what is missing and the remedy.
        retry_s: length of the pause before the next attempt [s], None if there is none.
        lag_s: how much later than at best the newest messages came [s], None when that
            cannot be known.
        dropped: messages that came and were dropped, since callbacks were too slow.
        unreadable: frames of the peer that made no sense.
        session: grows when the peer starts again; what came before is of another run.
    """

    is_connected: bool = False
    sentence: str = ""
    retry_s: float | None = None
    lag_s: float | None = None
    dropped: int = 0
    unreadable: int = 0
    session: int = 0


class Source(Protocol):
    """A connection to a robot that is made again when it is lost.

    Attributes:
        uri: as the user wrote it.
        on_topics: called when `topics` has changed.
        on_status: called when `status` has changed; counters at most twice a second.
    """

    uri: str
    on_topics: Callable[[], object]
    on_status: Callable[[], object]

    def open(self) -> None:
        """Begin to connect; returns at once."""
        ...

    def close(self) -> None:
        """End the connection and the threads; a callback may call it, too."""
        ...

    @property
    def status(self) -> SourceStatus:
        """How the source is now."""
        ...

    @property
    def capabilities(self) -> frozenset[str]:
        """What the peer can do: "assets", "parameters", "time", …."""
        ...

    def topics(self) -> Mapping[str, SourceTopic]:
        """Return the topics by name; those of the last connection if there is none."""
        ...

    def subscribe(
        self, topic: str, callback: OnMessage, on_kept: OnMessage | None = None
    ) -> None:
        """Call back with each message of a topic, which need not exist yet.

        The same pair a second time changes nothing. When others have it already, the
        messages that a late subscriber of ROS would get come first: all of latched
        topics, the last one of others.

        Args:
            topic: its name.
            callback: gets the messages.
            on_kept: gets those that came before; by default the callback does.
        """
        ...

    def unsubscribe(self, topic: str, callback: OnMessage) -> None:
        """No longer call back; a call that has begun goes on."""
        ...

    @property
    def has_clock(self) -> bool:
        """Whether the peer has told its time, as that of a simulation."""
        ...

    def clock_ns(self) -> int:
        """Return the time at the peer [ns]: simulated where it says so."""
        ...

    def fetch_asset(self, uri: str) -> Future[bytes]:
        """Ask for a file, such as package://sam_bot/meshes/a.stl.

        The result raises `SourceError` with the peer's own text when it is refused.
        """
        ...
