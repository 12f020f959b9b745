"""The markers from before the subscription, from the service of their program.

The answer of get_interactive_markers has the fields of a message of full sets, except
the name of the server; it is delivered as such a message.
"""

from __future__ import annotations

import json
import struct

from sambot_viz.errors import DecodeError
from sambot_viz.sources.source import Reply

SERVICE = "/get_interactive_markers"
"""What the name of the service ends with."""
FULL_TYPE = "visualization_msgs/msg/InteractiveMarkerInit"
_HEAD = 4
"""Bytes before the fields of CDR, which say how numbers are written."""


def as_full_set(reply: Reply) -> bytes:
    """Return the answer of the service as a message of full sets, in its encoding.

    Raises:
        DecodeError: the bytes are no such answer.
    """
    if reply.is_json:
        try:
            told = json.loads(reply.content)
            fields = {"seq_num": told["sequence_number"], "markers": told["markers"]}
        except (KeyError, TypeError, ValueError) as error:
            raise DecodeError("it has no markers") from error
        return json.dumps(fields).encode()
    head, fields = reply.content[:_HEAD], reply.content[_HEAD:]
    if len(head) < _HEAD:
        raise DecodeError("it is empty")
    # An empty name: length, final zero, and padding to the next number.
    order = "<" if head[1] & 1 else ">"
    return head + struct.pack(f"{order}Ixxxx", 1) + fields
