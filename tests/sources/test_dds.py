"""What a source over DDS does beside what every source does.

The peer plays nodes with rmw_cyclonedds_cpp; see dds_peer.py. test_real_rclpy.py has
those of ROS itself, with Fast DDS.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib import metadata
from pathlib import Path

import pytest
from dds_peer import ANY_HASH, DdsPeer
from live_peers import Inbox, cdr_string, eventually
from lower_limit import lower

from sambot_viz.errors import DecodeError, UsageError
from sambot_viz.messages import MessageTypes
from sambot_viz.sources import registry
from sambot_viz.sources.dds import names, raw
from sambot_viz.sources.dds.trouble import nothing
from sambot_viz.sources.ros_endpoint import Kind
from sambot_viz.sources.ros_graph import NO_HASH
from sambot_viz.sources.source import Source

Open = Callable[[str], Source]


@pytest.fixture
def robot() -> Iterator[DdsPeer]:
    made = DdsPeer()
    yield made
    made.stop()


def test_the_private_names_are_those_of_the_version_that_is_pinned(
    repository: Path,
) -> None:
    assert metadata.version("cyclonedds") == raw.VERSION
    pinned = f'"cyclonedds=={raw.VERSION}"'
    assert (repository / "pyproject.toml").read_text("utf-8").count(pinned) == 2


def test_a_topic_says_who_publishes_it_and_how(robot: DdsPeer, opened: Open) -> None:
    robot.advertise("/map", latched=True, node="/lab/map_server")
    robot.advertise("/scan", is_loose=True)
    source = opened(robot.uri)
    eventually(lambda: source.topics()["/map"].publishers == ("/lab/map_server",))
    offered = {name: one.qos for name, one in source.topics().items()}
    assert offered["/map"] is not None and offered["/scan"] is not None
    assert offered["/map"].durability == "transient_local"
    assert offered["/scan"].reliability == "best_effort"


def test_a_publisher_that_offers_less_is_heard_beside_others(
    robot: DdsPeer, opened: Open, inbox: Inbox
) -> None:
    robot.advertise("/scan")
    source = opened(robot.uri)
    source.subscribe("/scan", inbox)
    eventually(lambda: robot.subscribed() == ["/scan"])
    robot.remove("/scan")
    robot.advertise("/scan", is_loose=True)

    def comes() -> bool:
        robot.publish("/scan", "seen")
        return "seen" in inbox.strings()

    eventually(comes)


@pytest.mark.parametrize("id_size", [names.ENDPOINT_ID, names.OLD_ENDPOINT_ID])
def test_the_nodes_of_a_participant_are_read_as_every_ros_2_writes_them(
    id_size: int,
) -> None:
    reader, writer = bytes(range(16)), bytes(range(16, 32))
    ids = [bytes(16), reader, writer]
    message = names.nodes_message(*ids[:1], "/viewer", ids[1:2], ids[2:])
    for one in ids:
        message = message.replace(one, one + bytes(id_size - 16), 1)
    participant, found = names.nodes_of(message, id_size)
    assert participant == bytes(id_size)
    assert found == {reader: "/viewer", writer: "/viewer"}


@pytest.mark.parametrize(
    "message",
    [
        b"",
        b"\0\1\0\0",
        b"\0\1\0\0" + bytes(16) + b"\xff\xff\xff\xff",
        b"\0\1\0\0" + bytes(16) + b"\2\0\0\0" + b"\xff\0\0\0/",
    ],
)
def test_nodes_that_make_no_sense_cost_only_themselves(message: bytes) -> None:
    with pytest.raises(ValueError, match="it "):
        names.nodes_of(message, names.ENDPOINT_ID)


@pytest.mark.parametrize(
    ("topic", "wire_type", "is_writer", "kind"),
    [
        ("rt/a/b", "std_msgs::msg::dds_::String_", True, Kind.PUBLISHER),
        ("rt/a/b", "std_msgs::msg::dds_::String_", False, Kind.SUBSCRIBER),
        ("rq/a/bRequest", "std_srvs::srv::dds_::Empty_Request_", False, Kind.SERVICE),
        ("rq/a/bRequest", "std_srvs::srv::dds_::Empty_Request_", True, None),
        ("rr/a/bReply", "std_srvs::srv::dds_::Empty_Response_", True, None),
        ("a/b", "std_msgs::msg::dds_::String_", True, None),
        ("rt/a/b", "Some::Other", True, None),
    ],
)
def test_topics_of_dds_are_those_of_ros_by_their_names(
    topic: str, wire_type: str, is_writer: bool, kind: Kind | None
) -> None:
    found = names.named(topic, wire_type, is_writer)
    assert (found and found.kind) == kind
    assert found is None or found.name == "/a/b"


def test_two_definitions_of_a_type_are_told_apart_by_message(
    robot: DdsPeer, opened: Open, inbox: Inbox
) -> None:
    robot.advertise("/words")
    source = opened(robot.uri)
    source.subscribe("/words", inbox)
    eventually(lambda: robot.subscribed() == ["/words"])
    robot.publish("/words", "new")
    inbox.wait_for("new")
    robot.advertise("/words", type_hash=ANY_HASH)

    def comes() -> bool:
        robot.publish("/words", "of another")
        return len({one.channel.schema.text for one in inbox.messages}) == 2

    eventually(comes)


def test_a_robot_with_another_definition_of_a_type_gets_none_of_it(
    robot: DdsPeer, opened: Open
) -> None:
    source = opened(robot.uri)
    eventually(lambda: source.status.is_connected)
    outgoing = source.advertise("/words", "std_msgs/msg/String")
    robot.listen_as("/words", "/listener", type_hash=ANY_HASH)
    eventually(lambda: "another definition of std_msgs" in outgoing.refused)
    assert names.type_hash_of(b"") == names.type_hash_of(b"typehash=x;") == NO_HASH


def test_a_receiver_whose_qos_cannot_match_is_named(
    robot: DdsPeer, opened: Open
) -> None:
    source = opened(robot.uri)
    eventually(lambda: source.status.is_connected)
    outgoing = source.advertise("/map", "std_msgs/msg/String")
    robot.listen_as("/map", "/lab/costmap", is_latched=True)
    eventually(lambda: outgoing.refused.startswith("/lab/costmap gets only from"))
    robot.listen_as("/map", "/lab/other")
    eventually(lambda: outgoing.refused == "")


def test_a_message_that_is_too_large_costs_only_itself(
    robot: DdsPeer, opened: Open, inbox: Inbox, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "MESSAGE", 10_000)
    robot.advertise("/chatter")
    source = opened(robot.uri)
    source.subscribe("/chatter", inbox)
    eventually(lambda: robot.subscribed() == ["/chatter"])
    # One is told of, the other is more than is taken from the network at all.
    robot.publish("/chatter", "x" * 15_000)
    robot.publish("/chatter", "x" * 30_000)
    robot.publish("/chatter", "small")
    inbox.wait_for("small")
    eventually(lambda: "a message is left out" in source.topics()["/chatter"].left_out)


def test_a_message_that_lies_about_its_length_costs_only_itself(
    robot: DdsPeer, opened: Open
) -> None:
    came = Inbox()
    robot.advertise("/chatter")
    source = opened(robot.uri)
    source.subscribe("/chatter", came)
    eventually(lambda: robot.subscribed() == ["/chatter"])
    robot.log("/chatter", b"\0\1\0\0\xff\xff\xff\x7fno")
    robot.publish("/chatter", "sense")
    eventually(lambda: len(came.messages) == 2)
    decoder = MessageTypes().decoder(came.messages[0].channel.schema, "cdr")
    with pytest.raises(DecodeError):
        decoder.decode(came.messages[0].payload)
    assert decoder.decode(came.messages[1].payload).data == "sense"


def test_another_domain_at_the_same_place_is_not_heard(opened: Open) -> None:
    robot = DdsPeer(domain=3)
    robot.advertise("/chatter")
    here, there = opened(robot.uri), opened(f"{robot.uri}&domain=3")
    eventually(lambda: "/chatter" in there.topics())
    eventually(lambda: robot.absent in here.status.sentence)
    assert not here.topics()
    robot.stop()


def test_many_topics_are_listed_up_to_a_limit(
    robot: DdsPeer, opened: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "TOPICS", 20)
    for number in range(30):
        robot.advertise(f"/topic{number}")
    source = opened(robot.uri)
    eventually(lambda: "only the first 20" in source.status.sentence)
    # The topics of a tick are handed on after its sentence.
    eventually(lambda: len(source.topics()) == 20)


def test_what_is_sent_before_somebody_is_found_comes(
    robot: DdsPeer, opened: Open
) -> None:
    source = opened(robot.uri)
    eventually(lambda: source.status.is_connected)
    outgoing = source.advertise("/goal", "std_msgs/msg/String")
    for word in ("one", "two"):
        outgoing.send(cdr_string(word))
    eventually(lambda: len(robot.came()) == 2)


@pytest.mark.parametrize(
    ("uri", "ports", "why"),
    [
        ("dds:", (7400 + 250 * 7,), "some of domain 7: --source 'dds:?domain=7'"),
        (
            "dds:?interface=lo&peer=robot",
            (7412 + 250 * 7, 7413 + 250 * 7),
            "'dds:?domain=7&interface=lo&peer=robot'",
        ),
        ("dds:", (7400, 11811), "start them without ROS_DISCOVERY_SERVER"),
        (
            "dds:",
            (7400, 7412 + 250 * 7),
            "rmw_zenoh_cpp needs --source zenoh://HOST:7447",
        ),
        ("dds:", (), "localhost only: --source 'dds:?interface=lo&peer=127.0.0.1'"),
        ("dds:?domain=7", (), "--source 'dds:?domain=7&peer=HOST'"),
        ("dds:?domain=7&peer=robot", (), "firewall open for UDP from port 9150 on"),
    ],
)
def test_where_nobody_answers_it_is_said_what_helps(
    uri: str, ports: tuple[int, ...], why: str
) -> None:
    assert why in nothing(registry.live_address(uri), ports)


@pytest.mark.parametrize(
    ("uri", "label", "peers"),
    [
        ("dds:", "DDS domain 0", ()),
        ("dds:?domain=7", "DDS domain 7", ()),
        ("dds://robot?domain=7", "DDS domain 7 at robot", ("robot",)),
        ("dds:?peer=a,[::1]:7410&interface=lo", "DDS domain 0 at a, [::1]:7410", None),
        ("dds:?interface=lo", "DDS domain 0 at lo", ()),
    ],
)
def test_an_address_names_a_domain_and_who_is_asked(
    uri: str, label: str, peers: tuple[str, ...] | None
) -> None:
    address = registry.live_address(uri)
    assert address.label == label
    assert peers is None or address.peers == peers


@pytest.mark.parametrize(
    ("uri", "why"),
    [
        ("dds:?domain=233", "from 0 to 232"),
        ("dds:?peers=robot", "unknown 'peers'"),
        ('dds:?interface="/><x', "is no host and no interface"),
    ],
)
def test_an_address_that_makes_no_sense_is_refused(uri: str, why: str) -> None:
    with pytest.raises(UsageError, match=why):
        registry.live_address(uri)


def test_an_interface_that_is_not_there_is_said(opened: Open) -> None:
    source = opened("dds:?interface=nowhere0&peer=127.0.0.1")
    eventually(lambda: "network interface nowhere0" in source.status.sentence)


def test_the_package_is_not_imported_before_there_is_a_connection() -> None:
    script = (
        "import sys\n"
        "from sambot_viz.sources.registry import open_source\n"
        "open_source('dds:').close()\n"
        "assert 'cyclonedds' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True)
