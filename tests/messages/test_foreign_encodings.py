"""Protobuf, FlatBuffers, JSON, CBOR and MessagePack, and what liars make of them."""

from __future__ import annotations

import base64
import json
import random
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import foxglove.messages as fox
import numpy as np
import pytest
from bag_messages import messages_of
from foreign_messages import Channel, in_protobuf, recorded
from google.protobuf import descriptor_pb2, timestamp_pb2
from rosbridge_peer import cbor

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.messages import MessageTypes, Schema
from sambot_viz.topics.decoding import Decoding

RECORDINGS = Path(__file__).parents[1] / "meanings" / "recordings"
POSE = {
    "header": {"stamp": {"sec": 12, "nanosec": 34}, "frame_id": "map"},
    "pose": {"position": {"x": 1.5}, "orientation": {"w": 1}},
}
TYPE = "geometry_msgs/msg/PoseStamped"


def decode(schema: Schema, encoding: str, payload: bytes) -> Any:
    return Decoding(MessageTypes()).decode(recorded((schema, encoding, payload)))


def plain(encoding: str, value: object) -> bytes:
    import msgspec

    writers = {"json": lambda v: json.dumps(v).encode(), "cbor": cbor}
    return writers.get(encoding, msgspec.msgpack.encode)(value)


@pytest.mark.parametrize("encoding", ["json", "cbor", "msgpack"])
def test_fields_that_say_themselves_what_they_are_have_the_look_of_their_type(
    encoding: str,
) -> None:
    message = decode(Schema(TYPE), encoding, plain(encoding, POSE))
    assert (message.header.frame_id, message.header.stamp.nanosec) == ("map", 34)
    assert (message.pose.position.x, message.pose.position.y) == (1.5, 0)


def test_times_of_ros_1_are_read() -> None:
    old = {**POSE, "header": {"stamp": {"secs": 12, "nsecs": 34}, "frame_id": "map"}}
    stamp = decode(Schema(TYPE), "json", plain("json", old)).header.stamp
    assert (stamp.sec, stamp.nanosec) == (12, 34)


def test_arrays_of_numbers_come_as_lists_bytes_and_base64() -> None:
    data = bytes(range(8))
    text = base64.b64encode(data).decode()
    for value in (list(data), text):
        fields = {"header": POSE["header"], "height": 2, "data": value}
        image = decode(Schema("sensor_msgs/Image"), "json", plain("json", fields))
        assert bytes(image.data) == data
    # RFC 8746: the tag of little-endian 32-bit floats.
    ranges = np.array([1.5, np.inf], "<f4").tobytes()
    payload = b"\xa1" + cbor("ranges") + b"\xd8\x55" + cbor(ranges)
    scan = decode(Schema("sensor_msgs/LaserScan"), "cbor", payload)
    assert scan.ranges.tolist() == [1.5, np.inf]


def test_json_writes_null_for_what_is_no_number() -> None:
    fields = {"ranges": [1, None], "range_max": 5}
    scan = decode(Schema("sensor_msgs/LaserScan"), "json", plain("json", fields))
    assert scan.ranges[0] == 1 and np.isnan(scan.ranges[1])


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"header": 3}, "header: a number instead of fields"),
        ({"header": {"frame_id": 3}}, "frame_id: a number instead of a text"),
        ({"header": {"stamp": {"sec": 1e300}}}, "the number 1e.300 is too large"),
        ({"header": {"stamp": {"sec": 0.5}}}, "0.5 instead of a whole number"),
        ({"pose": {"position": {"x": []}}}, "x: a list instead of a number"),
        ({"something": 1}, "it has no field of geometry_msgs/msg/PoseStamped"),
    ],
)
@pytest.mark.parametrize("encoding", ["json", "cbor", "msgpack"])
def test_a_field_of_another_kind_is_named(
    encoding: str, fields: object, why: str
) -> None:
    with pytest.raises(DecodeError, match=why):
        decode(Schema(TYPE), encoding, plain(encoding, fields))


@pytest.mark.parametrize(
    ("type_name", "fields", "why"),
    [
        ("sensor_msgs/Image", {"data": "?"}, "data: a text that is not base64"),
        ("sensor_msgs/Image", {"data": [300]}, "data: its numbers are not numbers"),
        ("sensor_msgs/LaserScan", {"ranges": [[1]]}, "ranges: lists instead of"),
        ("sensor_msgs/LaserScan", {"ranges": "AAA="}, "ranges: a text instead of"),
        ("sensor_msgs/CameraInfo", {"k": [1, 2]}, "k: 2 numbers instead of 9"),
        ("nav_msgs/Path", {"poses": 1}, "poses: a number instead of a list"),
    ],
)
def test_an_array_of_another_kind_is_named(
    type_name: str, fields: object, why: str
) -> None:
    with pytest.raises(DecodeError, match=why):
        decode(Schema(type_name), "json", plain("json", fields))


