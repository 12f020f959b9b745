"""Decoders: which one a channel gets, what it reads, and what nobody can make it do."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.errors import DecodeError
from sambot_viz.meanings import Meaning
from sambot_viz.messages import MessageTypes, Schema
from sambot_viz.messages import types as types_module

LINE = "=" * 80 + "\n"
JOINT_STATE = (
    "std_msgs/Header header\nstring[] name\n"
    "float64[] position\nfloat64[] velocity\nfloat64[] effort\n"
)
TIME = LINE + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
HEADER = LINE + "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
HEADER_ROS1 = LINE + "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
# The third message of our own recording of a square, as .mcap and as .bag.
JOINTS = bytes.fromhex(
    "0001000080e14e6800e1f50501000000000000000200000011000000647269766577686c5f6c5f6a"
    "6f696e740000000011000000647269766577686c5f725f6a6f696e74000000000200000000000000"
    "0000d03f000000000000d03f02000000000000000000000000000440000000000000044000000000"
)
JOINTS_ROS1 = bytes.fromhex(
    "0000000080e14e6800e1f505000000000200000010000000647269766577686c5f6c5f6a6f696e74"
    "10000000647269766577686c5f725f6a6f696e7402000000000000000000d03f000000000000d03f"
    "020000000000000000000440000000000000044000000000"
)


@pytest.fixture(scope="module")
def types() -> MessageTypes:
    return MessageTypes()


@pytest.mark.parametrize(
    ("schema", "encoding", "payload"),
    [
        (
            Schema(
                "sensor_msgs/msg/JointState", "ros2msg", JOINT_STATE + HEADER + TIME
            ),
            "cdr",
            JOINTS,
        ),
        (
            Schema("sensor_msgs/JointState", "ros1msg", JOINT_STATE + HEADER_ROS1),
            "ros1",
            JOINTS_ROS1,
        ),
        (Schema("sensor_msgs/msg/JointState"), "cdr", JOINTS),
        (Schema("sensor_msgs::msg::dds_::JointState_"), "cdr", JOINTS),
        # What a definition does not bring along is ROS's own.
        (Schema("sensor_msgs/JointState", "ros2msg", JOINT_STATE), "cdr", JOINTS),
    ],
    ids=["ros2", "ros1", "no definition", "name of DDS", "no dependencies"],
)
def test_a_recorded_message_is_read(
    types: MessageTypes, schema: Schema, encoding: str, payload: bytes
) -> None:
    decoder = types.decoder(schema, encoding)
    assert decoder.type_name == "sensor_msgs/msg/JointState"
    assert decoder.encoding == encoding
    message = decoder.decode(payload)
    assert (decoder.reason, decoder.note) == (None, None)
    stamp = message.header.stamp
    assert (stamp.sec, stamp.nanosec) == (1_750_000_000, 100_000_000)
    assert message.name == ["drivewhl_l_joint", "drivewhl_r_joint"]
    assert message.position.tolist() == [0.25, 0.25]
    assert message.velocity.tolist() == [2.5, 2.5]
    assert message.effort.tolist() == []


def test_arrays_are_read_only_views_of_the_message(types: MessageTypes) -> None:
    decoder = types.decoder(Schema("std_msgs/msg/UInt8MultiArray"), "cdr")
    payload = bytearray(struct.pack("<4sIII", b"\0\1\0\0", 0, 0, 1000) + bytes(1000))
    data = decoder.decode(payload).data
    assert len(data) == 1000 and not data.flags.writeable
    payload[-1] = 7
    assert data[-1] == 7


def test_the_other_byte_order_is_read(types: MessageTypes) -> None:
    decoder = types.decoder(Schema("geometry_msgs/msg/Point"), "cdr")
    point = decoder.decode(struct.pack(">4s3d", b"\0\0\0\0", 1, 2, 3))
    assert (point.x, point.y, point.z) == (1, 2, 3)


def test_json_is_a_dict(types: MessageTypes) -> None:
    decoder = types.decoder(Schema("foxglove.Log", "jsonschema", "{}"), "json")
    assert (decoder.type_name, decoder.reason) == ("foxglove.Log", None)
    assert decoder.decode(b'{"level": 2}') == {"level": 2}
    for payload in (b"", b"[1]", b"{", b"\xff\xfe", b"[" * 10**5, b"1" * 10**5):
        with pytest.raises(DecodeError, match="JSON"):
            decoder.decode(payload)


def test_comments_and_blank_lines_are_no_fields(types: MessageTypes) -> None:
    text = "\r\n# two\r\n  # of them\n\nuint8 a # one\n\t\nstring S=x # of it\nuint8 b"
    decoder = types.decoder(Schema("x/Two", "ros2msg", text), "cdr")
    message = decoder.decode(b"\0\1\0\0\5\6")
    assert (message.a, message.b) == (5, 6)


def test_an_empty_definition_is_an_empty_message(types: MessageTypes) -> None:
    decoder = types.decoder(Schema("my_lab/msg/Ping", "ros2msg", ""), "cdr")
    assert decoder.reason is None
    decoder.decode(b"\0\1\0\0\0")
    decoder = types.decoder(Schema("my_lab/Ping", "ros1msg", ""), "ros1")
    decoder.decode(b"")


def test_a_definition_of_idl_is_read(types: MessageTypes) -> None:
    text = (
        LINE + "IDL: my_lab/msg/Level\n"
        "module my_lab { module msg { struct Level {\n"
        "  double value; string unit; sequence<float, 4> more; float three[3];\n"
        "}; }; };\n"
    )
    decoder = types.decoder(Schema("my_lab/msg/Level", "ros2idl", text), "cdr")
    assert decoder.reason is None
    payload = struct.pack("<4sdI2sxxI4f", b"\0\1\0\0", 1.5, 2, b"m", 1, 5, 1, 2, 3)
    message = decoder.decode(payload)
    assert (message.value, message.unit) == (1.5, "m")
    assert (message.more.tolist(), message.three.tolist()) == ([5], [1, 2, 3])


def test_the_event_of_a_service_is_read(types: MessageTypes) -> None:
    text = "bool data\n---\nbool success\nstring message\n"
    decoder = types.decoder(
        Schema("std_srvs/srv/SetBool_Event", "ros2msg", text), "cdr"
    )
    assert decoder.type_name == "std_srvs/srv/SetBool_Event"
    assert decoder.reason is None
    head = struct.pack("<4sBxxxiI16s4xq", b"\0\1\0\0", 1, 5, 6, bytes(16), 7)
    message = decoder.decode(head + struct.pack("<IBxxxI", 1, 1, 0))
    assert message.info.sequence_number == 7
    assert [request.data for request in message.request] == [True]
    assert message.response == []


@pytest.mark.parametrize("more", [b"\0" * 8, b"\1" * 3, b"\1" * 40])
def test_bytes_behind_a_message_are_tolerated(types: MessageTypes, more: bytes) -> None:
    schema = Schema("sensor_msgs/msg/JointState", "ros2msg", JOINT_STATE)
    decoder = types.decoder(schema, "cdr")
    assert decoder.decode(JOINTS + more).position.tolist() == [0.25, 0.25]
    assert decoder.note is None


NO_SUCH = "is broken (no definition of sensor_msgs/msg/No, the type of a field)"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("uint8 level\n", "does not fit its messages"),
        ("string a\n", "does not fit its messages"),
        ("", "does not fit its messages"),
        ("{", "is broken (its definition cannot be parsed)"),
        ("No such\n", NO_SUCH),
        ("No such {text\n", NO_SUCH),
    ],
)
def test_the_standard_type_is_taken_when_the_definition_is_wrong(
    text: str, fault: str
) -> None:
    schema = Schema("sensor_msgs/msg/JointState", "ros2msg", text)
    decoder = MessageTypes().decoder(schema, "cdr")
    for _ in range(2):
        assert decoder.decode(JOINTS).position.tolist() == [0.25, 0.25]
    assert decoder.note is not None and decoder.note.code == "definition-wrong"
    assert decoder.note.text == (
        f"the definition that came with it {fault}, so the standard "
        "sensor_msgs/msg/JointState is used; record with the same version of the "
        "package as the publisher"
    )


def test_types_that_have_changed_are_read_without_a_definition() -> None:
    """Since Galactic a Marker has more fields at its end than Foxy's."""
    from rosbags.typesys import Stores, get_typestore

    for store in (Stores.ROS2_FOXY, Stores.ROS2_JAZZY):
        known = get_typestore(store)
        marker = random_message(known, "visualization_msgs/msg/Marker", 3)
        payload = known.serialize_cdr(marker, "visualization_msgs/msg/Marker")
        decoder = MessageTypes().decoder(Schema("visualization_msgs/Marker"), "cdr")
        assert decoder.decode(payload).text == marker.text
        assert decoder.note is None


