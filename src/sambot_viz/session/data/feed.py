"""Where the messages of a session come from: its player, or a robot by itself."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from sambot_viz.session.data.player import Player
from sambot_viz.sources.source import OnMessage, Source
from sambot_viz.sources.subscriber import Subscriber


class Feed:
    """Gives subscribers their messages, whatever source has their topics.

    Args:
        source: as the session sees it.
        player: moves the time of what can seek; None without that.
    """

    def __init__(self, source: Source, player: Player | None) -> None:
        self.source = source
        self.player = player
        self._receivers: dict[Subscriber, tuple[OnMessage, dict[str, None]]] = {}

    def is_recorded(self, topic: str) -> bool:
        """Return whether the player has the messages of a topic."""
        return self.player is not None and topic in self.player.recording.topics

    def time_ns(self, topic: str) -> int:
        """Return the time of the source of a topic [ns]."""
        if self.player is not None and self.is_recorded(topic):
            return self.player.time_ns
        return self.source.clock_ns()

    def add(self, subscriber: Subscriber, receive: OnMessage) -> None:
        """Add a subscriber; it gets the recorded messages of this time at once.

        Args:
            subscriber: takes recorded messages, in the session's worker.
            receive: takes live messages, in the thread of their source.
        """
        if self.player is not None and not self._is_live(subscriber.topics):
            self.player.add(subscriber)
        self._receivers[subscriber] = (receive, {})
        self.listen(subscriber, subscriber.topics)

    def _is_live(self, topics: Collection[str]) -> bool:
        """Return whether no jump in a recording is a matter of some topics."""
        has_live = self.source.live is not None and bool(topics)
        return has_live and not any(map(self.is_recorded, topics))

    def listen(self, subscriber: Subscriber, topics: Iterable[str]) -> None:
        """Subscribe to the present topics of a subscriber, and to no others."""
        live = self.source.live
        if live is None:
            return
        receive, asked = self._receivers[subscriber]
        wanted = [topic for topic in topics if not self.is_recorded(topic)]
        for topic in wanted:
            if topic not in asked:
                asked[topic] = None
                live.subscribe(topic, receive)
        for topic in asked.keys() - set(wanted):
            del asked[topic]
            live.unsubscribe(topic, receive)

    def remove(self, subscriber: Subscriber) -> None:
        """Remove a subscriber."""
        if self.player is not None:
            self.player.remove(subscriber)
        receive, asked = self._receivers.pop(subscriber)
        for topic in asked:
            if self.source.live is not None:
                self.source.live.unsubscribe(topic, receive)