@pytest.mark.parametrize(
    ("encoding", "payload"),
    [
        ("json", b"{"),
        ("json", b"[" * 100_000),
        ("cbor", b"\xa1"),
        ("cbor", b"\x81" * 100_000),
        ("msgpack", b"\xdd\xff\xff\xff\xff"),
        ("msgpack", b"\x91" * 100_000),
    ],
)
def test_bytes_that_are_not_of_their_encoding_are_refused(
    encoding: str, payload: bytes
) -> None:
    with pytest.raises(DecodeError, match=r"it is (not )?(JSON|CBOR|MessagePack)"):
        decode(Schema(TYPE), encoding, payload)
    with pytest.raises(DecodeError, match="but not an object with fields"):
        decode(Schema(TYPE), encoding, plain(encoding, [1]))


# what has a schema


def written() -> dict[str, Channel]:
    """A message of each type of foxglove-sdk, and those that flatc has made."""
    pose = fox.Pose(position=fox.Vector3(x=1, y=2, z=3))
    transform = fox.FrameTransform(parent_frame_id="map", child_frame_id="odom")
    cube = fox.CubePrimitive(pose=pose, size=fox.Vector3(x=1, y=1, z=1))
    entity = fox.SceneEntity(frame_id="map", id="a", cubes=[cube, cube])
    some = [
        fox.FrameTransforms(transforms=[transform, transform]),
        fox.LaserScan(frame_id="a", pose=pose, end_angle=1, ranges=[1.0] * 20),
        fox.PosesInFrame(frame_id="a", poses=[pose, pose]),
        fox.SceneUpdate(entities=[entity]),
        fox.RawImage(frame_id="a", width=2, height=2, encoding="mono8", data=b"abcd"),
    ]
    found = {f"protobuf {one.get_schema().name}": in_protobuf(one) for one in some}
    for _, schema, encoding, payload in messages_of(RECORDINGS / "flatbuffer.mcap"):
        found[f"flatbuffer {schema.name}"] = schema, encoding, payload
    return found


def broken(data: bytes, seed: int) -> bytes:
    chance = random.Random(seed)
    changed = bytearray(data)
    for _ in range(chance.randrange(1, 6)):
        changed[chance.randrange(len(data))] = chance.choice([0, 1, 127, 128, 255])
    return bytes(changed[: chance.randrange(len(data))] if seed % 3 == 0 else changed)


@pytest.mark.parametrize("name", written())
def test_a_broken_message_is_refused_or_read(name: str) -> None:
    schema, encoding, payload = written()[name]
    decoding, refused = Decoding(MessageTypes()), 0
    for seed in range(300):
        message = recorded((schema, encoding, broken(payload, seed)))
        try:
            decoding.decode(message)
        except DecodeError as error:
            assert str(error)
            refused += 1
    assert 0 < refused


@pytest.mark.parametrize("name", written())
def test_a_broken_schema_costs_its_own_topic(name: str) -> None:
    schema, encoding, payload = written()[name]
    assert isinstance(schema.text, bytes)
    said = set[str]()
    for seed in range(60):
        wrong = Schema(schema.name, encoding, broken(schema.text, seed))
        try:
            decode(wrong, encoding, payload)
        except DecodeError as error:
            said.add(str(error).partition(" ")[0])
    assert said


def descriptors(*files: descriptor_pb2.FileDescriptorProto) -> bytes:
    return descriptor_pb2.FileDescriptorSet(file=files).SerializeToString()


def file_of(name: str, *needs: str) -> descriptor_pb2.FileDescriptorProto:
    file = descriptor_pb2.FileDescriptorProto(name=name, package="lab")
    file.syntax = "proto3"
    file.dependency.extend(needs)
    file.message_type.add(name="Blob")
    return file


def wrong_descriptors() -> Iterator[tuple[str, bytes, str]]:
    yield "none", b"", "have no descriptor"
    yield "garbage", b"\xff" * 9, "descriptor is damaged"
    other = descriptor_pb2.FileDescriptorProto(name="a", package="lab")
    yield "another type", descriptors(other), "descriptor has no lab.Blob"
    yield "a ring", descriptors(file_of("a", "b"), file_of("b", "a")), "lacks a file"
    yield "a hole", descriptors(file_of("a", "b")), "lacks a file that it names"
    yield "twice", descriptors(file_of("a"), file_of("b")), "contradicts itself"
    large = b"\0" * (limits.DEFINITION.value + 1)
    yield "a bomb", large, "the limit is 1,048,576"


