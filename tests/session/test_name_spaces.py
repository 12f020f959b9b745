"""Two robots with name spaces in a session: their links, joints and data."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from inside import session_of
from live_peers import eventually
from made_recording import START, Message, described, store_of_all, write_messages
from made_recording import transforms_message as moved
from numpy.typing import NDArray
from robot_peer import BusyPeer

from sambot_viz import Visualizer
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.sources.bag import open_recording

ROBOTS = ("a", "b")
POSITIONS = {"a": 0.25, "b": 1.0}
JOINT = "base_link_arm"


def messages() -> Iterator[Message]:
    """Of two robots: odom is where the number of seconds says, arms are turned."""
    store = store_of_all()
    types, time = store.types, START * 1_000_000_000
    urdf = described("base_link", "arm")
    for robot, position in POSITIONS.items():
        text, state = "std_msgs/msg/String", "sensor_msgs/msg/JointState"
        yield f"/{robot}/robot_description", text, time, types[text](urdf)
        trees = {"odom": "map"}, {"base_link": "odom", "laser": "base_link"}
        for seconds, tree in zip((2.0 * position, 0.0), trees, strict=True):
            name = "tf2_msgs/msg/TFMessage"
            yield f"/{robot}/tf_static", name, time, moved(store, seconds, tree)
        header = types["std_msgs/msg/Header"](
            types["builtin_interfaces/msg/Time"](START, 0), ""
        )
        none = np.zeros(0)
        told = types[state](header, [JOINT], np.array([position]), none, none)
        yield f"/{robot}/joint_states", state, time, told
        header = types["std_msgs/msg/Header"](header.stamp, "laser")
        point = types["geometry_msgs/msg/Point"](1.0, 0.0, 0.0)
        name = "geometry_msgs/msg/PointStamped"
        yield f"/{robot}/point", name, time, types[name](header, point)


def turned(viz: Visualizer, robot: str) -> NDArray[np.float64]:
    return viz.frames.lookup(f"{robot}/base_link", f"{robot}/arm").matrix[:3, :3]


def expected(robot: str) -> NDArray[np.float64]:
    c, s = np.cos(POSITIONS[robot]), np.sin(POSITIONS[robot])
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def are_shown(viz: Visualizer) -> bool:
    """Whether both robots are at their places, with their joints, and their data."""
    frames = viz.frames
    needed = [f"{r}/{link}" for r in ROBOTS for link in ("base_link", "arm")]
    return all(
        frame in frames and frames.can_lookup("map", frame) for frame in needed
    ) and all(np.allclose(turned(viz, robot), expected(robot)) for robot in ROBOTS)


def is_fine(viz: Visualizer) -> bool:
    displays = session_of(viz).scene.displays
    found = [d.status.level for d in displays if d.kind.endswith("PointStamped")]
    return found == ["Ok", "Ok"]


def check(viz: Visualizer) -> None:
    session = session_of(viz)
    displays = session.scene.displays
    models = [d for d in displays if isinstance(d, RobotModelDisplay)]
    assert [str(d.config.get("Description Topic")) for d in models] == [
        "/a/robot_description",
        "/b/robot_description",
    ]
    assert [d.frame_of("arm") for d in models] == ["a/arm", "b/arm"]
    assert [d.status.level for d in models] == ["Ok", "Ok"]
    for robot, position in POSITIONS.items():
        at = viz.frames.lookup("map", f"{robot}/base_link").translation
        assert at.tolist() == pytest.approx([2.0 * position, 0.0, 0.0])
        assert viz.frames.parent(f"{robot}/laser") == f"{robot}/base_link"
    assert not {"odom", "base_link", "arm", "laser"} & {*viz.frames.frames}


@pytest.fixture(params=[1, -1], ids=["in order", "in the other order"])
def recording(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    return write_messages(tmp_path / "robots.mcap", [*messages()][:: request.param])


def test_a_recording_shows_both_robots(recording: Path) -> None:
    with Visualizer(recording, port=0) as viz:
        eventually(lambda: are_shown(viz))
        eventually(lambda: is_fine(viz))
        check(viz)


def test_a_live_source_shows_both_robots(recording: Path) -> None:
    with open_recording(recording) as played:
        peer = BusyPeer(played)
        try:
            with Visualizer(source=peer.uri, port=0) as viz:
                eventually(lambda: are_shown(viz))
                eventually(lambda: is_fine(viz))
                check(viz)
        finally:
            peer.stop()
