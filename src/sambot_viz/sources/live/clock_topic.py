"""The topic /clock, on which a simulation publishes its time.

It is read here and not in `messages/`, since it is the source's own clock: eight bytes
at a fixed place.
"""

from __future__ import annotations

import struct

import msgspec

from sambot_viz.sources.message import Recorded, SourceTopic

CLOCK = "/clock"
_TYPES = ("rosgraph_msgs/msg/Clock", "rosgraph_msgs/Clock")
_SECOND = 1_000_000_000


class _Stamp(msgspec.Struct):
    sec: int = 0
    nanosec: int = 0
    secs: int = 0
    nsecs: int = 0


class _ClockMessage(msgspec.Struct):
    clock: _Stamp


def is_clock(topic: SourceTopic | None) -> bool:
    """Return whether a topic has the type of /clock."""
    return topic is not None and topic.schema.name in _TYPES


def told_time(message: Recorded) -> int | None:
    """Return the time of a message of /clock [ns]; None if it is malformed."""
    channel, payload = message.channel, message.payload
    if channel.schema.name not in _TYPES:
        return None
    try:
        if channel.message_encoding == "json":
            stamp = msgspec.json.decode(payload, type=_ClockMessage).clock
            return (stamp.sec or stamp.secs) * _SECOND + stamp.nanosec + stamp.nsecs
        if channel.message_encoding == "cdr":
            order = "<" if payload[1] & 1 else ">"
            seconds, rest = struct.unpack_from(f"{order}iI", payload, 4)
        else:
            seconds, rest = struct.unpack_from("<II", payload)
    except (struct.error, IndexError, msgspec.MsgspecError):
        return None
    return seconds * _SECOND + rest