@pytest.mark.parametrize(
    ("data", "why"), [one[1:] for one in wrong_descriptors()], ids=lambda one: ""
)
def test_a_wrong_descriptor_is_a_reason(data: bytes, why: str) -> None:
    decoder = MessageTypes().decoder(Schema("lab.Blob", "protobuf", data), "protobuf")
    assert decoder.reason is not None and decoder.reason.code == "encoding"
    assert why in decoder.reason.text


def test_a_descriptor_may_leave_out_the_files_of_google() -> None:
    file = file_of("a", timestamp_pb2.DESCRIPTOR.name)
    field = file.message_type[0].field.add(name="at", number=1, label=1, type=11)
    field.type_name = ".google.protobuf.Timestamp"
    schema = Schema("lab.Blob", "protobuf", descriptors(file))
    found = decode(schema, "protobuf", b"\n\2\x08\5")
    assert found == {"at": {"seconds": 5, "nanos": 0}}


def test_fields_of_a_type_without_a_meaning_are_read() -> None:
    file = file_of("a")
    add = file.message_type[0].field.add
    for number, (name, kind, label) in enumerate(
        [("n", 5, 1), ("text", 9, 1), ("many", 1, 3), ("raw", 12, 1)], 1
    ):
        add(name=name, number=number, type=kind, label=label)
    schema = Schema("lab.Blob", "protobuf", descriptors(file))
    many = np.array([1.5, 2]).tobytes()
    found = decode(schema, "protobuf", b"\x08\7\x12\2hi\x1a\x10" + many + b'"\1x')
    assert (found["n"], found["text"], found["raw"]) == (7, "hi", b"x")
    assert found["many"].tolist() == [1.5, 2]


@pytest.mark.parametrize("encoding", ["json", "msgpack", "cbor", "protobuf"])
def test_a_message_above_the_limit_is_not_decoded(
    encoding: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = limits.LimitRow("", 10, "bytes", "")
    monkeypatch.setattr(limits, "FIELDS_MESSAGE", small)
    schema = fox.Log.get_schema()
    known = Schema(schema.name, schema.encoding, schema.data)
    with pytest.raises(DecodeError, match="it has 11 bytes; the limit is 10"):
        decode(known, encoding, bytes(11))


NODE = base64.b64decode(
    "GAAAAEJGQlMQABwABAAIAAwAEAAUABgAEAAAADAAAAAoAAAAHAAAABAAAAA8AAAABAAAAAAAAAAA"
    "AAAAAAAAAAAAAAAAAAAAAAAAAAEAAAAYAAAAFAAUAAQACAAAAAwAAAAAAAAAEAAUAAAAIAAAABQA"
    "AAABAAAABAAAAAAAAAAAAAAAAQAAADAAAAAIAAAAbGFiLk5vZGUAAAAAHAAQAAgADAAAAAYAAAAA"
    "AAAAAAAAAAAAAAAFABwAAAAAAQQAKAAAABQAAAAQABAABgAHAAgAAAAAAAwAEAAAAAAADg8AAAAA"
    "BAAAAAUAAABub2RlcwAAAA=="
)
"""What flatc 2.0.8 makes of: namespace lab; table Node { nodes: [Node]; }."""


def nested(depth: int, fan: int) -> bytes:
    """Nodes of which all children are the same node."""
    size = 20 + 4 * fan
    tables = [4 + level * size + 8 for level in range(depth)]
    found = struct.pack("<I", tables[0])
    for level, table in enumerate(tables):
        count = fan if level < depth - 1 else 0
        places = [table + 12 + 4 * number for number in range(fan)]
        below = tables[min(level + 1, depth - 1)]
        found += struct.pack("<HHHHiII", 6, 8, 4, 0, 8, 4, count)
        found += struct.pack(f"<{fan}i", *(below - place for place in places))
    return found


def test_parts_that_are_shared_do_not_make_a_message_endless() -> None:
    schema = Schema("lab.Node", "flatbuffer", NODE)
    few = decode(schema, "flatbuffer", nested(3, 2))
    assert few == {"nodes": [{"nodes": [{"nodes": []}] * 2}] * 2}
    with pytest.raises(DecodeError, match="its parts are each other"):
        decode(schema, "flatbuffer", nested(20, 10))
    with pytest.raises(DecodeError, match="nested too deeply"):
        decode(schema, "flatbuffer", nested(100, 1))
