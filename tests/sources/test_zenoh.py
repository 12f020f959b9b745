"""What a source over zenoh does beside what every source does.

The peer plays nodes with rmw_zenoh_cpp; see zenoh_peer.py.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from a_certificate import self_signed, tls_settings
from live_peers import STRING, WAIT, FoxglovePeer, Inbox, cdr_string, eventually
from lower_limit import lower
from patience import until
from rosbags.typesys import Stores, get_typestore
from zenoh_peer import ANY_HASH, STAMP_NS, ZenohPeer, type_hash_of

from sambot_viz import extras
from sambot_viz.errors import DecodeError, UsageError
from sambot_viz.messages import MessageTypes
from sambot_viz.sources import registry
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import Kind
from sambot_viz.sources.ros_graph import NO_HASH
from sambot_viz.sources.source import Receivers, Source
from sambot_viz.sources.zenoh.names import TOKENS, parse_token, stamp_of
from sambot_viz.sources.zenoh.session import open_session

Open = Callable[[str], Source]
POSE = "geometry_msgs/msg/PoseStamped"


@pytest.fixture
def robot() -> Iterator[ZenohPeer]:
    made = ZenohPeer()
    yield made
    made.stop()


def test_a_token_says_of_an_endpoint_what_ros_knows() -> None:
    head = "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0/10"
    name = "std_msgs::msg::dds_::String_"
    token = parse_token(
        f"{head}/MP/%/%arm/talker/%arm%chatter/{name}/RIHS01_df6/2:1:2,7:,:,:,,"
    )
    assert token is not None and token.endpoint is not None
    assert (token.domain, token.node) == (2, "/arm/talker")
    found = token.endpoint
    assert (found.kind, found.name, found.type_name, found.type_hash) == (
        Kind.PUBLISHER,
        "/arm/chatter",
        STRING,
        "RIHS01_df6",
    )
    assert found.qos == Qos("best_effort", "transient_local", "keep_all", 7, True)
    usual = parse_token(f"{head}/MS/%/%/listener/%chatter/{name}/H/::,10:,:,:,,")
    assert usual is not None and usual.endpoint is not None
    assert usual.endpoint.qos == Qos("reliable", "volatile", "keep_last", 10)
    node = parse_token(f"{head}/NN/%/%/talker")
    assert node is not None and (node.node, node.endpoint) == ("/talker", None)


@pytest.mark.parametrize(
    "key",
    [
        "",
        "@ros2_lv/0",
        "@ros2_lv/x/z/0/10/NN/%/%/talker",
        "@ros2_lv/0/z/0/10/XX/%/%/talker",
        "@ros2_lv/0/z/0/10/MP/%/%/talker/%chatter/String/H/::,10",
        "@ros2_lv/0/z/0/10/MP/%/%/talker/%chatter",
    ],
)
def test_a_token_that_makes_no_sense_says_nothing(key: str) -> None:
    assert parse_token(key) is None


def test_a_topic_says_who_publishes_it_and_how(robot: ZenohPeer, opened: Open) -> None:
    robot.advertise("/map", latched=True, node="/lab/map_server")
    robot.advertise("/pose", type_name=POSE)
    source = opened(robot.uri)
    eventually(lambda: len(source.topics()) == 2)
    found = source.topics()["/map"]
    assert found.publishers == ("/lab/map_server",)
    assert found.qos is not None and found.qos.durability == "transient_local"
    text = source.topics()["/pose"].schema.text
    assert isinstance(text, str) and "MSG: geometry_msgs/Quaternion" in text


def test_a_message_says_when_it_was_published(
    robot: ZenohPeer, opened: Open, inbox: Inbox
) -> None:
    robot.advertise("/chatter")
    source = opened(robot.uri)
    source.subscribe("/chatter", inbox)
    eventually(lambda: robot.subscribed() == ["/chatter"])
    robot.publish("/chatter", "one")
    inbox.wait_for("one")
    assert inbox.messages[0].publish_ns == STAMP_NS
    # That was years ago.
    eventually(
        lambda: "h behind this computer's: `timedatectl`" in source.status.sentence
    )
    # Before 2024-11 nothing of that kind was attached, or text was.
    assert stamp_of(b"") is stamp_of(b"source_timestamp") is None


def test_older_publishers_are_asked_for_what_they_keep(
    robot: ZenohPeer, opened: Open, inbox: Inbox
) -> None:
    robot.is_old = True
    robot.advertise("/map", latched=True)
    robot.publish("/map", "hall")
    source = opened(robot.uri)
    source.subscribe("/map", inbox)
    inbox.wait_for("hall")


def test_where_there_is_no_node_it_is_said_what_shows_them(
    robot: ZenohPeer, opened: Open
) -> None:
    here, elsewhere = opened(robot.uri), opened(f"{robot.uri}?domain=7")
    robot.advertise("/chatter")
    eventually(lambda: "/chatter" in here.topics())
    until(lambda: "others have 0" in elsewhere.status.sentence, WAIT)
    assert f"--source '{robot.uri}?domain=0'" in elsewhere.status.sentence
    assert not elsewhere.topics()
    assert "no node" not in here.status.sentence


def test_a_router_without_nodes_says_how_they_would_be_there(opened: Open) -> None:
    robot = ZenohPeer(has_nodes=False)
    try:
        source = opened(robot.uri)
        until(lambda: "no node is connected" in source.status.sentence, WAIT)
        assert "RMW_IMPLEMENTATION=rmw_zenoh_cpp" in source.status.sentence
        assert f"tcp/{robot.uri.partition('//')[2]}" in source.status.sentence
    finally:
        robot.stop()


def test_a_router_has_told_all_when_it_says_so(robot: ZenohPeer) -> None:
    for number in range(200):
        robot.declare(f"@ros2_lv/0/z/0/{number}/NN/%/%/node{number}")
    told, end = set[str](), list[int]()
    # In the thread of zenoh itself, so in its order.
    session = open_session(
        registry.live_address(robot.uri), lambda action: action(), lambda: None
    )
    session.watch(
        TOKENS, lambda key, is_there: told.add(key), lambda: end.append(len(told))
    )
    eventually(lambda: end == [201])
    session.close()


def described(type_name: str, text: str) -> bytes:
    """The answer of a node's get_type_description, as ROS 2 writes it."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types = store.types
    field = types["type_description_interfaces/msg/IndividualTypeDescription"]
    whole = types["type_description_interfaces/msg/TypeDescription"](
        field(type_name, []), []
    )
    source = types["type_description_interfaces/msg/TypeSource"](type_name, "msg", text)
    name = "test_msgs/msg/Answer"
    from rosbags.typesys import get_types_from_msg

    store.register(
        get_types_from_msg(
            "bool successful\nstring failure_reason\n"
            "type_description_interfaces/TypeDescription type_description\n"
            "type_description_interfaces/TypeSource[] type_sources\n"
            "type_description_interfaces/KeyValue[] extra_information",
            name,
        )
    )
    made = store.types[name](True, "", whole, [source], [])
    return bytes(store.serialize_cdr(made, name))


