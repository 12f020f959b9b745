"""The latched messages of a recording that hold at its present end."""

from __future__ import annotations

from sambot_viz import limits
from sambot_viz.sources.message import Recorded, is_latched_name


class LatchedState:
    """Keeps the latched messages that hold: the last one of each topic.

    Each node has transforms of its own on /tf_static, so all that differ are kept.
    """

    def __init__(self) -> None:
        self._messages: dict[tuple[object, ...], Recorded] = {}
        self._size = 0

    def take(self, message: Recorded) -> bool:
        """Keep a message that late subscribers would get.

        Returns:
            Whether the message says something new; true of all that are not latched.
        """
        topic = message.topic
        if not (
            message.channel.is_latched or is_latched_name(topic) or topic == "/map"
        ):
            return True
        is_static = topic.endswith("tf_static")
        key = (topic, bytes(message.payload)) if is_static else (topic,)
        old = self._messages.pop(key, None)
        if old is not None:
            self._size -= len(old.payload)
        self._messages[key] = message
        self._size += len(message.payload)
        while self._size > limits.LATCHED.value:
            oldest = next(iter(self._messages))
            self._size -= len(self._messages.pop(oldest).payload)
        return old is None or old.payload != message.payload

    def without(self, message: Recorded | None = None) -> list[Recorded]:
        """Return the messages that are held, but for one."""
        return [one for one in self._messages.values() if one is not message]
