"""Messages as a transport wants them: CDR of ROS 2, or JSON."""

from __future__ import annotations

import json
from typing import Any, Protocol

from sambot_viz.errors import DecodeError, PublishError
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.source import Outgoing, Source


class HasFields(Protocol):
    """What has the fields of a message."""

    def fields(self, stamp: object) -> dict[str, Any]:
        """Return them, with a time as the transport wants it."""
        ...


def time_of(source: Source, newest_ns: int) -> int:
    """Return the time of a robot [ns]: its clock's, else its newest stamp.

    Args:
        source: the robot.
        newest_ns: the newest stamp of its transforms [ns]; 0 without any.
    """
    told = source.clock_ns()
    return told if source.has_clock else newest_ns or told


def written(
    outgoing: Outgoing, message: HasFields, now_ns: int, types: MessageTypes
) -> bytes:
    """Return a message in the encoding of a topic, with the present time.

    A server that accepts JSON fills in its own time, simulated or not; others get that
    of the robot.

    Args:
        outgoing: the topic.
        message: the message.
        now_ns: the time of the robot [ns].
        types: the definitions of messages.

    Raises:
        PublishError: a field does not fit the type.
    """
    sec, nanosec = divmod(now_ns, 10**9)
    try:
        if outgoing.encoding == "json":
            return json.dumps(message.fields("now"), allow_nan=False).encode()
        fields = message.fields({"sec": sec, "nanosec": nanosec})
        return types.shape(outgoing.type_name).as_cdr(fields)
    except (DecodeError, TypeError, ValueError) as error:
        raise PublishError(f"{outgoing.type_name}: {error}") from error
