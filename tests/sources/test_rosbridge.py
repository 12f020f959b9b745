"""rosbridge, its rosapi, and servers that lack something."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator

import pytest
from live_peers import WAIT, Inbox, cdr_string
from patience import until
from rosbridge_peer import RosbridgePeer

from sambot_viz.errors import SourceError
from sambot_viz.messages import Schema
from sambot_viz.sources import rosapi
from sambot_viz.sources.source import Source

Open = Callable[[str], Source]


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Iterator[RosbridgePeer]:
    monkeypatch.setattr(rosapi, "POLL", 0.1)
    monkeypatch.setattr(rosapi, "POLL_ABSENT", 0.1)
    peer = RosbridgePeer()
    yield peer
    peer.stop()


def test_a_topic_is_subscribed_to_again_when_its_publisher_appears(
    robot: RosbridgePeer, opened: Open, inbox: Inbox
) -> None:
    """RViz has subscribed to it, so it is listed; the robot starts later."""
    robot.advertise("/robot_description", latched=True)
    robot.there["/robot_description"].publishers = []
    source = opened(robot.uri)
    source.subscribe("/robot_description", inbox)
    until(lambda: robot.subscribed() == ["/robot_description"], WAIT)
    until(lambda: "/robot_description" in source.topics(), WAIT)
    until(lambda: source.topics()["/robot_description"].publishers == (), WAIT)
    # It publishes at once, before anybody can know: durability decides.
    robot.there["/robot_description"].kept.append(cdr_string("<robot/>"))
    robot.there["/robot_description"].publishers = ["/robot_state_publisher"]
    inbox.wait_for("<robot/>")
    assert robot.subscribed() == ["/robot_description"]
    assert len(robot.asked("unsubscribe")) == 1
    publishers = ("/robot_state_publisher",)
    until(lambda: source.topics()["/robot_description"].publishers == publishers, WAIT)


def test_a_topic_that_vanishes_and_comes_back_is_subscribed_to_afresh(
    robot: RosbridgePeer, opened: Open, inbox: Inbox
) -> None:
    robot.advertise("/map", latched=True)
    robot.publish("/map", "hall")
    source = opened(robot.uri)
    source.subscribe("/map", inbox)
    inbox.wait_for("hall")
    robot.remove("/map")
    until(lambda: robot.subscribed() == [], WAIT)
    robot.advertise("/map", latched=True)
    robot.publish("/map", "garden")
    inbox.wait_for("hall", "garden")


def test_a_topic_of_another_type_now_is_subscribed_to_with_it(
    robot: RosbridgePeer, opened: Open, inbox: Inbox
) -> None:
    robot.advertise("/a")
    source = opened(robot.uri)
    source.subscribe("/a", inbox)
    until(lambda: robot.subscribed() == ["/a"], WAIT)
    robot.there["/a"].type = "my_msgs/msg/Own"
    until(lambda: robot.asked("subscribe")[-1].get("type") == "my_msgs/msg/Own", WAIT)
    until(lambda: robot.subscribed() == ["/a"], WAIT)
    robot.publish("/a", "one")
    inbox.wait_for("one")
    assert inbox.messages[0].channel.schema.name == "my_msgs/msg/Own"


def test_a_server_without_cbor_raw_sends_json(
    robot: RosbridgePeer, opened: Open, inbox: Inbox
) -> None:
    robot.is_json = True
    robot.advertise("/a")
    source = opened(robot.uri)
    source.subscribe("/a", inbox)
    until(lambda: robot.subscribed() == ["/a"], WAIT)
    robot.publish("/a", "one")
    until(lambda: inbox.messages, WAIT)
    (message,) = inbox.messages
    assert message.channel.message_encoding == "json"
    assert message.channel.schema.name == "std_msgs/msg/String"
    assert message.payload == b'{"data": "one"}'


def test_definitions_come_in_pieces_where_the_full_text_is_not_to_be_had(
    robot: RosbridgePeer, opened: Open, inbox: Inbox
) -> None:
    del robot.services["/rosapi/topics_and_raw_types"]
    robot.services["/rosapi/message_details"] = lambda arguments: {
        "typedefs": [
            {
                "type": arguments["type"],
                "fieldnames": ["data"],
                "fieldtypes": ["string"],
                "fieldarraylen": [-1],
                "examples": [""],
                "constnames": [],
                "constvalues": [],
            }
        ]
    }
    robot.advertise("/a")
    source = opened(robot.uri)
    source.subscribe("/a", inbox)
    until(lambda: robot.subscribed() == ["/a"], WAIT)
    robot.publish("/a", "one")
    inbox.wait_for("one")
    expected = Schema("std_msgs/msg/String", "ros2msg", "string data\n")
    assert inbox.messages[0].channel.schema == expected
    until(lambda: "/a" in source.topics(), WAIT)
    until(lambda: source.topics()["/a"].schema == expected, WAIT)


@pytest.mark.parametrize("answers", [True, False])
def test_without_rosapi_a_topic_is_asked_for_by_name(
    robot: RosbridgePeer,
    opened: Open,
    inbox: Inbox,
    answers: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    robot.services.clear()
    if not answers:
        monkeypatch.setattr(rosapi, "LONGEST_ANSWER", 0.5)
        for name in ("topics_and_raw_types", "topics", "publishers"):
            robot.services[f"/rosapi/{name}"] = lambda _: None
    robot.advertise("/robot_description", latched=True)
    robot.publish("/robot_description", "<robot/>")
    source = opened(robot.uri)
    source.subscribe("/robot_description", inbox)
    source.subscribe("/unheard_of", inbox)
    inbox.wait_for("<robot/>")
    assert inbox.messages[0].channel.schema.name == "std_msgs/msg/String"
    until(lambda: "rosapi does not run there" in source.status.sentence, WAIT)
    assert source.status.is_connected
    types = {one["topic"]: one.get("type") for one in robot.asked("subscribe")}
    assert types["/unheard_of"] is None


def test_without_rosapi_a_latched_topic_is_tried_until_its_message_comes(
    robot: RosbridgePeer, opened: Open, inbox: Inbox
) -> None:
    robot.services.clear()
    source = opened(robot.uri)
    source.subscribe("/tf_static", inbox)
    source.subscribe("/scan", inbox)
    until(lambda: robot.subscribed() == ["/scan", "/tf_static"], WAIT)
    robot.advertise("/tf_static", latched=True)
    robot.there["/tf_static"].kept.append(cdr_string("wheels"))
    inbox.wait_for("wheels")
    count = len(robot.asked("subscribe"))
    polls = len(robot.asked("call_service"))
    until(lambda: len(robot.asked("call_service")) > polls + 3, WAIT)
    assert len(robot.asked("subscribe")) == count, "it has come"
    assert inbox.strings() == ["wheels"]


def test_messages_of_ros_1_are_said_to_be_such(
    robot: RosbridgePeer, opened: Open, inbox: Inbox
) -> None:
    robot.advertise("/a")
    robot.there["/a"].type = "std_msgs/String"
    source = opened(robot.uri)
    source.subscribe("/a", inbox)
    until(lambda: robot.subscribed() == ["/a"], WAIT)
    robot.publish("/a", "one")
    until(lambda: inbox.messages, WAIT)
    channel = inbox.messages[0].channel
    assert channel.message_encoding == "ros1"
    assert channel.schema == Schema("std_msgs/String", "ros1msg", "string data\n")


def test_lists_of_different_lengths_are_no_harm(
    robot: RosbridgePeer, opened: Open, inbox: Inbox
) -> None:
    robot.services["/rosapi/topics_and_raw_types"] = lambda _: {
        "topics": ["/a", "/b", "/c"],
        "types": ["std_msgs/msg/String", "std_msgs/msg/String"],
        "typedefs_full_text": [],
    }
    robot.services["/rosapi/topics"] = robot.services["/rosapi/topics_and_raw_types"]
    source = opened(robot.uri)
    until(lambda: set(source.topics()) == {"/a", "/b"}, WAIT)
    assert source.topics()["/a"].schema == Schema("std_msgs/msg/String", "", "")


def test_errors_of_the_server_are_said(robot: RosbridgePeer, opened: Open) -> None:
    source = opened(robot.uri)
    until(lambda: source.status.is_connected, WAIT)
    robot.send('{"op":"status","level":"error","msg":"subscribe: no such type"}')
    until(lambda: "it says: subscribe: no such type" in source.status.sentence, WAIT)


def test_rosbridge_hands_out_no_files(robot: RosbridgePeer, opened: Open) -> None:
    source = opened(robot.uri)
    with pytest.raises(SourceError, match="--package-path"):
        source.fetch_asset("package://a").result(WAIT)


def test_a_line_about_something_else_refuses_no_topic(
    robot: RosbridgePeer, opened: Open
) -> None:
    source = opened(robot.uri)
    until(lambda: source.status.is_connected, WAIT)
    outgoing = source.advertise("/goal", "std_msgs/msg/String")
    until(lambda: robot.asked("advertise"), WAIT)

    def say(words: str, about: str) -> None:
        line = {"op": "status", "level": "error", "msg": words, "id": about}
        robot.send(json.dumps(line))

    # With the name of what it is about there is no need to guess.
    say("invalid msg type of /goal/feedback", "sambot-viz-1")
    say("it has no field q", robot.asked("advertise")[0]["id"])
    until(lambda: outgoing.refused, WAIT)
    assert outgoing.refused == "it has no field q"
    outgoing.send(b"{}")
    until(lambda: robot.asked("publish"), WAIT)
    assert robot.asked("publish")[0]["id"] == robot.asked("advertise")[0]["id"]
