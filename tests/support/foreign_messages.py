"""Messages of schemas that are not ROS's, written by programs that are not ours."""

from __future__ import annotations

import json
from typing import Any

from sambot_viz.messages import Schema
from sambot_viz.sources.message import Recorded, TopicChannel

Channel = tuple[Schema, str, bytes]
"""How a message is written: its schema, its encoding, and itself."""


def in_protobuf(message: Any) -> Channel:
    """A message of foxglove-sdk, as it writes it."""
    schema = message.get_schema()
    own = Schema(schema.name, schema.encoding, schema.data)
    return own, "protobuf", message.encode()


def in_json(name: str, fields: object) -> Channel:
    return Schema(name, "jsonschema", "{}"), "json", json.dumps(fields).encode()


def recorded(channel: Channel, topic: str = "/topic") -> Recorded:
    schema, encoding, payload = channel
    return Recorded(topic, TopicChannel(topic, schema, encoding), 0, None, payload)
