"""A robot on the network is shown as it describes itself, and moves as it says."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import foxglove
import numpy as np
import pytest
from inside import session_of
from live_peers import WAIT, FoxglovePeer
from patience import until
from protocol_client import ProtocolClient

from sambot_viz import JointError, Visualizer
from sambot_viz.panels.source import SourcePanel
from sambot_viz.session.data.robot_data import LiveData
from sambot_viz.sources.bag import Recording, open_recording

START = 1_750_000_000_000_000_000
LEFT = "drivewhl_l_joint"


class RobotPeer(FoxglovePeer):
    """Publishes what a recording has."""

    def __init__(self, recording: Recording, **options: Any) -> None:
        self.recording = recording
        super().__init__(**options)
        for name, topic in recording.topics.items():
            if topic.is_latched:
                self._latched[name] = []
            text = topic.schema.text
            self._channels[name] = foxglove.Channel(
                name,
                schema=foxglove.Schema(
                    name=topic.schema.name,
                    encoding=topic.schema.encoding,
                    data=text.encode() if isinstance(text, str) else text,
                ),
                message_encoding=topic.message_encoding,
                context=self.context,
            )
        for message in recording.latched():
            self._latched[message.topic].append(bytes(message.payload))

    def play(self, until_s: float) -> None:
        """Publish all that moves, up to a time [s]."""
        end = START + round(until_s * 1e9)
        for message in self.recording.messages(None, end, ("/tf", "/joint_states")):
            self._channels[message.topic].log(bytes(message.payload))


@pytest.fixture
def peer(repository: Path) -> Iterator[RobotPeer]:
    with open_recording(repository / "assets" / "square.mcap") as recording:
        peer = RobotPeer(recording)
        yield peer
        peer.stop()


@pytest.fixture
def viz(peer: RobotPeer) -> Iterator[Visualizer]:
    with Visualizer(source=peer.uri, port=0) as viz:
        eventually(lambda: session_of(viz).robot.model.name == "sam_bot")
        eventually(lambda: {"/tf", "/joint_states"} <= set(peer.subscribed()))
        yield viz


def eventually(condition: Callable[[], Any]) -> None:
    until(condition, WAIT, not_yet=(Exception,), why="it never came")


def place(viz: Visualizer) -> tuple[float, float]:
    x, y, _ = viz.frames.lookup("odom", "base_link").translation
    return round(float(x), 2), round(float(y), 2)


def sentence(viz: Visualizer) -> str:
    data = session_of(viz).data
    assert isinstance(data, LiveData)
    return SourcePanel(data).data()[0].value["sentence"]


def test_the_robot_moves_as_it_says(viz: Visualizer, peer: RobotPeer) -> None:
    peer.play(9.05)
    eventually(lambda: place(viz) == (1.0, 1.0))
    session = session_of(viz)
    eventually(lambda: viz.joint_positions[LEFT] != 0)
    assert session.robot.followed.value == peer.uri
    with pytest.raises(JointError, match="Follow"):
        viz.set_joint_positions({LEFT: 0.0})


def test_the_view_follows_the_robot_in_odom(peer: RobotPeer) -> None:
    with Visualizer(source=peer.uri, port=0) as viz:
        eventually(lambda: "/tf" in peer.subscribed())
        peer.play(1.0)
        eventually(lambda: session_of(viz).scene.context.fixed_frame == "odom")
        view = session_of(viz).document.config.view
        assert view.get("Target Frame") == "base_link"


def test_the_robot_stays_while_the_connection_is_lost(
    viz: Visualizer, peer: RobotPeer
) -> None:
    peer.play(4.05)
    eventually(lambda: place(viz) == (1.0, 0.0))
    peer.stop()
    eventually(lambda: "connect" in sentence(viz).lower())
    assert place(viz) == (1.0, 0.0)
    peer.start()
    eventually(lambda: "/tf" in peer.subscribed())
    peer.play(9.05)
    eventually(lambda: place(viz) == (1.0, 1.0))


def test_all_browsers_share_one_subscription(
    peer: RobotPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    with Visualizer(source=peer.uri, port=0, session="private") as viz:
        for _ in range(3):
            protocol(viz.viser.get_port()).settle(viz.viser)
        eventually(lambda: len(viz.server.sessions.all()) == 3)
        eventually(
            lambda: all(
                one.robot.model.name == "sam_bot" for one in viz.server.sessions.all()
            )
        )
        eventually(lambda: "/joint_states" in peer.subscribed())
        assert len(set(peer.subscribed())) == len(peer.subscribed())
        assert "/scan" not in peer.subscribed()
        peer.play(9.05)
        for session in viz.server.sessions.all():
            tree = session.frames.tree
            eventually(
                lambda tree=tree: np.allclose(
                    tree.lookup("odom", "base_link").translation[:2], 1.0, atol=0.01
                )
            )


def test_without_a_robot_the_page_says_what_is_missing() -> None:
    peer = FoxglovePeer()
    try:
        with Visualizer(source=peer.uri, port=0) as viz:
            eventually(lambda: "robot_state_publisher" in sentence(viz))
            peer.stop()
            eventually(lambda: "robot_state_publisher" not in sentence(viz))
            assert session_of(viz).robot.model is not None
    finally:
        peer.stop()


def test_meshes_come_through_the_connection() -> None:
    """Each once for all, and a refusal is said with what would allow it."""
    stl = b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    stl += b"vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
    asked: list[str] = []

    def fetch(uri: str) -> bytes | None:
        asked.append(uri)
        return stl if uri.endswith("a.stl") else None

    mesh = '<visual><geometry><mesh filename="package://lab/{}"/></geometry></visual>'
    text = '<robot name="lab"><link name="base">'
    text += (
        mesh.format("meshes/a.stl") + mesh.format("meshes/b.stl") + "</link></robot>"
    )
    peer = FoxglovePeer(
        asset_handler=fetch,
    )
    try:
        peer.advertise("/robot_description", latched=True)
        peer.publish("/robot_description", text)
        with Visualizer(source=peer.uri, port=0) as viz:
            eventually(lambda: session_of(viz).robot.model.name == "lab")
            viz.server.sessions.wait_for_meshes(WAIT)
            listed = session_of(viz).problems.shown.value.listed
        refused = [problem for problem in listed if problem.code == "mesh-not-served"]
        assert len(refused) == 1
        assert "b.stl" in refused[0].message
        assert "asset_uri_allowlist" in refused[0].hint
        assert sorted(asked) == [
            "package://lab/meshes/a.stl",
            "package://lab/meshes/b.stl",
        ]
    finally:
        peer.stop()
