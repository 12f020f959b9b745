"""A live robot whose topics and frames have other names here."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sambot_viz.sources.action_names import action_of, status_topic
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.sources.prefix import NO_NAMES, Prefix
from sambot_viz.sources.source import (
    Asset,
    Capability,
    Encoding,
    OnMessage,
    OnReply,
    Outgoing,
    OutgoingAction,
    Source,
    SourceStatus,
)


class PrefixedSource:
    """Hands on what another source has, under other names; see `Source`.

    Args:
        source: a live robot.
        prefix: before its topics and frames; "" for none.
        remaps: topics with other names there (see `Prefix`).
    """

    playback = None
    hidden = ()

    def __init__(
        self, source: Source, prefix: str, remaps: Mapping[str, str] = NO_NAMES
    ) -> None:
        self.uri = source.uri
        self.on_topics: Callable[[], object] = lambda: None
        self._source = source
        self._prefix = Prefix(prefix, remaps)
        self._topics: Mapping[str, SourceTopic] = {}
        self._renaming: dict[tuple[str, OnMessage], OnMessage] = {}
        self.on_status: Callable[[], object] = lambda: None
        source.on_topics = self._look
        source.on_status = lambda: self.on_status()

    def open(self) -> None:
        """Begin to connect; returns at once."""
        self._source.open()

    def close(self) -> None:
        """End the connection; may be called twice."""
        self._source.close()

    def clock_ns(self) -> int:
        """Return the time at the peer [ns]."""
        return self._source.clock_ns()

    def fetch_asset(self, uri: str) -> Asset:
        """Ask for a file."""
        return self._source.fetch_asset(uri)

    def advertise(self, topic: str, type_name: str) -> Outgoing:
        """Begin to publish a topic; see `Source.advertise`."""
        made = self._source.advertise(self._prefix.inner(topic), type_name)
        made.frame_prefix = self._prefix.name
        return made

    def call(
        self, service: str, write: Callable[[Encoding], bytes], answered: OnReply
    ) -> None:
        """Call a service; see `Source.call`."""
        self._source.call(self._prefix.inner(service), write, answered)

    def action(self, name: str, type_name: str) -> OutgoingAction:
        """Return an action; see `Source.action`."""
        inner = action_of(self._prefix.inner(status_topic(name)))
        made = self._source.action(inner, type_name)
        made.frame_prefix = self._prefix.name
        return made

    def of_session(self) -> Source:
        """Return it: one connection serves all sessions."""
        return self

    @property
    def live(self) -> Source:
        """Itself."""
        return self

    @property
    def status(self) -> SourceStatus:
        """How the source is now."""
        return self._source.status

    @property
    def capabilities(self) -> frozenset[Capability]:
        """What it can do."""
        return self._source.capabilities

    @property
    def has_clock(self) -> bool:
        """Whether the peer has told its time."""
        return self._source.has_clock

    def topics(self) -> Mapping[str, SourceTopic]:
        """Return the topics by their names among other sources."""
        return self._topics

    def subscribe(
        self, topic: str, callback: OnMessage, on_kept: OnMessage | None = None
    ) -> None:
        """Call back with each message of a topic; see `Source.subscribe`."""
        if (topic, callback) in self._renaming:
            return
        renaming = self._renaming[topic, callback] = self._renamed(callback)
        kept = None if on_kept is None else self._renamed(on_kept)
        self._source.subscribe(self._prefix.inner(topic), renaming, kept)

    def unsubscribe(self, topic: str, callback: OnMessage) -> None:
        """No longer call back."""
        renaming = self._renaming.pop((topic, callback), None)
        if renaming is not None:
            self._source.unsubscribe(self._prefix.inner(topic), renaming)

    def _renamed(self, callback: OnMessage) -> OnMessage:
        def receive(message: Recorded) -> None:
            callback(self._prefix.message(message))

        return receive

    def _look(self) -> None:
        self._topics = self._prefix.topics(self._source.topics())
        self.on_topics()
