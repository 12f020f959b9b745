"""What every source hands on: a message as bytes, with its topic and its times.

Nothing is decoded here: `messages/` does that, and only for messages that are shown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from sambot_viz import limits
from sambot_viz.messages import Schema
from sambot_viz.sources.qos import Qos

if TYPE_CHECKING:
    from sambot_viz.sources.ros_endpoint import TopicEndpoints


@dataclass(frozen=True, slots=True, eq=False)
class TopicChannel:
    """One way in which messages of a topic are written; a topic may have several.

    Channels are compared by identity: a decoder can be kept by channel.

    Attributes:
        topic: name of the topic, as the file or the peer writes it.
        schema: the definition of the messages, as it was given.
        message_encoding: "cdr", "ros1", "json", … or "" when it was not given.
        qos: what the publishers offered, as far as it is known.
        is_latched: as `SourceTopic.is_latched`.
        frame_prefix: as `SourceTopic.frame_prefix`.
    """

    topic: str
    schema: Schema
    message_encoding: str
    qos: Qos | None = None
    is_latched: bool = False
    frame_prefix: str = ""


@dataclass(frozen=True, slots=True)
class SourceTopic:
    """A topic of a recording or of a live robot.

    Attributes:
        name: the name, as the file or the peer writes it.
        schema: the definition of its messages, that of the first channel when several
            differ; its name may be empty.
        message_encoding: "cdr", "ros1", "json", … or ""; of the first channel.
        qos: the QoS that its publishers offer; None if unknown.
        is_latched: whether late subscribers get its messages, as far as known; in a
            recording they hold at any time, see `bag/latched.py`.
        publishers: their names or their number; None if unknown.
        subscribers: names of the nodes that read it; None if unknown.
        endpoints: both with their QoS; None if not all are known.
        reason: why it cannot be read, with the remedy; None if it may be read.
        count: number of readable messages in a recording; None while unknown, and for a
            live robot.
        left_out: a sentence about unread messages; empty without any.
        frame_prefix: prefix of the frames in its messages, without a slash at its end;
            empty without one.
    """

    name: str
    schema: Schema
    message_encoding: str
    qos: Qos | None = None
    is_latched: bool = False
    publishers: tuple[str, ...] | int | None = None
    subscribers: tuple[str, ...] | None = None
    endpoints: TopicEndpoints | None = None
    reason: str | None = None
    count: int | None = None
    left_out: str = ""
    frame_prefix: str = ""

    @property
    def is_awaited(self) -> bool:
        """Whether nodes wait for it, and none publishes it."""
        return self.endpoints is not None and not self.endpoints.publishers


@dataclass(frozen=True, slots=True)
class Recorded:
    """A message as bytes.

    Attributes:
        topic: name of its topic.
        channel: how it is written.
        log_ns: when it was recorded or received [ns].
        publish_ns: when it was published [ns], or None when that is not known.
        payload: the serialized message.
    """

    topic: str
    channel: TopicChannel
    log_ns: int
    publish_ns: int | None
    payload: bytes | memoryview


def is_latched_name(topic: str) -> bool:
    """Return whether topics of this name are latched, whatever their QoS says."""
    return topic.endswith(("/tf_static", "robot_description")) or topic == "tf_static"


def too_large(count: int, largest: int) -> str:
    """Say how many messages are left out since they are too large.

    Args:
        count: how many.
        largest: size of the largest of them [bytes].
    """
    said = limits.MESSAGE.said(largest)
    if count == 1:
        return f"a message is left out: it holds {said}"
    return f"{count:,} messages are left out: the largest holds {said}"
