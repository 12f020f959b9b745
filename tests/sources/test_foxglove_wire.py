"""Frames of Foxglove's protocol, byte for byte."""

from __future__ import annotations

import pytest

from sambot_viz.messages import Schema
from sambot_viz.sources import foxglove_wire as wire


def from_hex(words: str) -> bytes:
    return bytes.fromhex(words)


def test_a_message_is_subscription_log_time_and_payload() -> None:
    frame = from_hex("01 07000000 58622 7b4db96ea18 00010000616263".replace(" ", ""))
    parsed = wire.parse_binary(frame)
    assert isinstance(parsed, wire.MessageFrame)
    assert (parsed.subscription_id, parsed.log_ns) == (7, 0x18EA96DBB4276258)
    assert bytes(parsed.payload) == b"\0\1\0\0abc"
    assert parsed.payload.obj is frame, "a view of the frame, not a copy"


def test_a_message_may_be_empty() -> None:
    parsed = wire.parse_binary(from_hex("01 01000000 0200000000000000"))
    assert isinstance(parsed, wire.MessageFrame)
    assert bytes(parsed.payload) == b""


def test_the_time_is_in_nanoseconds() -> None:
    parsed = wire.parse_binary(from_hex("02 0500000000000000"))
    assert parsed == wire.TimeFrame(5)


def test_an_asset_is_a_file_or_the_text_of_a_refusal() -> None:
    good = wire.parse_binary(from_hex("04 01000000 00 00000000 616263"))
    assert good == wire.AssetFrame(1, None, b"abc")
    with_text = wire.parse_binary(from_hex("04 01000000 00 02000000 4f4b 616263"))
    assert with_text == wire.AssetFrame(1, None, b"abc")
    bad = wire.parse_binary(from_hex("04 02000000 01 02000000 6eff"))
    assert bad == wire.AssetFrame(2, "n\N{REPLACEMENT CHARACTER}", b"")


@pytest.mark.parametrize("opcode", [0, 5, 6, 99, 255])
def test_frames_of_other_kinds_are_passed_over(opcode: int) -> None:
    assert wire.parse_binary(bytes([opcode])) is None


@pytest.mark.parametrize(
    "frame",
    [
        "",
        "01",
        "01 07000000 00000000000000",
        "02 00000000000000",
        "03 01000000 01000000",
        "03 01000000 01000000 04000000 6364",
        "04 01000000 01",
        "04 01000000 01 03000000 6162",
        "04 01000000 00 ffffffff 616263",
    ],
)
def test_a_frame_that_is_shorter_than_it_says_is_malformed(frame: str) -> None:
    with pytest.raises(wire.Malformed):
        wire.parse_binary(from_hex(frame))


def test_the_server_says_who_it_is() -> None:
    parsed = wire.parse_text(
        '{"op":"serverInfo","name":"robot","capabilities":["time","assets"],'
        '"supportedEncodings":["cdr"],"metadata":{},"sessionId":"17"}'
    )
    assert parsed.content == wire.ServerInfo(
        "robot", ("time", "assets"), ("cdr",), "17"
    )


def advertised(entry: str) -> wire.ServerChannel:
    parsed = wire.parse_text(f'{{"op":"advertise","channels":[{entry}]}}')
    assert isinstance(parsed.content, wire.Advertised)
    (channel,) = parsed.content.channels
    return channel


def test_a_channel_has_its_schema_in_band() -> None:
    channel = advertised(
        '{"id":1,"topic":"/a","encoding":"cdr","schemaName":"std_msgs/msg/String",'
        '"schemaEncoding":"ros2msg","schema":"string data"}'
    )
    assert (channel.id, channel.topic, channel.encoding) == (1, "/a", "cdr")
    expected = Schema("std_msgs/msg/String", "ros2msg", "string data")
    assert channel.definition() == expected


def test_older_servers_do_not_say_how_the_schema_is_written() -> None:
    channel = advertised(
        '{"id":1,"topic":"/a","encoding":"ros1","schemaName":"std_msgs/String",'
        '"schema":"string data"}'
    )
    expected = Schema("std_msgs/String", "ros1msg", "string data")
    assert channel.definition() == expected


def test_a_bridge_without_the_definition_leaves_it_empty() -> None:
    channel = advertised(
        '{"id":1,"topic":"/a","encoding":"","schemaName":"my/msg/Own","schema":null}'
    )
    assert channel.definition() == Schema("my/msg/Own", "", "")


