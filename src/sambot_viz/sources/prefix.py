"""A prefix before the topics and the frames of a source, to tell it from others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from sambot_viz.sources.message import Recorded, SourceTopic, TopicChannel


class Prefix:
    """Gives topics and channels of a source their names among other sources.

    What has the prefix already keeps its name, as of a robot whose topics and frames
    have it by themselves.

    Args:
        name: such as "robot1"; "" changes nothing.
    """

    def __init__(self, name: str) -> None:
        self.name = name.strip("/")
        self._channels: dict[TopicChannel, TopicChannel] = {}
        self._inner: dict[str, str] = {}

    def outer(self, topic: str) -> str:
        """Return the name of a topic as others see it."""
        before = f"/{self.name}/"
        if not self.name or topic.startswith(before):
            return topic
        return before + topic.removeprefix("/")

    def inner(self, topic: str) -> str:
        """Return the name of a topic as the source has it."""
        if topic in self._inner or not self.name:
            return self._inner.get(topic, topic)
        return f"/{topic.removeprefix(f'/{self.name}/').lstrip('/')}"

    def topics(self, topics: Mapping[str, SourceTopic]) -> dict[str, SourceTopic]:
        """Return topics by their names as others see them."""
        self._inner = {self.outer(name): name for name in topics}
        return {
            outer: replace(topics[inner], name=outer, frame_prefix=self.name)
            for outer, inner in self._inner.items()
        }

    def message(self, message: Recorded, shift_ns: int = 0) -> Recorded:
        """Return a message as one of its topic among others.

        Args:
            message: of the source.
            shift_ns: how much later it is than it was logged [ns].
        """
        channel = self._channels.get(message.channel)
        if channel is None:
            topic = self.outer(message.topic)
            channel = replace(message.channel, topic=topic, frame_prefix=self.name)
            self._channels[message.channel] = channel
        log_ns = message.log_ns + shift_ns
        published, payload = message.publish_ns, message.payload
        return Recorded(channel.topic, channel, log_ns, published, payload)
