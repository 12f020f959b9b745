"""A topic that is published over one connection."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import partial

from sambot_viz.errors import SourceError
from sambot_viz.sources.source import Encoding, Receivers
from sambot_viz.text import text


class TopicSender(ABC):
    """Announces topics to a peer, in the thread of the connection.

    Attributes:
        publishes: the encoding of messages to the peer.
        is_over: whether the connection has ended.
    """

    publishes: Encoding
    is_over: bool

    @abstractmethod
    def advertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the peer of a topic that is published, and note who gets it."""

    @abstractmethod
    def publish(self, outgoing: OutgoingTopic, message: bytes) -> None:
        """Send a message of an announced topic."""

    @abstractmethod
    def unadvertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the peer that a topic is published no longer."""


class OutgoingTopic:
    """Implements `Outgoing`; what it asks for is done in the thread of the connection.

    Args:
        topic: its name.
        type_name: of its messages.
        publisher: of the connection that was there when it was made.
        post: has something done in that thread.

    Attributes:
        number: which topic it is, for the peer.
        receivers: as of `Outgoing`, as the publisher hears it.
        refused: the same.
        frame_prefix: the same; set by who has renamed it.
    """

    number = 0
    receivers = Receivers()
    refused = ""
    frame_prefix = ""

    def __init__(
        self,
        topic: str,
        type_name: str,
        publisher: TopicSender,
        post: Callable[[Callable[[], object]], object],
    ) -> None:
        self.topic = topic
        self.type_name = type_name
        self.encoding: Encoding = publisher.publishes
        self._publisher = publisher
        self._post = post
        self._is_closed = False
        post(partial(publisher.advertise, self))

    @property
    def is_over(self) -> bool:
        """Whether its connection has ended; there may be another one by now."""
        return self._publisher.is_over

    def send(self, message: bytes) -> None:
        """Publish a message.

        Raises:
            SourceError: the connection, or the topic, has ended.
        """
        if self._is_closed or self._publisher.is_over:
            why = "it was closed" if self._is_closed else "the connection was lost"
            raise SourceError(f"nothing is sent on {text(self.topic, 80)}: {why}")
        self._post(partial(self._publisher.publish, self, message))

    def close(self) -> None:
        """Publish the topic no longer; a second call does nothing."""
        if not self._is_closed:
            self._is_closed = True
            self._post(partial(self._publisher.unadvertise, self))
