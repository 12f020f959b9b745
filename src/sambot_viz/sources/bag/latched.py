"""Messages that hold at any time of a recording: those of latched topics.

A topic is latched if it was offered transient local, if ROS 1 calls it latching, or if
it has the name of such a topic: many recorders write no QoS. /rosout and the events of
services are transient local too, but mean nothing later.
"""

from __future__ import annotations

from operator import attrgetter

from sambot_viz import limits
from sambot_viz.sources.message import Recorded, is_latched_name
from sambot_viz.sources.qos import Qos

_LOGS = ("rosout",)
_LOG_TYPES = ("rcl_interfaces/Log", "rosgraph_msgs/Log")


def is_latched(topic: str, type_name: str, qos: Qos | None, latching: str = "") -> bool:
    """Return whether a topic is latched.

    Args:
        topic: its name.
        type_name: of its messages, in any way of writing.
        qos: what was offered, if the file says so.
        latching: "1" when ROS 1 says so.
    """
    if is_latched_name(topic):
        return True
    plain = type_name.replace("/msg/", "/")
    if (
        topic.rpartition("/")[2] in _LOGS
        or plain in _LOG_TYPES
        or plain.endswith("_Event")
    ):
        return False
    return latching == "1" or (qos is not None and qos.is_any_transient_local)


class LatchedMessages:
    """Collects the messages of latched topics, with a limit."""

    def __init__(self) -> None:
        self._messages: list[Recorded] = []
        self._free = {True: limits.LATCHED.value, False: limits.LATCHED_OTHERS.value}
        self._is_sorted = True

    def wants(self, topic: str) -> bool:
        """Return whether there is room for messages of a latched topic."""
        return self._free[is_latched_name(topic)] > 0

    def add(self, message: Recorded) -> None:
        """Keep a message of a latched topic, if there is room."""
        kind = is_latched_name(message.topic)
        if self._free[kind] <= 0:
            return
        self._free[kind] -= len(message.payload)
        if self._free[kind] > 0:
            self._messages.append(message)
            self._is_sorted = False
        elif not kind:
            # A part of them would look like all of them.
            self._messages = [m for m in self._messages if is_latched_name(m.topic)]

    @property
    def messages(self) -> tuple[Recorded, ...]:
        """All of them, by log time."""
        if not self._is_sorted:
            self._messages.sort(key=attrgetter("log_ns"))
            self._is_sorted = True
        return tuple(self._messages)
