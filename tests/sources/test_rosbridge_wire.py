"""Operations of rosbridge's protocol, byte for byte."""

from __future__ import annotations

import json

import pytest
from rosbridge_peer import cbor

from sambot_viz.messages import Schema
from sambot_viz.sources import rosbridge_wire as wire


def test_a_message_in_cbor_raw_is_the_bytes_of_ros() -> None:
    message = {"secs": 3, "nsecs": 5, "bytes": b"\0\1\0\0abc"}
    frame = cbor({"op": "publish", "topic": "/a", "msg": message})
    parsed = wire.parse_operation(frame)
    assert isinstance(parsed, wire.Publication)
    assert (parsed.topic, bytes(parsed.payload)) == ("/a", b"\0\1\0\0abc")
    assert (parsed.is_json, parsed.stamp_ns) == (False, 3_000_000_005)


def test_a_message_in_json_stays_as_it_is() -> None:
    frame = '{"op": "publish", "topic": "/a", "msg": {"data": [1.50, "ü"]}}'
    parsed = wire.parse_operation(frame)
    expected = '{"data": [1.50, "ü"]}'.encode()
    assert parsed == wire.Publication("/a", expected, True)


def test_numbers_that_json_does_not_have_are_kept() -> None:
    frame = '{"op":"publish","topic":"/a","msg":{"ranges":[NaN, Infinity, 1]}}'
    parsed = wire.parse_operation(frame)
    assert isinstance(parsed, wire.Publication)
    assert parsed.payload == b'{"ranges": [NaN, Infinity, 1]}'


def test_answers_and_lines_of_the_server() -> None:
    parsed = wire.parse_operation(
        '{"op":"service_response","service":"/rosapi/topics","id":"1","result":true,'
        '"values":{"topics":["/a"],"types":["std_msgs/msg/String"]}}'
    )
    assert isinstance(parsed, wire.ServiceResponse)
    found = wire.decode_values(parsed, wire.TopicList)
    assert (found.topics, found.types) == (("/a",), ("std_msgs/msg/String",))
    status = wire.parse_operation('{"op":"status","level":"error","msg":"no","id":"1"}')
    assert status == wire.StatusLine("error", "no", "1")
    assert wire.parse_operation('{"op":"serverInfo"}') == wire.ForeignOperation(
        "serverInfo"
    )


def test_a_service_that_failed_has_no_values() -> None:
    parsed = wire.parse_operation(
        '{"op":"service_response","id":"1","result":false,"values":"no such service"}'
    )
    assert isinstance(parsed, wire.ServiceResponse)
    with pytest.raises(wire.MalformedOperation, match="no such service"):
        wire.decode_values(parsed, wire.TopicList)
    with pytest.raises(wire.MalformedOperation):
        wire.decode_values(None, wire.TopicList)


@pytest.mark.parametrize(
    "frame",
    [
        "",
        "{",
        "NaN",
        "[NaN",
        "[NaN]",
        '{"op":"publish"}',
        '{"op":"publish","topic":7,"msg":{}}',
        '{"op":"publish","topic":7,"msg":NaN}',
        '{"op":"service_response","id":7}',
        b"",
        cbor(7),
        cbor({"op": "publish", "topic": "/a"}),
        cbor({"op": "publish", "topic": 7, "msg": {"bytes": b""}}),
        cbor({"op": "publish", "topic": "/a", "msg": {"bytes": "text"}}),
        cbor({"op": "publish", "topic": "/a", "msg": {"bytes": b"abc"}})[:-1],
        "[" * 100_000,
        "[NaN," * 100_000,
    ],
)
def test_what_makes_no_sense_is_malformed(frame: str | bytes) -> None:
    with pytest.raises(wire.MalformedOperation):
        wire.parse_operation(frame)


def test_the_server_drops_all_but_the_newest_message_for_us() -> None:
    words = wire.subscribe("s", "/scan", "sensor_msgs/msg/LaserScan", is_latched=False)
    assert words == (
        '{"op":"subscribe","id":"s","topic":"/scan",'
        '"type":"sensor_msgs/msg/LaserScan","compression":"cbor-raw",'
        '"queue_length":1,"throttle_rate":33}'
    )


@pytest.mark.parametrize(
    ("topic", "type_name", "is_latched"),
    [
        ("/tf", "tf2_msgs/msg/TFMessage", False),
        ("/tf", "tf2_msgs/TFMessage", False),
        ("/markers", "visualization_msgs/msg/MarkerArray", False),
        ("/joint_states", "sensor_msgs/msg/JointState", False),
        ("/robot_description", "std_msgs/msg/String", True),
    ],
)
def test_messages_that_do_not_replace_each_other_are_all_asked_for(
    topic: str, type_name: str, is_latched: bool
) -> None:
    asked = json.loads(wire.subscribe("s", topic, type_name, is_latched=is_latched))
    assert (asked["queue_length"], asked["throttle_rate"]) == (100, 0)


def test_the_server_finds_out_a_type_that_is_not_known() -> None:
    assert "type" not in json.loads(wire.subscribe("s", "/a", "", is_latched=False))


def test_what_else_a_client_says() -> None:
    assert wire.unsubscribe("s", "/a") == '{"op":"unsubscribe","id":"s","topic":"/a"}'
    assert wire.call_service("c", "/rosapi/publishers", topic="/a") == (
        '{"op":"call_service","id":"c","service":"/rosapi/publishers",'
        '"args":{"topic":"/a"}}'
    )


def test_the_name_of_a_type_says_which_ros_it_is() -> None:
    assert wire.encoding("std_msgs/msg/String") == "cdr"
    assert wire.encoding("std_msgs/String") == "ros1"
    assert wire.encoding("") == ""
    words = "string data"
    assert wire.definition("std_msgs/msg/String", words) == Schema(
        "std_msgs/msg/String", "ros2msg", words
    )
    assert wire.definition("std_msgs/String", words).encoding == "ros1msg"
    assert wire.definition("my_msgs/msg/Own", "").encoding == ""


def test_a_definition_in_pieces_is_put_together() -> None:
    details = wire.MessageDetails(
        (
            wire.FieldList(
                "my_msgs/Own",
                ("header", "names", "values", "matrix", "flag", "ranges", "points"),
                (
                    "std_msgs/Header",
                    "string",
                    "double",
                    "float64",
                    "boolean",
                    "sequence<float, 3>",
                    "geometry_msgs/Point32",
                ),
                (-1, 0, 0, 9, -1, -1, 2),
            ),
            wire.FieldList("geometry_msgs/Point32", ("x",), ("float",), (-1,)),
        )
    )
    assert wire.text_of_details(details) == (
        "std_msgs/Header header\n"
        "string[] names\n"
        "float64[] values\n"
        "float64[9] matrix\n"
        "bool flag\n"
        "float32[] ranges\n"
        "geometry_msgs/Point32[2] points\n"
        + "=" * 80
        + "\nMSG: geometry_msgs/Point32\nfloat32 x\n"
    )


def test_the_feedback_of_an_action_is_of_ros2_and_found_by_its_topic() -> None:
    kind = "nav2_msgs/action/NavigateToPose_FeedbackMessage"
    assert (wire.encoding(kind), wire.definition(kind, "a").encoding) == (
        "cdr",
        "ros2msg",
    )
    asked = wire.subscribe("1", "/a/_action/feedback", kind, is_latched=False)
    assert "type" not in json.loads(asked)
