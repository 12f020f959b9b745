"""Messages as a transport wants them: CDR of ROS 2, or JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from sambot_viz.errors import DecodeError, PublishError
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.source import Outgoing


def stamp_for(outgoing: Outgoing, now_ns: int) -> object:
    """Return the time of a message that is sent now.

    A server that takes JSON puts in its own, simulated or not; others get the time of
    the source.

    Args:
        outgoing: the topic.
        now_ns: the time of its source [ns].
    """
    if outgoing.encoding == "json":
        return "now"
    sec, nanosec = divmod(now_ns, 10**9)
    return {"sec": sec, "nanosec": nanosec}


def written(
    outgoing: Outgoing, fields: Mapping[str, Any], types: MessageTypes
) -> bytes:
    """Return a message as a topic wants it.

    Raises:
        PublishError: a field is not what the type says.
    """
    try:
        if outgoing.encoding == "json":
            return json.dumps(fields, allow_nan=False).encode()
        return types.shape(outgoing.type_name).as_cdr(fields)
    except (DecodeError, TypeError, ValueError) as error:
        raise PublishError(f"{outgoing.type_name}: {error}") from error
