"""What the records of an MCAP file say about its topics and their types."""

from __future__ import annotations

from sambot_viz.messages import Schema
from sambot_viz.sources.bag.latched import is_latched
from sambot_viz.sources.bag.mcap_records import ChannelRecord, SchemaRecord
from sambot_viz.sources.message import TopicChannel
from sambot_viz.sources.qos import parse_qos


def schema_of(record: SchemaRecord) -> Schema:
    """A type, with its definition as text, or as bytes where it is none."""
    data: str | bytes = record.data
    if record.encoding not in ("protobuf", "flatbuffer"):
        data = record.data.decode("utf-8", "replace")
    return Schema(record.name, record.encoding, data)


def channel_of(record: ChannelRecord, schema: Schema) -> TopicChannel:
    """A topic with its type and its QoS."""
    qos = parse_qos(record.metadata.get("offered_qos_profiles", ""))
    latching = record.metadata.get("latching", "")
    latched = is_latched(record.topic, schema.name, qos, latching)
    return TopicChannel(record.topic, schema, record.encoding, qos, latched)
