"""A service whose answer is taken as a message of a topic."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from sambot_viz.messages import Schema
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.sources.source import Encoding, Reply

_NO_FIELDS: Mapping[Encoding, bytes] = {"cdr": b"\0\1\0\0\0", "json": b"{}"}
"""A request without fields; in CDR ROS 2 gives it one byte."""


@dataclass(frozen=True, slots=True)
class ServiceMessage:
    """A service without a request, whose answer counts as a message of a topic.

    Attributes:
        service: its name.
        topic: the topic that the answer is delivered on.
        type_name: the type of the message.
        content: returns the message in the encoding of an answer; raises DecodeError if
            it is malformed.
        refused: called in the session with the reason if there is no answer.
    """

    service: str
    topic: str
    type_name: str
    content: Callable[[Reply], bytes]
    refused: Callable[[str], object]

    @staticmethod
    def request(encoding: Encoding) -> bytes:
        """Return the request."""
        return _NO_FIELDS[encoding]

    def message(self, reply: Reply, log_ns: int, frame_prefix: str) -> Recorded:
        """Return an answer as a message of the topic.

        Args:
            reply: the answer.
            log_ns: time of arrival [ns].
            frame_prefix: prefix for the names of its frames.

        Raises:
            DecodeError: the answer is malformed.
        """
        channel = TopicChannel(
            self.topic,
            Schema(self.type_name),
            "json" if reply.is_json else "cdr",
            frame_prefix=frame_prefix,
        )
        return Recorded(self.topic, channel, log_ns, None, self.content(reply))
