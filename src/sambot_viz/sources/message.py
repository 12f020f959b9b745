"""What every source hands on: a message as bytes, with its topic and its times.

Nothing is decoded here: `messages/` does that, and only for messages that are shown.
"""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.messages import Schema
from sambot_viz.sources.qos import Qos


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
    """

    topic: str
    schema: Schema
    message_encoding: str
    qos: Qos | None = None
    is_latched: bool = False


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
    """Tell if topics of this name are latched, whatever their QoS says."""
    return topic.endswith(("/tf_static", "robot_description")) or topic == "tf_static"
