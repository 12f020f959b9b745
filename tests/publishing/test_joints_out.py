"""The sliders move the joints of a live robot, while nobody else does."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from inside import session_of, viser_server
from live_peers import eventually
from navigator_peer import NavigatorPeer
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session.robot import joints_out

TOPIC = "/joint_states"
TAKEN = f"Published on {TOPIC}, which /robot_state_publisher takes"
MODEL = """
<robot name="a">
  <link name="base"/><link name="arm"/><link name="hand"/>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="with" type="continuous">
    <parent link="arm"/><child link="hand"/><axis xyz="0 0 1"/>
    <mimic joint="turn" multiplier="2"/>
  </joint>
</robot>
"""


@pytest.fixture
def peer() -> Iterator[NavigatorPeer]:
    made = NavigatorPeer(node="")
    made.listen_as(TOPIC, "/robot_state_publisher")
    yield made
    made.stop()


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who else publishes is known soon, since the peer is here."""
    monkeypatch.setattr(joints_out, "KNOWN_AFTER", 0.2)


@pytest.fixture
def opened(peer: NavigatorPeer, tmp_path: Path) -> Iterator[Callable[..., Visualizer]]:
    made: list[Visualizer] = []
    (tmp_path / "a.urdf").write_text(MODEL)

    def open_one(publish: str = "joints", follows: bool = False) -> Visualizer:
        options = {"publish": publish, "publish_log": tmp_path / "log"}
        viz = Visualizer(tmp_path / "a.urdf", source=peer.uri, port=0, **options)
        made.append(viz)
        data = session_of(viz).data
        assert data is not None
        eventually(lambda: data.source.status.is_connected)
        if not follows:
            data.follow(False)
        return viz

    yield open_one
    for viz in made:
        viz.stop()


def said(viz: Visualizer) -> str:
    return session_of(viz).joints_out.said.value


def positions(content: bytes) -> tuple[float, ...]:
    """Two positions at the end of a JointState, before two empty sequences."""
    return struct.unpack_from("<2d", content, len(content) - 8 - 16)


def test_the_sliders_are_published_again_and_again(
    peer: NavigatorPeer, opened: Callable[..., Visualizer], tmp_path: Path
) -> None:
    viz = opened()
    eventually(lambda: len(peer.came()) > 2)
    # The peer tells its graph and its channels one after the other.
    eventually(lambda: said(viz) == TAKEN)
    session_of(viz).robot.set_positions({"turn": 0.5})
    eventually(lambda: positions(peer.came()[-1].content) == (0.5, 1.0))
    assert {one.topic for one in peer.came()} == {TOPIC}
    stamps = [struct.unpack_from("<iI", one.content, 4) for one in peer.came()]
    assert stamps == sorted(set(stamps)), "each is newer than the last"

    # The log has what has changed, not each message.
    def logged() -> list[float]:
        lines = (tmp_path / "log").read_text().splitlines()
        return [json.loads(one)["values"]["turn"] for one in lines]

    # A message may have come before it is written down.
    eventually(lambda: logged() == [0.0, 0.5])


def test_nothing_is_published_while_messages_move_the_joints(
    peer: NavigatorPeer,
    opened: Callable[..., Visualizer],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # What the robot publishes is known before anything is sent.
    monkeypatch.setattr(joints_out, "KNOWN_AFTER", 1e9)
    peer.offer("/tf", "tf2_msgs/msg/TFMessage")
    viz = opened(follows=True)
    eventually(lambda: session_of(viz).robot.followed.value)
    monkeypatch.setattr(joints_out, "KNOWN_AFTER", 0.0)
    eventually(lambda: said(viz) == "")
    assert peer.came() == []
    data = session_of(viz).data
    assert data is not None
    data.follow(False)
    eventually(peer.came)
    data.follow(True)
    eventually(lambda: said(viz) == "")


def test_what_comes_back_of_it_does_not_take_the_joints(
    peer: NavigatorPeer, opened: Callable[..., Visualizer]
) -> None:
    viz = opened()
    eventually(peer.came)
    # As a bridge and robot_state_publisher do.
    peer.offer(TOPIC, "sensor_msgs/msg/JointState")
    peer.published_by(TOPIC, "/foxglove_bridge")
    peer.offer("/tf", "tf2_msgs/msg/TFMessage")
    session = session_of(viz)
    eventually(
        lambda: session.data is not None and "/tf" in session.data.source.topics()
    )
    session.robot.set_positions({"turn": 0.5})
    eventually(lambda: positions(peer.came()[-1].content) == (0.5, 1.0))
    assert not session.robot.followed.value


def test_a_topic_of_somebody_else_is_left_to_it(
    peer: NavigatorPeer, opened: Callable[..., Visualizer]
) -> None:
    viz = opened()
    eventually(peer.came)
    peer.offer(TOPIC, "sensor_msgs/msg/JointState")
    peer.published_by(TOPIC, "/foxglove_bridge", "/joint_state_publisher")
    eventually(lambda: "is that of /joint_state_publisher" in said(viz))
    # What the bridge publishes is what comes from here.
    peer.published_by(TOPIC, "/foxglove_bridge")
    eventually(lambda: said(viz).startswith("Published on"))


def test_that_the_robot_is_not_followed_is_said_while_it_does_not_get_the_joints(
    peer: NavigatorPeer,
    opened: Callable[..., Visualizer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    viz = opened()
    client = protocol(viz.viser.get_port())

    def is_said() -> bool:
        client.settle(viser_server(viz))
        return "joints/unfollowed" in client.rows

    eventually(peer.came)
    peer.offer(TOPIC, "sensor_msgs/msg/JointState")
    peer.published_by(TOPIC, "/foxglove_bridge", "/joint_state_publisher")
    eventually(is_said)
    peer.published_by(TOPIC, "/foxglove_bridge")
    eventually(lambda: not is_said())


def test_without_leave_nothing_is_published(
    peer: NavigatorPeer, opened: Callable[..., Visualizer]
) -> None:
    viz = opened("goal")
    session_of(viz).robot.set_positions({"turn": 0.5})
    assert said(viz) == "" and peer.advertised() == []


def test_the_panel_says_it(
    peer: NavigatorPeer,
    opened: Callable[..., Visualizer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    viz = opened()
    client = protocol(viz.viser.get_port())
    eventually(lambda: said(viz) == TAKEN)
    eventually(lambda: client.row("joints/out")["value"] == TAKEN)
    # Not among the rows, where it would move the sliders when it comes.
    assert client.row("joints/out")["kind"] == "data"


def test_without_anybody_who_takes_them_it_says_where_another_topic_is_named(
    peer: NavigatorPeer, opened: Callable[..., Visualizer]
) -> None:
    viz = opened()
    eventually(peer.came)
    peer.listen_as(TOPIC)
    eventually(lambda: "with --remap /joint_states:=TOPIC" in said(viz))
