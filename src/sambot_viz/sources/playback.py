"""A recording as a source: it has a time, and who owns it moves that."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from sambot_viz.errors import SourceError
from sambot_viz.files import LIVE_SOURCES
from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.sources.source import (
    Asset,
    Capability,
    Encoding,
    OnMessage,
    OnReply,
    Outgoing,
    OutgoingAction,
    SourceStatus,
    no_file,
)
from sambot_viz.sources.subscriber import Subscriber, jump, latched_until

_CAPABILITIES = frozenset[Capability](("topics", "subscribe", "latched", "seek"))


class RecordingPlayback:
    """Delivers the messages of a recording up to its time, as `source.Playback`.

    Nothing is read before the first subscription. Not thread-safe: callbacks are called
    in the thread that calls `advance`, `seek` or `subscribe`.

    Args:
        recording: the messages.
        uri: the user's name for it.
        at_ns: the log time to begin with; by default that of the first message [ns].

    Attributes:
        recording: as given.
        uri: as given.
        on_topics: as of `Source`.
        on_status: as of `Source`.
        start_ns: the log time of the first message [ns].
        end_ns: the log time of the last message [ns].
        time_ns: the log time up to which messages were delivered [ns].
    """

    has_clock = False
    hidden = ()
    live = None

    def __init__(self, recording: Bag, uri: str, at_ns: int | None = None) -> None:
        self.recording = recording
        self.uri = uri
        self.on_topics: Callable[[], object] = lambda: None
        self.on_status: Callable[[], object] = lambda: None
        # Asked at every step; a recording looks through all its parts for them.
        self.start_ns = recording.start_ns or 0
        self.end_ns = recording.end_ns or 0
        self.time_ns = self.start_ns if at_ns is None else at_ns
        self._owns = True
        self._is_closed = False
        self._subscribers: tuple[Subscriber, ...] = ()
        self._coming: Iterator[Recorded] | None = None
        self._next: Recorded | None = None

    def open(self) -> None:
        """Do nothing: a recording is open from the start."""

    def close(self) -> None:
        """Hand on no more, and close the files; those of a session leave them open."""
        self._is_closed = True
        self._subscribers = ()
        self._forget_coming()
        if self._owns:
            self.recording.close()

    def of_session(self) -> RecordingPlayback:
        """Return the same recording with an independent time."""
        made = RecordingPlayback(self.recording, self.uri, self.time_ns)
        made._owns = False
        return made

    @property
    def status(self) -> SourceStatus:
        """Whether it is open."""
        sentence = f"{self.uri} is closed" if self._is_closed else ""
        return SourceStatus(not self._is_closed, sentence, session=1)

    @property
    def capabilities(self) -> frozenset[Capability]:
        """The capabilities of a recording."""
        return _CAPABILITIES

    @property
    def playback(self) -> RecordingPlayback:
        """Itself."""
        return self

    def topics(self) -> Mapping[str, SourceTopic]:
        """Return the topics by name; those of a growing recording become more."""
        return self.recording.topics

    def clock_ns(self) -> int:
        """Return the log time up to which messages were handed on [ns]."""
        return self.time_ns

    def fetch_asset(self, uri: str) -> Asset:
        """Refuse: a recording has messages alone."""
        return no_file(f"{self.uri} has no files, and not {uri}")

    def advertise(self, topic: str, type_name: str) -> Outgoing:
        """Refuse: what was recorded is over.

        Raises:
            SourceError: always.
        """
        raise self._is_over()

    def call(
        self, service: str, write: Callable[[Encoding], bytes], answered: OnReply
    ) -> None:
        """Refuse, as `advertise` does."""
        raise self._is_over()

    def action(self, name: str, type_name: str) -> OutgoingAction:
        """Refuse, as `advertise` does."""
        raise self._is_over()

    def _is_over(self) -> SourceError:
        return SourceError(
            f"{self.uri} is a recording, and nothing can be sent to it: name a live "
            f"robot with --source {LIVE_SOURCES}"
        )

    def subscribe(
        self, topic: str, callback: OnMessage, on_kept: OnMessage | None = None
    ) -> None:
        """Call back with each message of a topic; see `Source.subscribe`."""
        if not any(one.is_of(topic, callback) for one in self._callbacks()):
            self.add(_Callback(topic, callback, on_kept or callback))

    def unsubscribe(self, topic: str, callback: OnMessage) -> None:
        """No longer call back."""
        for one in [one for one in self._callbacks() if one.is_of(topic, callback)]:
            self.remove(one)

    # What seek means

    def add(self, subscriber: Subscriber) -> None:
        """Give one more the messages, and at once those of the present time."""
        if self._is_closed:
            return
        self._subscribers = (*self._subscribers, subscriber)
        self._forget_coming()
        jump(self.recording, self.time_ns, (subscriber,))

    def remove(self, subscriber: Subscriber) -> None:
        """Remove a subscriber."""
        kept = (one for one in self._subscribers if one is not subscriber)
        self._subscribers = tuple(kept)
        self._forget_coming()

    def seek(self, time_ns: int) -> None:
        """Go to the time of the recording nearest to a log time [ns].

        Subscribers get what holds there, as if it had been played to that time.
        """
        self.time_ns = min(max(time_ns, self.start_ns), self.end_ns)
        self._forget_coming()
        jump(self.recording, self.time_ns, self._subscribers)

    def advance(self, until_ns: int) -> None:
        """Hand on the messages up to a log time [ns], at most the end."""
        until_ns = min(until_ns, self.end_ns)
        while (message := self._peek()) is not None and message.log_ns <= until_ns:
            self._next = None
            for one in self._subscribers:
                if message.topic in one.topics:
                    one.take(message)
        self.time_ns = max(self.time_ns, until_ns)

    def neighbour(self, topic: str | None, *, back: bool = False) -> int | None:
        """Return the log time of the next message of a topic, or of the last [ns].

        Args:
            topic: its name; None for any subscribed topic.
            back: whether to look before the present time, not after it.
        """
        wanted = self._wanted() if topic is None else (topic,)
        find = self.recording.previous if back else self.recording.next
        found = [m for m in (find(name, self.time_ns) for name in wanted) if m]
        times = [message.log_ns for message in found]
        return (max if back else min)(times, default=None)

    def _callbacks(self) -> list[_Callback]:
        return [one for one in self._subscribers if isinstance(one, _Callback)]

    def _forget_coming(self) -> None:
        self._coming = self._next = None

    def _peek(self) -> Recorded | None:
        if not self._subscribers:
            return None
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


class _Callback:
    """A subscriber that takes messages one by one, and no jumps."""

    always: Sequence[str] = ()

    def __init__(self, topic: str, callback: OnMessage, on_kept: OnMessage) -> None:
        self.topics = (topic,)
        self._callback = callback
        self._on_kept = on_kept

    def is_of(self, topic: str, callback: OnMessage) -> bool:
        """Return whether it was made for a topic and a callback."""
        return self.topics == (topic,) and self._callback == callback

    def until(self, recording: Bag, at_ns: int) -> Iterable[Recorded]:
        """Deliver the messages for a late subscriber, and return none to take."""
        kept = latched_until(recording, self.topics, at_ns)
        last = recording.last(self.topics[0], at_ns) if not kept else None
        for message in kept if last is None else (last,):
            self._on_kept(message)
        return ()

    def take(self, message: Recorded) -> None:
        """Call back."""
        self._callback(message)

    def clear(self) -> None:
        """Do nothing: what was called back is not taken back."""
