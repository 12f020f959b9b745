"""The protocol over one connection, without the socket.

A conversation takes the frames of its peer and queues its own. A new connection begins
a new conversation, so that no id of the old one can be used again.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

from sambot_viz.sources.live.address import Address
from sambot_viz.sources.live.assets import AssetStore
from sambot_viz.sources.live.clock import SourceClock
from sambot_viz.sources.live.followed_goal import FollowedGoals
from sambot_viz.sources.live.outgoing_topic import TopicSender
from sambot_viz.sources.live.service_calls import ServiceCalls
from sambot_viz.sources.message import Recorded, SourceTopic, too_large
from sambot_viz.sources.source import Capability, OutgoingAction, Source
from sambot_viz.text import text

_LATE = 1.0
"""The smallest lag that is reported [s]."""


_MOST_LARGE = 100
"""Topics with messages that are too large are counted up to this many."""
_MOST_SAID = 3


@dataclass(slots=True)
class LargeMessages:
    """How many messages of a topic were too large, and the largest [bytes]."""

    count: int = 0
    largest: int = 0


@dataclass(frozen=True, slots=True)
class Ends:
    """The objects that a conversation uses; they outlive the connection.

    Attributes:
        address: the address of the peer.
        send: queues a frame for the peer.
        put: delivers a message to the subscribers.
        clock: computes the peer's time.
        assets: files of the peer.
        post: schedules a call in the thread of the connection.
        session_id: the id of the last conversation; None before the first.
    """

    address: Address
    send: Callable[[str | bytes], None]
    put: Callable[[Recorded], None]
    clock: SourceClock
    assets: AssetStore
    post: Callable[[Callable[[], object]], object]
    session_id: str | None = None


class Conversation(TopicSender):
    """One connection's state; all methods are called in one thread.

    Attributes:
        is_ready: the peer has said enough that messages can come.
        server: name of the server; from the peer, not cleaned.
        session_id: of this run of the server, None if it does not tell.
        capabilities: what the peer can do.
        topics_changed: set here, cleared by who has asked for `topics`.
        unreadable: frames that made no sense.
        large: topic → sizes of its messages that were too large [bytes]; that of "" is
            not known.
        calls: of services of the peer.
        goals: that were sent over this connection.
    """

    calls: ServiceCalls

    def __init__(self, ends: Ends) -> None:
        self.ends = ends
        self.is_ready = False
        self.server = ""
        self.session_id: str | None = None
        self.capabilities: frozenset[str] = frozenset()
        self.topics_changed = False
        self.unreadable = 0
        self.large: dict[str, LargeMessages] = {}
        self.is_over = False
        self.goals = FollowedGoals()

    @abstractmethod
    def begin(self) -> None:
        """Say what comes first."""

    @abstractmethod
    def receive(self, frame: str | bytes) -> None:
        """Take a frame of the peer.

        Raises:
            WrongServer: the peer speaks another protocol.
            NewSession: the peer has started again; a new connection is needed.
        """

    @abstractmethod
    def topic_of(self, head: bytes) -> str:
        """Return the topic of a message by its first bytes; "" when they do not say."""

    def leave_out(self, head: bytes, size: int, is_new: bool) -> None:
        """Record a message that was too large to be read.

        Args:
            head: its first bytes.
            size: its size as far as known [bytes].
            is_new: whether it was not recorded before.
        """
        topic = self.topic_of(head)
        known = self.large.get(topic)
        if known is None and len(self.large) >= _MOST_LARGE:
            return
        if known is None:
            known = self.large[topic] = LargeMessages()
        self.topics_changed = True
        known.count += is_new
        known.largest = max(known.largest, size)

    def left_out(self, topic: str) -> str:
        """Return what of a topic is left out; empty for nothing."""
        known = self.large.get(topic)
        return too_large(known.count, known.largest) if known else ""

    @property
    @abstractmethod
    def unpublishable(self) -> str:
        """Why nothing can be published, with the remedy; empty when it can be."""

    @property
    @abstractmethod
    def offers(self) -> frozenset[Capability]:
        """What the source can do with this peer, beside what each of its kind can."""

    @abstractmethod
    def action(self, name: str, type_name: str, source: Source) -> OutgoingAction:
        """Return an action that takes goals; asked in any thread.

        Args:
            name: of the action.
            type_name: of the action.
            source: that of this connection.

        Raises:
            SourceError: it is not shown, or the server sends no goals.
        """

    def end(self) -> None:
        """The connection has ended."""
        self.is_over = True
        self.calls.end()
        self.goals.end()

    @abstractmethod
    def update(self, wanted: frozenset[str]) -> None:
        """Subscribe to the wanted topics, and unsubscribe from others."""

    @abstractmethod
    def tick(self, now: float) -> None:
        """Do periodic work; called about twice a second, with monotonic time [s]."""

    @abstractmethod
    def silence(self) -> str:
        """Return the sentence for a peer that has not become ready in time."""

    @abstractmethod
    def notes(self) -> list[str]:
        """Return what the page should say although there is a connection."""

    @abstractmethod
    def topics(self) -> dict[str, SourceTopic]:
        """Return the topics as they are now."""

    def sentence(self, dropped: int = 0, lag_s: float | None = None) -> str:
        """Return what the page says while there is a connection.

        Args:
            dropped: messages that were dropped here.
            lag_s: how late the newest ones came [s], None if that is not known.
        """
        server = text(self.server, 60)
        place = f"Connected to {self.ends.address.label}"
        parts = [f"{place} ({server})" if server else place]
        if lag_s is not None and lag_s > _LATE:
            parts.append(
                f"messages come {lag_s:.0f} s late: hide displays with large messages, "
                "such as images and point clouds"
            )
        if dropped:
            parts.append(f"{dropped} messages were dropped, displays were too slow")
        if self.unreadable:
            parts.append(f"{self.unreadable} of its frames made no sense")
        for topic in list(self.large)[:_MOST_SAID]:
            of = f"of {text(topic, 60)}, " if topic else ""
            parts.append(of + self.left_out(topic))
        return "; ".join([*parts, *self.notes()])