def test_schemas_of_protobuf_are_in_base64() -> None:
    entry = (
        '{"id":1,"topic":"/a","encoding":"protobuf","schemaName":"A",'
        '"schemaEncoding":"protobuf","schema":"%s"}'
    )
    assert advertised(entry % "AAEC").definition().text == b"\0\1\2"
    assert advertised(entry % "!").definition().text == b""


def test_a_channel_that_makes_no_sense_does_not_hide_the_others() -> None:
    parsed = wire.parse_text(
        '{"op":"advertise","channels":[{"id":"one","topic":"/a"},null,'
        '{"id":2,"topic":"/b"},{"id":-1,"topic":"/c"},{"id":3}]}'
    )
    assert isinstance(parsed.content, wire.Advertised)
    assert [one.topic for one in parsed.content.channels] == ["/b"]
    assert parsed.malformed == 4


def test_the_other_frames_of_a_server() -> None:
    def content(frame: str) -> object:
        return wire.parse_text(frame).content

    assert content('{"op":"unadvertise","channelIds":[1,2]}') == wire.Unadvertised(
        (1, 2)
    )
    status = '{"op":"status","level":2,"message":"full","id":"a"}'
    assert content(status) == wire.ServerStatus(2, "full", "a")
    removed = '{"op":"removeStatus","statusIds":["a"]}'
    assert content(removed) == wire.StatusesRemoved(("a",))
    graph = (
        '{"op":"connectionGraphUpdate","publishedTopics":[{"name":"/a",'
        '"publisherIds":["/n"]}],"subscribedTopics":[{"name":"/a","subscriberIds":[]}],'
        '"advertisedServices":[],"removedTopics":["/b"],"removedServices":[]}'
    )
    published = wire.TopicPublishers("/a", ("/n",))
    subscribed = wire.TopicSubscribers("/a")
    assert content(graph) == wire.GraphUpdate((published,), (subscribed,), ("/b",))
    values = (
        '{"op":"parameterValues","parameters":[{"name":"/n.p","value":1.5,'
        '"type":"float64"},{"name":"/n.q"},7],"id":"1"}'
    )
    parsed = wire.parse_text(values)
    assert parsed.content == wire.ParameterValues(
        (wire.ParameterValue("/n.p", 1.5, "float64"), wire.ParameterValue("/n.q"))
    )
    assert parsed.malformed == 1


def test_frames_that_are_not_needed_are_passed_over() -> None:
    assert wire.parse_text('{"op":"playbackState","status":0}').content is None


@pytest.mark.parametrize(
    "frame",
    [
        "",
        "{",
        "[]",
        "7",
        '{"op":7}',
        "{}",
        '{"op":"unadvertise","channelIds":[-1]}',
        '{"op":"unadvertise","channelIds":"all"}',
        '{"op":"advertise","channels":7}',
        '{"op":"serverInfo","capabilities":"time"}',
        '{"op":"advertise","channels":' + "[" * 100_000,
    ],
)
def test_text_that_makes_no_sense_is_malformed(frame: str) -> None:
    with pytest.raises(wire.Malformed):
        wire.parse_text(frame)


def test_what_a_client_says() -> None:
    assert wire.subscribe(7, 1) == (
        '{"op":"subscribe","subscriptions":[{"id":7,"channelId":1}]}'
    )
    assert wire.unsubscribe(7) == '{"op":"unsubscribe","subscriptionIds":[7]}'
    assert wire.fetch_asset("package://sam_bot/meshes/a.stl", 1) == (
        '{"op":"fetchAsset","uri":"package://sam_bot/meshes/a.stl","requestId":1}'
    )
    assert wire.get_parameters(["/n.p"], "q") == (
        '{"op":"getParameters","parameterNames":["/n.p"],"id":"q"}'
    )
    assert wire.subscribe_connection_graph() == '{"op":"subscribeConnectionGraph"}'


def test_the_qos_of_publishers_is_in_the_metadata_if_anywhere() -> None:
    entry = '{"id":1,"topic":"/a","metadata":%s}'
    offered = '{"offered_qos_profiles":"- reliability: best_effort"}'
    found = advertised(entry % offered).qos
    assert found is not None and found.reliability == "best_effort"
    for other in ("null", "{}", "[1]", '"a"', '{"offered_qos_profiles":7}'):
        assert advertised(entry % other).qos is None
