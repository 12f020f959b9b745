"""Decoders against rosbags' own, and against payloads that are cut and flipped."""

from __future__ import annotations

import random
import time
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest
from random_messages import random_message

from sambot_viz.errors import DecodeError
from sambot_viz.messages import MessageTypes, Schema

PACKAGES = ("geometry_msgs/", "nav_msgs/", "sensor_msgs/", "std_msgs/", "tf2_msgs/")
PACKAGES = (*PACKAGES, "visualization_msgs/", "trajectory_msgs/", "diagnostic_msgs/")


@pytest.fixture(scope="module")
def humble() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_HUMBLE)


@pytest.fixture(scope="module")
def noetic() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS1_NOETIC)


def same(one: Any, other: Any) -> bool:
    """Whether two messages are equal, whatever their classes."""
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other)
    if isinstance(one, list):
        pairs = zip(one, other, strict=True)
        return len(one) == len(other) and all(same(a, b) for a, b in pairs)
    if is_dataclass(one):
        # rosbags' constants are fields as well.
        names = [field.name for field in fields(one) if field.name.islower()]
        extra = ("__msgtype__", "structure_needs_at_least_one_member")
        names = [name for name in names if name not in extra]
        return all(same(getattr(one, name), getattr(other, name)) for name in names)
    return one == other


def test_what_rosbags_writes_is_read(humble: Any, noetic: Any) -> None:
    types, count = MessageTypes(distro="humble"), 0
    for name in humble.fielddefs:
        if not name.startswith(PACKAGES):
            continue
        text, _ = humble.generate_msgdef(name, ros_version=2)
        for schema in (Schema(name), Schema(name, "ros2msg", text)):
            decoder = types.decoder(schema, "cdr")
            for seed in range(3):
                message = random_message(humble, name, seed)
                for little in (True, False):
                    payload = humble.serialize_cdr(message, name, little_endian=little)
                    assert same(message, decoder.decode(payload)), (name, seed)
                    count += 1
            assert (decoder.reason, decoder.note) == (None, None)
    assert count > 1000
    for name in noetic.fielddefs:
        if name.startswith(PACKAGES):
            text, _ = noetic.generate_msgdef(name)
            decoder = types.decoder(Schema(name, "ros1msg", text), "ros1")
            message = random_message(noetic, name, 5)
            payload = noetic.serialize_ros1(message, name)
            assert same(message, decoder.decode(payload)), name


def test_a_type_without_fields_is_read_with_and_without_its_dummy_byte(
    humble: Any,
) -> None:
    types, found = MessageTypes(distro="humble"), 0
    dummy = "structure_needs_at_least_one_member"
    for name, (_, members) in humble.fielddefs.items():
        is_empty = [field for field, _ in members] == [dummy]
        text, _ = humble.generate_msgdef(name, ros_version=2)
        for schema in (Schema(name), Schema(name, "ros2msg", text)):
            decoder = types.decoder(schema, "cdr")
            for head in (b"\0\1\0\0", b"\0\0\0\0"):
                if is_empty:
                    for more in (b"", b"\0", b"\0\0\0\0"):
                        decoder.decode(head + more)
                    found += 1
                else:
                    with pytest.raises(DecodeError):
                        decoder.decode(head)
    assert found


@pytest.mark.parametrize("encoding", ["cdr", "ros1"])
def test_a_damaged_message_is_refused_or_read_in_no_time(
    humble: Any, noetic: Any, encoding: str
) -> None:
    types, chance = MessageTypes(), random.Random(17)
    store = humble if encoding == "cdr" else noetic
    names = (
        "sensor_msgs/msg/JointState",
        "sensor_msgs/msg/PointCloud2",
        "nav_msgs/msg/Path",
        "visualization_msgs/msg/MarkerArray",
        "diagnostic_msgs/msg/DiagnosticArray",
    )
    refused, longest = 0, 0.0
    for name in names:
        text, _ = store.generate_msgdef(name, ros_version=2 - (encoding == "ros1"))
        language = "ros1msg" if encoding == "ros1" else "ros2msg"
        decoder = types.decoder(Schema(name, language, text), encoding)
        for seed in range(150):
            message = random_message(store, name, seed)
            write = store.serialize_ros1 if encoding == "ros1" else store.serialize_cdr
            payload = bytearray(write(message, name))
            for _ in range(chance.randrange(1, 4)):
                payload[chance.randrange(len(payload))] = chance.choice(
                    [0, 1, 127, 255]
                )
            if chance.random() < 0.5:
                del payload[chance.randrange(len(payload)) :]
            began = time.process_time()
            try:
                decoder.decode(payload)
            except DecodeError as error:
                assert len(str(error)) < 200
                refused += 1
            if seed:  # the functions are made with the first message
                longest = max(longest, time.process_time() - began)
    assert refused > 200
    # A length that is trusted takes minutes; the rest is the making of functions.
    assert longest < 5.0
