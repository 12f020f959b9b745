"""Other names for the topics and the frames of a source.

A prefix distinguishes them from those of other sources; rules give single topics the
names that a config uses.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from sambot_viz.sources.message import Recorded, SourceTopic, TopicChannel

NO_NAMES: Mapping[str, str] = MappingProxyType({})


class Prefix:
    """Gives topics and channels of a source their names among other sources.

    Names that already have the prefix are kept: some robots use it themselves.

    Args:
        name: the prefix, such as "robot1"; "" changes nothing.
        remaps: topics with other names at the source, after the prefix: name here →
            name there.
    """

    def __init__(self, name: str, remaps: Mapping[str, str] = NO_NAMES) -> None:
        self.name = name.strip("/")
        self._remaps = remaps
        self._remapped = {there: here for here, there in remaps.items()}
        self._channels: dict[TopicChannel, TopicChannel] = {}
        self._inner: dict[str, str] = {}

    def outer(self, topic: str) -> str:
        """Return the name of a topic as others see it."""
        name = self._prefixed(topic)
        return self._remapped.get(name, name)

    def _prefixed(self, topic: str) -> str:
        before = f"/{self.name}/"
        if not self.name or topic.startswith(before):
            return topic
        return before + topic.removeprefix("/")

    def inner(self, topic: str) -> str:
        """Return the name of a topic as the source has it."""
        if topic in self._inner:
            return self._inner[topic]
        topic = self._remaps.get(topic, topic)
        if not self.name:
            return topic
        return f"/{topic.removeprefix(f'/{self.name}/').lstrip('/')}"

    def topics(self, topics: Mapping[str, SourceTopic]) -> dict[str, SourceTopic]:
        """Return topics by their names as others see them."""
        self._inner = {self.outer(name): name for name in topics if self._keeps(name)}
        return {
            outer: replace(topics[inner], name=outer, frame_prefix=self.name)
            for outer, inner in self._inner.items()
        }

    def _keeps(self, topic: str) -> bool:
        """Whether no rule has given the name of a topic to another one."""
        name = self._prefixed(topic)
        return self._remaps.get(self.outer(topic), name) == name

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