def test_a_node_is_asked_for_a_type_that_ros_does_not_have(
    robot: ZenohPeer, opened: Open, inbox: Inbox
) -> None:
    kind = "lab_msgs/msg/Battery"
    robot.serve("/talker/get_type_description", reply=described(kind, "string state\n"))
    robot.advertise("/battery", True, kind, ANY_HASH)
    robot.publish("/battery", "full")
    source = opened(robot.uri)
    source.subscribe("/battery", inbox)
    eventually(lambda: source.topics()["/battery"].schema.text == "string state\n")

    def read() -> str:
        last = inbox.messages[-1]
        decoder = MessageTypes().decoder(last.channel.schema, "cdr")
        return decoder.decode(last.payload).state

    eventually(lambda: read() == "full")


def test_nodes_with_two_definitions_of_a_type_are_both_read(
    robot: ZenohPeer, opened: Open, inbox: Inbox
) -> None:
    robot.advertise("/chatter")
    source = opened(robot.uri)
    source.subscribe("/chatter", inbox)
    eventually(lambda: robot.subscribed() == ["/chatter"])
    robot.publish("/chatter", "new")
    inbox.wait_for("new")
    robot.advertise("/chatter", type_hash=NO_HASH)
    robot.publish("/chatter", "of Humble")
    inbox.wait_for("new", "of Humble")
    first, second = (one.channel for one in inbox.messages)
    assert first is not second
    assert first.schema.text


@pytest.mark.parametrize("type_hash", [type_hash_of(STRING), NO_HASH])
def test_it_is_published_with_the_definition_that_receivers_have(
    robot: ZenohPeer, opened: Open, type_hash: str
) -> None:
    robot.listen_as("/words", "/listener", type_hash=type_hash)
    robot.hashes = {type_hash}
    source = opened(robot.uri)
    eventually(lambda: source.status.is_connected)

    def sent() -> bool:
        outgoing = source.advertise("/words", STRING)
        eventually(lambda: outgoing.receivers == Receivers(("/listener",), STRING))
        outgoing.send(cdr_string("now"))
        eventually(lambda: robot.came())
        return True

    eventually(sent)


def test_a_robot_with_another_definition_of_a_type_gets_none_of_it(
    robot: ZenohPeer, opened: Open
) -> None:
    source = opened(robot.uri)
    eventually(lambda: source.status.is_connected)
    outgoing = source.advertise("/words", STRING)
    eventually(lambda: outgoing.receivers == Receivers(()))
    robot.listen_as("/words", "/listener", type_hash=ANY_HASH)
    eventually(lambda: "another definition of std_msgs" in outgoing.refused)
    eventually(lambda: robot.advertised() == [])