@pytest.mark.parametrize(
    ("encoding", "word"),
    [("protobuf", "descriptor"), ("x-lab", "x-lab"), ("", "no encoding")],
)
def test_an_encoding_that_is_not_read_has_its_reason(
    types: MessageTypes, encoding: str, word: str
) -> None:
    decoder = types.decoder(Schema("lab.Blob", encoding, b"\xff"), encoding)
    assert decoder.reason is not None and decoder.reason.code == "encoding"
    assert word in decoder.reason.text
    with pytest.raises(DecodeError):
        decoder.decode(b"")


HOSTILE = {
    "a name that is code": ("x/msg/A\n  import os", "ros2msg", "uint8 a\n"),
    "a name that is a path": ("../../etc/msg/passwd", "ros2msg", ""),
    "contains itself": ("x/msg/A", "ros2msg", "A[] a\n"),
    "an array of 10^12": ("x/msg/A", "ros2msg", f"B[{10**12}] b\n{LINE}MSG: x/B\n"),
    "texts, 10^9 of them": ("x/msg/A", "ros2msg", f"string[{10**9}] b\n"),
    "arrays in arrays": (
        "x/A",
        "ros1msg",
        "".join(f"B{n + 1}[99] b\n{LINE}MSG: x/B{n + 1}\n" for n in range(9)),
    ),
    "deep": (
        "x/A",
        "ros2msg",
        "".join(f"B{n + 1} b\n{LINE}MSG: x/B{n + 1}\n" for n in range(999))
        + "bool b\n",
    ),
    "long": ("x/A", "ros2msg", "uint8 a\n" * 10**6),
    "many fields": (
        "x/A",
        "ros2msg",
        "".join(f"bool b{n}\n" for n in range(6000)),
    ),
    "an endless number": ("x/A", "ros2msg", f"uint8[{'9' * 10**4}] a\n"),
    "no text": ("x/A", "ros2msg", b"\xff\xfe\0\0"),
    "many brackets": ("x/msg/A", "ros2idl", "module x {" * 10**4),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_definition_can_do_no_harm(types: MessageTypes, name: str) -> None:
    schema = Schema(*HOSTILE[name])
    for encoding in ("cdr", "ros1"):
        decoder = types.decoder(schema, encoding)
        assert decoder.reason is not None and decoder.reason.code == "type-unknown"
        assert len(decoder.reason.text) < 500
        with pytest.raises(DecodeError):
            decoder.decode(bytes(100))


def idl(field: str) -> str:
    return f"module x {{ module msg {{ struct A {{ {field} a; }}; }}; }};"


@pytest.mark.parametrize(
    ("word", "language", "text"),
    [
        *(
            (word, "ros2msg", f"{written} a\n")
            for word in ("wstring", "wchar", "float128")
            for written in (word, f"{word}[]", f"{word}[<=2]", f"{word}[2]")
        ),
        ("wstring", "ros2msg", "wstring<=3[<=2] a\n"),
        ("wstring", "ros2msg", f"B b\n{LINE}MSG: x/B\nwstring<=3 a\n"),
        ("wstring", "ros2idl", idl("wstring")),
        ("wchar", "ros2idl", idl("wchar")),
        ("float128", "ros2idl", idl("long double")),
        ("float128", "ros2idl", idl("sequence<long double>")),
    ],
)
def test_a_field_that_is_not_read_is_named_and_no_folder_is_asked_for(
    types: MessageTypes, word: str, language: str, text: str
) -> None:
    decoder = types.decoder(Schema("x/msg/A", language, text), "cdr")
    assert decoder.reason is not None and decoder.reason.code == "encoding"
    assert f"has a {word}, which is not read yet" in decoder.reason.text
    assert "--msg-path" not in decoder.reason.text
    with pytest.raises(DecodeError):
        decoder.decode(bytes(100))


def test_a_definition_in_another_language_is_named(
    types: MessageTypes, tmp_path: Path
) -> None:
    schema = Schema("my_lab/msg/Level", "asn1", "Level ::= REAL")
    reason = types.decoder(schema, "cdr").reason
    assert reason is not None and reason.code == "encoding"
    assert "its definition is asn1, which is not read yet" in reason.text
    # The remedy that it names.
    assert "--msg-path" in reason.text
    folder = tmp_path / "my_lab" / "msg"
    folder.mkdir(parents=True)
    (folder / "Level.msg").write_text("float64 value\n", "utf-8")
    decoder = MessageTypes([tmp_path]).decoder(schema, "cdr")
    assert decoder.decode(struct.pack("<4sd", b"\0\1\0\0", 2.5)).value == 2.5
    # ROS's own types need no text.
    known = types.decoder(Schema("geometry_msgs::msg::dds_::Point_", "omgidl"), "cdr")
    assert known.decode(b"\0\1\0\0" + struct.pack("<3d", 1, 2, 3)).z == 3


def test_what_displays_draw_is_known_without_a_definition(types: MessageTypes) -> None:
    for meaning in Meaning:
        if meaning.display is not None:
            decoder = types.decoder(Schema(meaning.value), "cdr")
            assert decoder.reason is None, meaning
            types.shape(meaning.value)


def test_definitions_in_the_idl_of_omg_are_read(types: MessageTypes) -> None:
    text = "module my_lab { module msg { struct Level { double value; }; }; };"
    for name in ("my_lab/msg/Level", "my_lab::msg::Level", "my_lab::msg::dds_::Level_"):
        decoder = types.decoder(Schema(name, "omgidl", text), "cdr")
        assert decoder.decode(struct.pack("<4sd", b"\0\1\0\0", 2.5)).value == 2.5


@pytest.mark.parametrize("name", ["tf2_msgs/TFMessage", "tf/tfMessage"])
@pytest.mark.parametrize("language", ["", "ros1msg"])
def test_transforms_of_ros_1_are_known_without_a_definition(
    types: MessageTypes, name: str, language: str
) -> None:
    text = "geometry_msgs/TransformStamped[] transforms\n" if language else ""
    decoder = types.decoder(Schema(name, language, text), "ros1")
    assert decoder.reason is None
    head = struct.pack("<IIIII4sI5s", 1, 7, 5, 9, 4, b"odom", 5, b"wheel")
    (found,) = decoder.decode(head + struct.pack("<7d", 1, 2, 3, 0, 0, 0, 1)).transforms
    assert (found.header.seq, found.header.frame_id) == (7, "odom")
    assert (found.child_frame_id, found.transform.translation.z) == ("wheel", 3)


@pytest.mark.parametrize("field", ["Empty", "string", "float64", "uint8"])
def test_an_announced_length_costs_nothing(types: MessageTypes, field: str) -> None:
    text = f"{field}[] many\n{LINE}MSG: x/Empty\n"
    for language, encoding in (("ros2msg", "cdr"), ("ros1msg", "ros1")):
        decoder = types.decoder(Schema("x/Many", language, text), encoding)
        payload = b"\0\1\0\0" * (encoding == "cdr") + struct.pack("<I", 10**9)
        for size in (0, 1, 100):
            with pytest.raises(DecodeError):
                decoder.decode(payload + bytes(size))


def test_4000_channels_of_one_type_cost_one(monkeypatch: pytest.MonkeyPatch) -> None:
    made = 0
    parse = types_module.parse

    def counted(*given: object) -> object:
        nonlocal made
        made += 1
        return parse(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(types_module, "parse", counted)
    types = MessageTypes()
    decoders = {
        types.decoder(Schema("my_lab/msg/A", "ros2msg", "uint8 a\n" + "#" * 9), "cdr")
        for _ in range(4000)
    }
    assert (made, len(decoders)) == (1, 1)


def test_definitions_are_found_below_the_folders_of_ament(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "share" / "my_lab" / "msg"
    folder.mkdir(parents=True)
    (folder / "Grip.msg").write_text("Finger[2] fingers # both\n", "utf-8")
    (folder / "Finger.msg").write_text("float64 force\nuint8 OPEN=0\n", "utf-8")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/none:{tmp_path}")
    decoder = MessageTypes().decoder(Schema("my_lab/msg/Grip"), "cdr")
    message = decoder.decode(struct.pack("<4s2d", b"\0\1\0\0", 1, 2))
    assert [finger.force for finger in message.fingers] == [1, 2]


def random_message(store: object, name: str, seed: int) -> object:
    from random_messages import random_message as made

    return made(store, name, seed)


def test_json_of_a_bridge_has_the_name_of_its_type(types: MessageTypes) -> None:
    decoder = types.decoder(Schema("std_msgs/String"), "json")
    assert decoder.type_name == "std_msgs/msg/String"
    assert decoder.decode(json.dumps({"data": "é"}).encode()) == {"data": "é"}


def test_a_cloud_is_not_copied(types: MessageTypes) -> None:
    decoder = types.decoder(Schema("std_msgs/msg/Float32MultiArray"), "cdr")
    payload = struct.pack("<4sIII", b"\0\1\0\0", 0, 0, 10**5) + bytes(4 * 10**5)
    data = decoder.decode(payload).data
    assert np.shares_memory(data, np.frombuffer(payload, np.uint8))
