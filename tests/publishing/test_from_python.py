"""A program sends messages of any type, stops the robot, and hears what was sent."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from base_peer import TWIST, BasePeer
from inside import session_of
from live_peers import eventually, knows_takers

from sambot_viz import Visualizer
from sambot_viz.errors import PublishError
from sambot_viz.publishing.sent_message import SentMessage

POSE = "geometry_msgs/msg/PoseStamped"
UNIT = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}


@pytest.fixture
def peer() -> Iterator[BasePeer]:
    made = BasePeer()
    made.listen_as("/target", "/arm")
    yield made
    made.stop()


def connected(peer: BasePeer, **options: Any) -> Visualizer:
    viz = Visualizer(source=peer.uri, port=0, **options)
    data = session_of(viz).data
    assert data is not None
    eventually(lambda: data.source.status.is_connected)
    knows_takers(data.source, peer)
    return viz


def test_a_message_of_any_type_is_sent_once_and_told(peer: BasePeer) -> None:
    with connected(peer, publish="") as viz:
        heard: list[SentMessage] = []
        viz.on_published(heard.append)
        content = {"header": {"frame_id": "map"}, "pose": {"orientation": UNIT}}
        assert viz.publish("/target", POSE, content) == "/target, which /arm takes"
        eventually(lambda: len(peer.came()) == 1)
        (came,) = peer.came()
        assert (came.topic, came.type_name, len(came.content)) == ("/target", POSE, 76)
        # The stamp is the time of the robot.
        assert bytes(came.content)[4:12] != bytes(8)
        (sent,) = heard
        assert (sent.who, sent.topic, sent.values) == ("Python", "/target", content)


@pytest.mark.parametrize(
    ("content", "why"),
    [
        ({"pose": {"position": {"x": float("nan")}}}, "position.x needs a finite"),
        ({"pose": {"orientation": {**UNIT, "w": 0.0}}}, "a quaternion of length 1"),
        ({"pose": {"orientation": 1}}, "orientation"),
        ({"pose": {"positon": {}}}, "has no field 'pose.positon'"),
    ],
)
def test_what_no_receiver_could_take_is_refused(
    peer: BasePeer, content: dict[str, Any], why: str
) -> None:
    with connected(peer, publish="") as viz:
        with pytest.raises(PublishError, match=why):
            viz.publish("/target", POSE, content)
        assert peer.came() == []


def test_without_leave_or_receiver_nothing_is_sent(peer: BasePeer) -> None:
    with connected(peer) as viz:
        with pytest.raises(PublishError, match="--publish"):
            viz.publish("/target", TWIST, {})
    with connected(peer, publish="goal") as viz:
        with pytest.raises(PublishError, match="nobody has subscribed"):
            viz.publish("/elsewhere", TWIST, {})
    assert peer.came() == []


def test_who_takes_a_topic_is_asked_again_after_a_lost_connection(
    peer: BasePeer,
) -> None:
    with connected(peer, publish="") as viz:
        with pytest.raises(PublishError, match="nobody has subscribed"):
            viz.publish("/late", TWIST, {})
        data = session_of(viz).data
        assert data is not None
        peer.stop()
        eventually(lambda: not data.source.status.is_connected)
        peer.start()
        eventually(lambda: data.source.status.is_connected)
        peer.listen_as("/late", "/arm")
        knows_takers(data.source, peer)
        assert viz.publish("/late", TWIST, {}) == "/late, which /arm takes"
        eventually(lambda: [one.topic for one in peer.came()] == ["/late"])


def test_a_program_stops_the_robot(peer: BasePeer) -> None:
    peer.listen_as("/cmd_vel", "/base")
    with connected(peer, publish="") as viz:
        data = session_of(viz).data
        assert data is not None
        eventually(lambda: "/cmd_vel" in data.source.topics())
        viz.stop_robot()
        eventually(peer.rests)