def test_a_type_without_a_known_definition_is_not_published(
    robot: ZenohPeer, opened: Open
) -> None:
    source = opened(robot.uri)
    eventually(lambda: source.status.is_connected)
    outgoing = source.advertise("/battery", "lab_msgs/msg/Battery")
    eventually(lambda: "lab_msgs/msg/Battery is not known" in outgoing.refused)


def test_a_message_that_is_too_large_costs_only_itself(
    robot: ZenohPeer,
    opened: Open,
    inbox: Inbox,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "MESSAGE", 100)
    robot.advertise("/chatter")
    source = opened(robot.uri)
    source.subscribe("/chatter", inbox)
    eventually(lambda: robot.subscribed() == ["/chatter"])
    robot.publish("/chatter", "x" * 200)
    robot.publish("/chatter", "small")
    inbox.wait_for("small")
    eventually(lambda: "a message is left out" in source.topics()["/chatter"].left_out)


def test_what_makes_no_sense_costs_only_itself(
    robot: ZenohPeer, opened: Open, inbox: Inbox
) -> None:
    for rest in ("0", "0/z/0/1/MP/%/%/n/%a/nonsense/H/::", "0/z/0/1/MP/%/%/n/%a"):
        robot.declare(f"@ros2_lv/{rest}")
    robot.advertise("/chatter")
    source = opened(robot.uri)
    source.subscribe("/chatter", inbox)
    eventually(lambda: robot.subscribed() == ["/chatter"])
    robot.log("/chatter", b"\xff")
    robot.publish("/chatter", "sense")
    eventually(lambda: inbox.strings()[-1:] == ["sense"])
    assert set(source.topics()) == {"/chatter"}
    types = MessageTypes()
    first = inbox.messages[0]
    with pytest.raises(DecodeError):
        types.decoder(first.channel.schema, "cdr").decode(first.payload)


def test_a_server_of_another_kind_is_named(opened: Open) -> None:
    peer = FoxglovePeer()
    source = opened(peer.uri.replace("foxglove", "zenoh"))
    until(lambda: "does not speak zenoh" in source.status.sentence, WAIT)
    peer.stop()


def test_a_router_behind_tls_is_trusted_by_its_certificate(
    opened: Open, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    key, certificate = self_signed(tmp_path)
    robot = ZenohPeer(protocol="tls", **tls_settings(key, certificate))
    robot.advertise("/chatter")
    uri = robot.uri.replace("zenoh:", "zenoh+tls:")
    source = opened(uri)
    until(lambda: "SSL_CERT_FILE" in source.status.sentence, WAIT)
    monkeypatch.setenv("SSL_CERT_FILE", str(certificate))
    trusting = opened(uri)
    until(lambda: "/chatter" in trusting.topics(), WAIT)
    robot.stop()


@pytest.mark.parametrize(
    ("uri", "why"),
    [
        ("zenoh://robot?domain=x", "from 0 to 232"),
        ("zenoh://robot?domain=233", "from 0 to 232"),
        ("zenoh://robot?domian=7", "unknown 'domian'"),
        ("zenoh+wss://robot", "unknown kind of source"),
        ("zenoh://", "write zenoh://HOST:7447"),
    ],
)
def test_an_address_that_makes_no_sense_is_refused(uri: str, why: str) -> None:
    with pytest.raises(UsageError, match=why.replace("?", ".")):
        registry.live_address(uri)


def test_without_its_package_one_line_says_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    for uri, package in (("zenoh://robot", "eclipse-zenoh"), ("dds:", "cyclonedds")):
        with pytest.raises(UsageError, match=f'pip install "{package}[^"]+"$'):
            registry.open_source(uri)
    assert registry.live_address("foxglove://robot").port == 8765


def test_the_package_is_not_imported_before_there_is_a_connection() -> None:
    script = (
        "import sys\n"
        "from sambot_viz.sources.registry import open_source\n"
        "open_source('zenoh://robot').close()\n"
        "assert 'zenoh' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True)


def test_a_connection_that_ends_with_a_topic_untold_is_made_again(
    robot: ZenohPeer, opened: Open, inbox: Inbox
) -> None:
    robot.advertise("/chatter")
    source = opened(robot.uri)
    eventually(lambda: "/chatter" in source.topics())
    robot.stop()
    # Its subscription cannot be told to the session that has just been lost.
    source.subscribe("/chatter", inbox)
    eventually(lambda: not source.status.is_connected)
    robot.start()
    eventually(lambda: robot.subscribed() == ["/chatter"])
    robot.publish("/chatter", "again")
    inbox.wait_for("again")
