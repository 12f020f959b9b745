"""What participants of DDS say of themselves, and of their readers and writers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sambot_viz.sources.dds.names import type_hash_of
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_graph import NO_HASH

_KIND = "PARTICIPANT_TYPE"
"""The property with which Fast DDS says how it finds others."""


@dataclass(frozen=True, slots=True)
class DdsPeer:
    """Another participant.

    Attributes:
        id: identifies it.
        is_there: it has come; else it is gone.
        discovery: how it finds others, such as SIMPLE or CLIENT; "" if it says none.
    """

    id: bytes
    is_there: bool
    discovery: str = ""


@dataclass(frozen=True, slots=True)
class DdsEndpoint:
    """A reader or a writer of another participant.

    Attributes:
        id: identifies it to all.
        handle: identifies it here, with its messages.
        is_there: it has come; else it is gone, and the rest is not known.
        is_writer: it writes.
        topic: as DDS has it.
        wire_type: the same of its type.
        type_hash: of the definition of that.
        qos: what it offers or asks for.
    """

    id: bytes
    handle: int
    is_there: bool
    is_writer: bool
    topic: str = ""
    wire_type: str = ""
    type_hash: str = NO_HASH
    qos: Qos | None = None


def as_peer(ours: str, sample: Any) -> DdsPeer | None:
    """Return an announced participant; None if it has our name."""
    from cyclonedds.qos import Policy

    if not sample.sample_info.valid_data:
        return DdsPeer(sample.key.bytes, False)
    name, kind = sample.qos[Policy.EntityName], ""
    if name is not None and name.name == ours:
        return None
    for policy in sample.qos:
        if getattr(policy, "key", "") == _KIND:
            kind = str(policy.value)
    return DdsPeer(sample.key.bytes, True, kind)


def as_endpoint(own: bytes, is_writer: bool, sample: Any) -> DdsEndpoint | None:
    """Return an announced reader or writer; None if it belongs to our participant."""
    from cyclonedds.qos import Policy

    info, identity = sample.sample_info, sample.key.bytes
    if sample.participant_key.bytes == own:
        return None
    if not info.valid_data:
        return DdsEndpoint(identity, info.instance_handle, False, is_writer)
    said = sample.qos[Policy.Userdata]
    return DdsEndpoint(
        identity,
        info.instance_handle,
        True,
        is_writer,
        sample.topic_name,
        sample.type_name,
        type_hash_of(said.data) if said is not None else NO_HASH,
        _qos(sample.qos),
    )


def _qos(policies: Any) -> Qos:
    """Return QoS; how many messages are kept is not told on the wire."""
    import cyclonedds.qos

    library: Any = cyclonedds.qos
    policy = library.Policy
    is_kept = policies[policy.Durability] != policy.Durability.Volatile
    is_loose = policies[policy.Reliability] == policy.Reliability.BestEffort
    return Qos(
        "best_effort" if is_loose else "reliable",
        "transient_local" if is_kept else "volatile",
        is_any_transient_local=is_kept,
    )
